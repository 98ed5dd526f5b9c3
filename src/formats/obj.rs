//! Triangle meshes from Wavefront OBJ files.
//!
//! Vertices and faces are what matters here. Everything else (normals, materials, groups) is taken
//! out before the crate sees it: so its numbers are never looked up, and the file is one object whose
//! vertices are shared.

use super::content::{Content, line_of};
use super::fault::FormatFault;
use tobj::{LoadError, LoadOptions};

/// Reads the vertices and faces of a Wavefront OBJ file, all its objects as one, in the file's own unit of length.
///
/// # Errors
/// The first [`FormatFault`] of the bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let plain = plain(bytes);
    let mut rest: &[u8] = &plain;
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut rest, &options, no_materials).map_err(|error| {
        // The reader finds the fault of a line before it reads the next, and other faults at the end.
        let line = line_of(&plain, rest) - 1;
        match error {
            LoadError::FaceVertexOutOfBounds => FormatFault::NoSuchVertex,
            LoadError::ReadError => FormatFault::LineNotText { line: line + 1 },
            other => FormatFault::Reader(format!("line {line}: {other}")),
        }
    })?;
    let mut read = Content::default();
    for model in models {
        let (mesh, first) = (model.mesh, read.vertices.len());
        read.vertices.extend(mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
        let mut corners = mesh.indices.iter().map(|corner| first + *corner as usize);
        let triangles = mesh.indices.len() / 3;
        let sizes = if mesh.face_arities.is_empty() { vec![3; triangles] } else { mesh.face_arities };
        for size in sizes {
            read.faces.push(corners.by_ref().take(size as usize).collect());
        }
    }
    Ok(read)
}

/// Returns the lines with vertices and faces; every other line is left empty, and corners keep only the
/// number of their vertex.
fn plain(bytes: &[u8]) -> Vec<u8> {
    let mut plain = Vec::with_capacity(bytes.len());
    for line in bytes.split_inclusive(|b| *b == b'\n') {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => plain.extend(line.strip_suffix(b"\n").unwrap_or(line)),
            Some(b"f") => {
                plain.push(b'f');
                for corner in words {
                    plain.push(b' ');
                    plain.extend(corner.split(|b| *b == b'/').next().unwrap_or_default());
                }
            }
            _ => {}
        }
        plain.push(b'\n');
    }
    plain
}
