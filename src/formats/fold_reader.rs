//! Meshes from FOLD files (Demaine, Ku and Lang 2016): the last state of the file that has places for its vertices, which of
//! a folding is the folded form.

use super::content::Content;
use super::fault::FormatFault;
use serde_json::Value;
use std::collections::BTreeMap;

/// Vertices nearer to each other than this part of the extent of the mesh are one: edges that meet when folded.
const TOL_MEET: f64 = 1e-6;

/// Reads the faces of a FOLD file with the places of their vertices in its last frame; corners that meet there are one. A
/// place with two coordinates is at z = 0.
///
/// # Errors
/// A [`FormatFault`] where it is no JSON, or holds no list of vertices or faces.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let file = parsed(bytes)?;
    let frames = file["file_frames"].as_array().map_or(&[][..], Vec::as_slice);
    let placed = frames.iter().rev().find(|frame| list(&frame["vertices_coords"]).is_some());
    let frame = placed.unwrap_or(&file);
    let vertices = list(&frame["vertices_coords"]).ok_or(FormatFault::Nothing { what: "vertices" })?;
    let faces = list(&frame["faces_vertices"]).or_else(|| list(&file["faces_vertices"]));
    let faces = faces.ok_or(FormatFault::Nothing { what: "faces" })?;
    let vertices = vertices.iter().enumerate().map(|(vertex, place)| coordinates(place, vertex));
    let vertices = vertices.collect::<Result<Vec<[f64; 3]>, FormatFault>>()?;
    let corners = |(face, corners): (usize, &Value)| {
        let all = corners.as_array().ok_or(FormatFault::FewCorners { face })?;
        all.iter().map(|corner| vertex_of(corner, vertices.len())).collect()
    };
    let faces = faces.iter().enumerate().map(corners).collect::<Result<Vec<Vec<usize>>, FormatFault>>()?;
    Ok(joined(vertices, faces))
}

/// Returns a FOLD file as JSON.
///
/// # Errors
/// A [`FormatFault`] where it is none.
pub(super) fn parsed(bytes: &[u8]) -> Result<Value, FormatFault> {
    let text = std::str::from_utf8(bytes).map_err(|_| FormatFault::NotText)?;
    serde_json::from_str(text).map_err(|e| FormatFault::Reader(e.to_string()))
}

/// Returns a list that holds something.
pub(super) fn list(value: &Value) -> Option<Vec<Value>> {
    value.as_array().filter(|list| !list.is_empty()).cloned()
}

/// Returns the index of a vertex, of which there are `count`.
///
/// # Errors
/// [`FormatFault::NoSuchVertex`] where it is not among them.
pub(super) fn vertex_of(value: &Value, count: usize) -> Result<usize, FormatFault> {
    let index = value.as_u64().and_then(|index| usize::try_from(index).ok());
    index.filter(|index| *index < count).ok_or(FormatFault::NoSuchVertex)
}

/// Returns the coordinates of a vertex.
///
/// # Errors
/// [`FormatFault::NoCoordinates`] unless there are two or three numbers.
pub(super) fn coordinates(place: &Value, vertex: usize) -> Result<[f64; 3], FormatFault> {
    let numbers: Option<Vec<f64>> =
        place.as_array().and_then(|place| place.iter().map(Value::as_f64).collect());
    match numbers.as_deref() {
        Some(&[x, y]) => Ok([x, y, 0.0]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err(FormatFault::NoCoordinates { vertex }),
    }
}

/// Returns a mesh in which vertices that meet are one, the first of them.
fn joined(vertices: Vec<[f64; 3]>, faces: Vec<Vec<usize>>) -> Content {
    let extent = vertices.iter().flatten().fold(0.0_f64, |extent, x| extent.max(x.abs()));
    let tol = (TOL_MEET * extent).max(f64::MIN_POSITIVE);
    let cell = |v: &[f64; 3]| v.map(|x| libm::floor(x / tol) as i64);
    let near = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() <= tol);
    let mut kept: Vec<[f64; 3]> = Vec::new();
    let mut known: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    let mut place = Vec::with_capacity(vertices.len());
    for vertex in &vertices {
        let [x, y, z] = cell(vertex);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let mut met = around.filter_map(|cell| known.get(&cell)).flatten();
        let index = met.find(|index| near(&kept[**index], vertex)).copied().unwrap_or_else(|| {
            kept.push(*vertex);
            kept.len() - 1
        });
        if index + 1 == kept.len() {
            known.entry([x, y, z]).or_default().push(index);
        }
        place.push(index);
    }
    let faces = faces.into_iter().map(|face| face.into_iter().map(|corner| place[corner]).collect());
    Content { vertices: kept, faces: faces.collect() }
}
