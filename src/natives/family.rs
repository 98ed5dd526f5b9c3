//! Built-ins that arrange cells, build frames of trusses, and make meshes and clouds.

use super::Native;
use super::mesh_file;
use super::shape::points;
use crate::geometry::{HeightField, Vec3, subdivide};
use crate::interpret::argument::{Positive, arguments, parameters};
use crate::interpret::cells::{self, BadCell, Cells};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{Mesh, Value};
use crate::source::{Span, code};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The built-ins for arrangements of cells, trusses, meshes and terrain, such as `row`, `octet` and `load_mesh`: the
/// key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("row", parameters![n: usize], |i, call| {
        block(i, call, [call.count("n", "a number of cells")?, 1, 1])
    }),
    Native::pure("column", parameters![n: usize], |i, call| {
        block(i, call, [1, call.count("n", "a number of cells")?, 1])
    }),
    Native::pure("block", parameters![x: usize, y: usize, z: usize], |i, call| {
        let count = |side| call.count(side, "a number of cells");
        block(i, call, [count("x")?, count("y")?, count("z")?])
    }),
    Native::pure("cells", parameters![text: &str], drawn),
    Native::pure("layers", parameters![texts: &[Value]], layers),
    Native::pure("enlarged", parameters![of: &Rc<Cells>, by: usize], enlarged),
    Native::pure("octet", OctetArguments::PARAMETERS, octet),
    Native::pure("tetrahelix", parameters![n: usize, edge: Positive], tetrahelix),
    Native::pure("from_mesh", parameters![mesh: &Mesh], from_mesh),
    Native::pure("polyhedron", parameters![vertices: &[Value], faces: &[Value]], polyhedron),
    Native::pure("faces", parameters![of: &Mesh], faces),
    Native::pure("load_mesh", parameters![file: &str, scale: Positive], load_mesh),
    Native::pure("load_cloud", parameters![file: &str, scale: Positive], load_cloud),
    Native::pure("subdivided", parameters![mesh: &Mesh, parts: usize], subdivided),
    Native::pure("on_sphere", parameters![mesh: &Mesh, radius: Positive], on_sphere),
    Native::pure("terrain", parameters![heights: &[Value], spacing: Positive, centre: Vec3], terrain),
    Native::pure("slope", parameters![angle: f64, along: Vec3], slope),
    Native::pure("cloud", parameters![points: &[Value]], |_, call| {
        Ok(Value::Cloud(Rc::new(points(call, "points")?)))
    }),
];

/// The steepest slope, rad: 50°, of which the heights stay within what geometry reaches.
const SLOPE_MAX: f64 = 50.0 * std::f64::consts::PI / 180.0;
/// Threshold: the horizontal part of a direction from which on it is not vertical, without unit.
const TOL_VERTICAL: f64 = 1e-9;
/// The greatest number of divisions of an octet truss: more give more nodes than a truss may have.
const DIVISIONS_MAX: usize = 16;
/// The greatest number of tetrahedra of a helix.
const HELIX_MAX: usize = 500;
/// The number of neighbours of a node inside an octet lattice.
const NEIGHBOURS: usize = 12;

fn block(interpreter: &mut Interpreter, call: &Call, size: [usize; 3]) -> Eval<Value> {
    let count = size.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    interpreter.check_list(count.unwrap_or(usize::MAX), call.span)?;
    Ok(Value::Cells(Rc::new(Cells::block(size))))
}

fn drawn(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let text = call.get::<&str>("text")?;
    let positions = cells::layer(text, 0).map_err(|bad| bad_cell(interpreter, call.at("text"), text, bad))?;
    arrangement(interpreter, call, "text", positions)
}

fn layers(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut positions = Vec::new();
    for (z, text) in call.get::<&[Value]>("texts")?.iter().enumerate() {
        let Value::Text(text) = text else { return Err(call.refuse("texts", "texts are wanted")) };
        let layer =
            cells::layer(text, z as i64).map_err(|bad| bad_cell(interpreter, call.at("texts"), text, bad))?;
        positions.extend(layer);
    }
    arrangement(interpreter, call, "texts", positions)
}

