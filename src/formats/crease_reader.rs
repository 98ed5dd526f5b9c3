//! Crease patterns from FOLD files (Demaine, Ku and Lang 2016): a flat sheet with the angles by which its creases fold.

use super::arrangement;
use super::fault::FormatFault;
use super::fold_reader::{coordinates, list, parsed, vertex_of};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// The greatest height of a vertex over the plane, as a part of the extent of the sheet: rounding.
const TOL_LEVEL: f64 = 1e-6;

/// A crease pattern as a file states it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CreaseSheet {
    /// The vertices in the plane of the sheet, in the file's unit of length.
    pub vertices: Vec<[f64; 2]>,
    /// The faces as indices in `vertices`, counterclockwise seen from the front.
    pub faces: Vec<Vec<usize>>,
    /// The fold angle (rad) of each edge that is not at the border, by its ends, the lesser first: positive where the fold
    /// is convex as seen from the front, a mountain.
    pub angles: BTreeMap<[usize; 2], f64>,
    /// The first edge (an index in the file) that is a mountain or a valley without a fold angle; its angle here is half a
    /// turn.
    pub unstated: Option<usize>,
    /// True if the file counts y downwards, as drawings do.
    pub downwards: bool,
}

impl CreaseSheet {
    /// Returns a vertex (an index in `vertices`) as the file states it, in words for a message.
    pub fn place(&self, vertex: usize) -> String {
        let [x, y] = self.vertices[vertex];
        place([x, if self.downwards { -y } else { y }])
    }
}

/// Returns a point of a file, in words for a message: coordinates with six significant digits.
pub(super) fn place(point: [f64; 2]) -> String {
    let [x, y] = point.map(rounded);
    format!("({x}, {y})")
}

/// Returns a number with six significant digits.
pub(super) fn rounded(x: f64) -> f64 {
    // Adding zero leaves no negative one.
    format!("{x:.5e}").parse::<f64>().map_or(x, |short| short + 0.0)
}

/// Reads the crease pattern of a FOLD file: the first frame with places of vertices, which are in one plane, with the
/// edges' fold angles. Faces that are not stated are those that the edges enclose.
///
/// # Errors
/// A [`FormatFault`] where it is no JSON, holds no flat pattern, or an edge says nothing of its fold or contradicts itself.
pub(super) fn read(bytes: &[u8]) -> Result<CreaseSheet, FormatFault> {
    let file = parsed(bytes)?;
    let none: &[Value] = &[];
    let frames = file["file_frames"].as_array().map_or(none, Vec::as_slice);
    let placed = std::iter::once(&file).chain(frames).find(|frame| list(&frame["vertices_coords"]).is_some());
    let frame = placed.ok_or(FormatFault::Nothing { what: "vertices" })?;
    let vertices = vertices(&list(&frame["vertices_coords"]).unwrap_or_default())?;
    let edges = list(&frame["edges_vertices"]).ok_or(FormatFault::Nothing { what: "edges" })?;
    let edges = edges.iter().map(|edge| places(edge, vertices.len())).collect::<Result<Vec<_>, _>>()?;
    let mut known = BTreeMap::new();
    for (edge, ends) in edges.iter().enumerate() {
        let &[a, b] = ends.as_slice() else {
            return Err(FormatFault::Reader(format!("edge {edge} has {} ends", ends.len())));
        };
        if a == b || known.insert([a.min(b), a.max(b)], edge).is_some() {
            return Err(FormatFault::Reader(format!("edge {edge} is a point, or stands there twice")));
        }
    }
    let faces = match list(&frame["faces_vertices"]) {
        Some(faces) => {
            faces.iter().map(|face| places(face, vertices.len())).collect::<Result<Vec<_>, _>>()?
        }
        None => enclosed(&vertices, &known.keys().copied().collect::<Vec<_>>()),
    };
    if faces.is_empty() {
        return Err(FormatFault::Nothing { what: "faces" });
    }
    if let Some(face) = faces.iter().position(|face| face.len() < 3) {
        return Err(FormatFault::FewCorners { face });
    }
    let faces: Vec<Vec<usize>> = faces.into_iter().map(|face| turned_left(&vertices, face)).collect();
    let (mut angles, mut unstated) = (BTreeMap::new(), None);
    for ends in inner_edges(&faces) {
        let Some(&edge) = known.get(&ends) else {
            let [a, b] = ends;
            return Err(FormatFault::Reader(format!(
                "no edge joins vertices {a} and {b}, where two faces meet"
            )));
        };
        let (angle, stated) = fold_angle(frame, edge)?;
        if !stated {
            unstated = unstated.or(Some(edge));
        }
        angles.insert(ends, angle);
    }
    Ok(CreaseSheet { vertices, faces, angles, unstated, downwards: false })
}

