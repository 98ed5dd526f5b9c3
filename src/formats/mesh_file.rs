//! Meshes and clouds of points from files: STL, OBJ, OFF, PLY and XYZ, told apart by the ends of their names.

use super::obj;
use super::off;
use super::ply;
use super::stl;
use super::xyz;
use crate::geometry::Vec3;
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Mesh;
use crate::source::{Diagnostic, code};

/// What stands in a mesh file, in the file's own unit: corners of faces are places in `vertices`.
#[derive(Debug, Default)]
pub struct Read {
    pub vertices: Vec<[f64; 3]>,
    pub faces: Vec<Vec<usize>>,
}

/// Why a file is no mesh; where the format has lines, the line comes first.
pub type Fault = String;

type Reader = fn(&[u8]) -> Result<Read, Fault>;

/// By the end of a file's name: what the format is called, and what reads it.
const FORMATS: &[(&str, &str, Reader)] = &[
    ("stl", "STL", stl::read),
    ("obj", "OBJ", obj::read),
    ("off", "OFF", off::read),
    ("ply", "PLY", ply::read),
];

/// The same for clouds.
const CLOUDS: &[(&str, &str, Reader)] = &[("ply", "PLY", ply::read), ("xyz", "XYZ", xyz::read)];

/// The mesh in the file that argument `index` names, with its path in the project; `scale` is the
/// length of one of the file's units, m.
pub fn read(interpreter: &mut Interpreter, call: &Call, index: usize, scale: f64) -> Eval<(String, Mesh)> {
    let (path, read) = read_as(interpreter, call, index, "mesh", FORMATS, checked)?;
    let vertices = read.vertices.into_iter().map(|p| Vec3::from(p) * scale).collect();
    Ok((path, Mesh { vertices, faces: read.faces }))
}

/// The points in the file that argument `index` names.
pub fn read_cloud(interpreter: &mut Interpreter, call: &Call, index: usize, scale: f64) -> Eval<Vec<Vec3>> {
    let (_, read) = read_as(interpreter, call, index, "cloud", CLOUDS, checked_cloud)?;
    Ok(read.vertices.into_iter().map(|p| Vec3::from(p) * scale).collect())
}

/// What the file holds, with its path in the project.
fn read_as(
    interpreter: &mut Interpreter,
    call: &Call,
    index: usize,
    what: &str,
    formats: &[(&str, &str, Reader)],
    checked: fn(Read) -> Result<Read, Fault>,
) -> Eval<(String, Read)> {
    let name = call.text(index)?;
    let ending = name.rsplit_once('.').map_or_else(String::new, |(_, end)| end.to_ascii_lowercase());
    let Some((_, format, reader)) = formats.iter().find(|(end, ..)| *end == ending) else {
        let message = format!("`{name}` is no {what} file by its name");
        let ends: Vec<String> = formats.iter().map(|(end, ..)| format!("`.{end}`")).collect();
        let (last, others) = ends.split_last().expect("there are formats");
        return Err(Diagnostic::error(code::CANNOT_READ, message)
            .label(call.at(index), format!("not a name of a {what} file"))
            .hint(format!("names of {what} files end in {} or {last}", others.join(", ")))
            .into());
    };
    let (path, bytes) = interpreter.project_file(call, index)?;
    let refused = |why: Fault| {
        let message = format!("`{path}` can't be read as {format}: {why}");
        fault(code::CANNOT_READ, call.at(index), message, why)
    };
    let read = reader(&bytes).and_then(checked).map_err(refused)?;
    interpreter.check_list(read.faces.len().max(read.vertices.len()), call.at(index))?;
    Ok((path, read))
}

fn checked_cloud(read: Read) -> Result<Read, Fault> {
    if read.vertices.is_empty() {
        return Err("it holds no points".into());
    }
    finite(&read)?;
    Ok(read)
}

fn finite(read: &Read) -> Result<(), Fault> {
    match read.vertices.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(format!("a coordinate of vertex {vertex} is no finite number")),
        None => Ok(()),
    }
}

/// What holds for a mesh of any format.
fn checked(read: Read) -> Result<Read, Fault> {
    if read.faces.is_empty() {
        return Err("it holds no faces".into());
    }
    finite(&read)?;
    for (number, face) in read.faces.iter().enumerate() {
        if face.len() < 3 {
            return Err(format!("face {number} has fewer than three corners"));
        }
        if let Some(corner) = face.iter().find(|corner| **corner >= read.vertices.len()) {
            let count = read.vertices.len();
            return Err(format!("face {number} names vertex {corner}; there are {count}"));
        }
    }
    Ok(read)
}

/// Faces of more than three corners as fans of triangles.
pub fn triangles(faces: &[Vec<usize>]) -> Vec<[u32; 3]> {
    let place = |corner: usize| u32::try_from(corner).expect("a file has fewer than 2^32 vertices");
    let fan = |face: &Vec<usize>| -> Vec<[u32; 3]> {
        face[1..].windows(2).map(|pair| [face[0], pair[0], pair[1]].map(place)).collect()
    };
    faces.iter().flat_map(fan).collect()
}

/// The number of the line in which `rest`, an end of `bytes`, begins, counted from 1.
pub fn line_of(bytes: &[u8], rest: &[u8]) -> usize {
    1 + bytes[..bytes.len() - rest.len()].iter().filter(|b| **b == b'\n').count()
}