/// Makes a cube of cells of each cell of an arrangement.
fn enlarged(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (cells, by) = (call.get::<&Rc<Cells>>("of")?, call.count("by", "a number of cells")?);
    let count = by.checked_pow(3).and_then(|each| each.checked_mul(cells.positions.len()));
    interpreter.check_list(count.unwrap_or(usize::MAX), call.span)?;
    Ok(Value::Cells(Rc::new(cells.enlarged(by))))
}

fn arrangement(
    interpreter: &mut Interpreter,
    call: &Call,
    drawn: &str,
    positions: Vec<[i64; 3]>,
) -> Eval<Value> {
    interpreter.check_list(positions.len(), call.span)?;
    if positions.is_empty() {
        return Err(fault(code::BAD_LATTICE, call.at(drawn), "no cell is drawn", "`#` is a cell"));
    }
    Ok(Value::Cells(Rc::new(Cells { positions })))
}

fn bad_cell(interpreter: &Interpreter, span: Span, text: &str, bad: BadCell) -> Stop {
    let message = format!("`{}` is no cell: `#` is a cell, `.` and a blank are not", bad.character);
    let at = character_span(interpreter, span, text, bad);
    fault(code::BAD_LATTICE, at, message, "neither cell nor gap")
}

/// Returns the span of a character of a text in its `"""..."""` or `"..."`; of all that was given where it is not
/// written there.
fn character_span(interpreter: &Interpreter, span: Span, text: &str, bad: BadCell) -> Span {
    let source = interpreter.shared.sources.text(span);
    if source.starts_with('"') && !source.starts_with("\"\"\"") {
        return quoted_span(source, span, bad);
    }
    let (Some(line), true) = (text.lines().nth(bad.line), source.starts_with("\"\"\"")) else { return span };
    // The text begins after the first line break; its lines have lost their indentation.
    let mut start = span.start as usize;
    for (number, raw) in source.split_inclusive('\n').enumerate() {
        let trimmed = raw.trim_end_matches(['\n', '\r']);
        if number == bad.line + 1 && trimmed.ends_with(line) {
            let offset = start + trimmed.len() - line.len() + bad.offset;
            return Span::new(span.file, offset, offset + bad.character.len_utf8());
        }
        start += raw.len();
    }
    span
}

/// Returns the first character in `"..."`, or in several with commas between them, that is neither cell nor
/// gap.
fn quoted_span(source: &str, span: Span, bad: BadCell) -> Span {
    let mut characters = source.char_indices();
    while let Some((at, character)) = characters.next() {
        match character {
            '#' | '.' | ' ' | '"' | ',' | '\n' => {}
            '\\' => drop(characters.next()),
            found if found == bad.character => {
                let start = span.start as usize + at;
                return Span::new(span.file, start, start + found.len_utf8());
            }
            _ => return span,
        }
    }
    span
}

fn frame(nodes: Vec<Vec3>, struts: Vec<(usize, usize)>) -> Value {
    Value::Record(Rc::new(Record::Frame(nodes, struts)))
}

arguments! {
    /// The arguments of `octet`.
    struct OctetArguments {
        /// The length of an edge of the whole, m.
        edge: Positive as "the edge",
        /// The number of parts of an edge.
        divisions: usize as "the number of divisions",
        /// True if nodes inside are kept.
        interior: bool,
    }
}

/// Runs `octet`: nodes at `i e1 + j e2 + k e3` with i + j + k ≤ divisions, joined where they are one division
/// apart; without `interior` those with all 12 neighbours are left out.
fn octet(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let OctetArguments { edge: Positive(edge), divisions, interior } = OctetArguments::read(call)?;
    if !(1..=DIVISIONS_MAX).contains(&divisions) {
        return Err(call.refuse("divisions", format!("1 to {DIVISIONS_MAX} divisions are possible")));
    }
    let n = divisions as i64;
    let mut index: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    for k in 0..=n {
        for j in 0..=n - k {
            for i in 0..=n - k - j {
                // Order of counting: layer by layer from below.
                index.insert([k, j, i], 0);
            }
        }
    }
    let near = |place: &[i64; 3]| neighbours(*place).into_iter().filter(|p| index.contains_key(p)).count();
    let kept: Vec<[i64; 3]> = index.keys().filter(|p| interior || near(p) < NEIGHBOURS).copied().collect();
    let index: BTreeMap<[i64; 3], usize> = kept.iter().enumerate().map(|(i, p)| (*p, i)).collect();
    let step = edge / divisions as f64;
    let nodes = kept.iter().map(|place| octet_point(*place) * step).collect();
    let mut struts = Vec::new();
    for (a, place) in kept.iter().enumerate() {
        let others = neighbours(*place).into_iter().filter_map(|p| index.get(&p).copied());
        struts.extend(others.filter(|&b| a < b).map(|b| (a, b)));
    }
    struts.sort_unstable();
    Ok(frame(nodes, struts))
}