/// Returns the vertices of a pattern.
///
/// # Errors
/// A fault where one has no coordinates, or is not in the plane.
fn vertices(stated: &[Value]) -> Result<Vec<[f64; 2]>, FormatFault> {
    let places = stated.iter().enumerate().map(|(vertex, place)| coordinates(place, vertex));
    let places = places.collect::<Result<Vec<_>, _>>()?;
    let extent = places.iter().flat_map(|[x, y, _]| [x.abs(), y.abs()]).fold(0.0, f64::max);
    match places.iter().position(|place| place[2].abs() > TOL_LEVEL * extent) {
        Some(vertex) => Err(FormatFault::Reader(format!(
            "vertex {vertex} is out of the plane: this is no crease pattern"
        ))),
        None => Ok(places.into_iter().map(|[x, y, _]| [x, y]).collect()),
    }
}

/// Returns a list of vertices.
///
/// # Errors
/// A fault where it is none, or one is not there.
fn places(value: &Value, count: usize) -> Result<Vec<usize>, FormatFault> {
    let list = value.as_array().ok_or(FormatFault::NoSuchVertex)?;
    list.iter().map(|vertex| vertex_of(vertex, count)).collect()
}

/// Returns the fold angle of an edge between two faces, rad, mountains positive; with false, half a turn, where the file
/// says no more than that it is one or the other.
///
/// # Errors
/// A fault where the file does not say it, or says that a mountain is a valley.
fn fold_angle(frame: &Value, edge: usize) -> Result<(f64, bool), FormatFault> {
    let assignment = frame["edges_assignment"][edge].as_str().unwrap_or("U");
    let degrees = frame["edges_foldAngle"][edge].as_f64();
    let fault = |why: &str| Err(FormatFault::Reader(format!("edge {edge} {why}")));
    match (assignment, degrees) {
        ("B" | "C", _) => fault("is at the border or a cut, but has a face on either side"),
        ("M", Some(degrees)) if degrees > 0.0 => fault("is a mountain, whose fold angle can't be positive"),
        ("V", Some(degrees)) if degrees < 0.0 => fault("is a valley, whose fold angle can't be negative"),
        ("F" | "J", Some(degrees)) if degrees != 0.0 => fault("is flat, but has a fold angle"),
        (_, Some(degrees)) if degrees.abs() <= 180.0 => Ok((-degrees.to_radians() + 0.0, true)),
        (_, Some(_)) => fault("folds by more than 180 degrees"),
        ("F" | "J", None) => Ok((0.0, true)),
        ("M", None) => Ok((PI, false)),
        ("V", None) => Ok((-PI, false)),
        (_, None) => fault("has neither a fold angle nor an assignment"),
    }
}

/// Returns the edges with a face on either side, by their ends, ascending.
fn inner_edges(faces: &[Vec<usize>]) -> BTreeSet<[usize; 2]> {
    let mut once = BTreeSet::new();
    let mut inner = BTreeSet::new();
    for face in faces {
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            let ends = [a.min(b), a.max(b)];
            if !once.insert(ends) {
                inner.insert(ends);
            }
        }
    }
    inner
}

/// Returns the faces that edges in the plane enclose, counterclockwise, without the outside.
fn enclosed(vertices: &[[f64; 2]], edges: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let walks = arrangement::walks(vertices, edges);
    walks.into_iter().filter(|walk| walk.len() > 2 && arrangement::area(vertices, walk) > 0.0).collect()
}

/// Returns a face counterclockwise.
fn turned_left(vertices: &[[f64; 2]], mut face: Vec<usize>) -> Vec<usize> {
    if arrangement::area(vertices, &face) < 0.0 {
        face.reverse();
    }
    face
}