/// Returns the position of grid point (k, j, i) of a regular tetrahedron of edge 1 per step that rests on a
/// face.
fn octet_point([k, j, i]: [i64; 3]) -> Vec3 {
    let (k, j, i) = (k as f64, j as f64, i as f64);
    let root3 = libm::sqrt(3.0);
    Vec3::new(i + j / 2.0 + k / 2.0, root3 / 2.0 * j + root3 / 6.0 * k, libm::sqrt(2.0 / 3.0) * k)
}

fn neighbours([k, j, i]: [i64; 3]) -> Vec<[i64; 3]> {
    const STEPS: [[i64; 3]; 6] = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 1, -1], [1, 0, -1], [1, -1, 0]];
    let both = STEPS.iter().flat_map(|s| [*s, [-s[0], -s[1], -s[2]]]);
    both.map(|s| [k + s[0], j + s[1], i + s[2]]).collect()
}

/// Runs `tetrahelix`: the Boerdijk–Coxeter helix, in which each point and the next three are a regular
/// tetrahedron.
fn tetrahelix(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let count = call.count("n", "the number of tetrahedra")?;
    if !(1..=HELIX_MAX).contains(&count) {
        return Err(call.refuse("n", format!("1 to {HELIX_MAX} tetrahedra are possible")));
    }
    let edge = call.positive("edge", "the edge")?;
    let radius = edge * 3.0 * libm::sqrt(3.0) / 10.0;
    let (rise, turn) = (edge / libm::sqrt(10.0), libm::acos(-2.0 / 3.0));
    let point = |k: usize| {
        let (s, c) = libm::sincos(turn * k as f64);
        Vec3::new(radius * c, radius * s, rise * k as f64)
    };
    let nodes = (0..count + 3).map(point).collect();
    let struts = (0..count + 3).flat_map(|a| (a + 1..=a + 3).map(move |b| (a, b)));
    Ok(frame(nodes, struts.filter(|(_, b)| *b < count + 3).collect()))
}

fn from_mesh(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mesh: &Mesh = call.get("mesh")?;
    let mut edges = BTreeSet::new();
    for face in &mesh.faces {
        for (index, &a) in face.iter().enumerate() {
            let b = face[(index + 1) % face.len()];
            edges.insert((a.min(b), a.max(b)));
        }
    }
    Ok(frame(mesh.vertices.clone(), edges.into_iter().collect()))
}

/// Runs `polyhedron`: a mesh of vertices, and faces by indices of vertices.
fn polyhedron(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let vertices = points(call, "vertices")?;
    let mut faces = Vec::new();
    for (number, face) in call.get::<&[Value]>("faces")?.iter().enumerate() {
        let Value::List(places) = face else {
            return Err(call.refuse("faces", "lists of places are wanted"));
        };
        let place = |value: &Value| match value {
            Value::Int(n) => usize::try_from(*n).ok().filter(|n| *n < vertices.len()),
            _ => None,
        };
        let face: Option<Vec<usize>> = places.iter().map(place).collect();
        let face = face.ok_or_else(|| {
            call.refuse(
                "faces",
                format!("face {number} names a vertex that there isn't: there are {}", vertices.len()),
            )
        })?;
        if face.len() < 3 {
            return Err(call.refuse("faces", format!("face {number} has fewer than three corners")));
        }
        faces.push(face);
    }
    Ok(Value::Mesh(Rc::new(Mesh { vertices, faces })))
}

fn faces(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::count(call.get::<&Mesh>("of")?.faces.len()))
}

fn load_mesh(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let scale = call.positive("scale", "the scale of a mesh")?;
    let (_, mesh) = mesh_file::read(interpreter, call, "file", scale)?;
    Ok(Value::Mesh(Rc::new(mesh)))
}

fn load_cloud(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let scale = call.positive("scale", "the scale of a cloud")?;
    Ok(Value::Cloud(Rc::new(mesh_file::read_cloud(interpreter, call, "file", scale)?)))
}

/// Runs `terrain`: a height field about `centre`, of which each list is a row along x.
fn terrain(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut heights = Vec::new();
    let mut columns = None;
    let centre = call.get::<Vec3>("centre")?;
    for (row, list) in call.get::<&[Value]>("heights")?.iter().enumerate() {
        let Value::List(list) = list else {
            return Err(call.refuse("heights", "rows of heights are wanted"));
        };
        if *columns.get_or_insert(list.len()) != list.len() {
            let wanted = columns.unwrap_or(0);
            let message = format!("row {row} has {} heights, the rows before have {wanted}", list.len());
            return Err(call.refuse("heights", message));
        }
        heights.extend(list.iter().filter_map(|height| Some(height.as_number()? + centre.z)));
    }
    interpreter.check_list(heights.len(), call.span)?;
    let spacing = call.positive("spacing", "the spacing of heights")?;
    let columns = columns.unwrap_or(0);
    let rows = heights.len().checked_div(columns).unwrap_or(0);
    let from = |count: usize, middle: f64| middle - spacing * (count.max(1) - 1) as f64 / 2.0;
    let corner = [from(columns, centre.x), from(rows, centre.y)];
    let field = HeightField { corner, spacing, columns, heights };
    match field.fault() {
        Some(fault) => Err(call.refuse("heights", fault)),
        None => Ok(Value::Terrain(Rc::new(field))),
    }
}

/// Runs `slope`: a plane through the origin as a height field.
fn slope(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let angle: f64 = call.get("angle")?;
    if !(-SLOPE_MAX..=SLOPE_MAX).contains(&angle) {
        return Err(call.refuse("angle", "a slope rises by at most 50deg"));
    }
    let along = call.get::<Vec3>("along")?.xy();
    let length = along.norm();
    if !(length > TOL_VERTICAL && length.is_finite()) {
        return Err(call.refuse("along", "a slope rises along a direction that is not vertical"));
    }
    let along = (along / length).into();
    Ok(Value::Terrain(Rc::new(HeightField::plane(along, libm::tan(angle)))))
}

fn subdivided(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mesh: &Mesh = call.get("mesh")?;
    let parts = call.count("parts", "a number of parts")?;
    let triangle = |face: &Vec<usize>| <[usize; 3]>::try_from(face.as_slice()).ok();
    let triangles: Option<Vec<[usize; 3]>> = mesh.faces.iter().map(triangle).collect();
    let triangles = triangles.ok_or_else(|| call.refuse("mesh", "only triangles can be subdivided"))?;
    if parts == 0 {
        return Err(call.refuse("parts", "an edge has at least one part"));
    }
    let faces = parts.checked_mul(parts).and_then(|squared| squared.checked_mul(triangles.len()));
    interpreter.check_list(faces.unwrap_or(usize::MAX), call.span)?;
    let (vertices, faces) = subdivide(&mesh.vertices, &triangles, parts);
    Ok(Value::Mesh(Rc::new(Mesh { vertices, faces: faces.into_iter().map(Vec::from).collect() })))
}

fn on_sphere(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mesh: &Mesh = call.get("mesh")?;
    let radius = call.positive("radius", "the radius")?;
    let out = |p: &Vec3| p.try_normalize(0.0).map(|direction| direction * radius);
    let vertices: Option<Vec<Vec3>> = mesh.vertices.iter().map(out).collect();
    let vertices = vertices.ok_or_else(|| call.refuse("mesh", "a vertex at the origin has no direction"))?;
    Ok(Value::Mesh(Rc::new(Mesh { vertices, faces: mesh.faces.clone() })))
}
