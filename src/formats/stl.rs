//! Triangle meshes from STL files, binary and text.
//!
//! A reader of our own: the kept crate takes every file that begins with `solid` for text, which many
//! binary files do, reads the first solid only, and doesn't say in which line it stopped.

use super::content::Content;
use super::fault::FormatFault;
use std::collections::HashMap;

/// The length of the header of a binary file with the number of triangles, bytes.
const HEADER: usize = 84;
/// The length of a triangle of a binary file, bytes.
const TRIANGLE: usize = 50;

/// Reads the triangles of an STL file, in text or binary, in the file's own unit of length. Corners at one position
/// become one vertex.
///
/// # Errors
/// The first [`FormatFault`] of the bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let count = bytes.get(80..HEADER).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let corners = match count {
        Some(count) if bytes.len() == HEADER + TRIANGLE * count => binary(&bytes[HEADER..]),
        _ => text(bytes)?,
    };
    if corners.is_empty() {
        return Err(FormatFault::Nothing { what: "triangles" });
    }
    Ok(shared(&corners))
}

/// Returns the triangles of a binary file from the bytes after its header.
fn binary(body: &[u8]) -> Vec<[[f32; 3]; 3]> {
    let number = |b: &[u8], at: usize| f32::from_le_bytes([b[at], b[at + 1], b[at + 2], b[at + 3]]);
    let corner = |b: &[u8], k: usize| [0, 4, 8].map(|c| number(b, 12 + 12 * k + c));
    body.chunks_exact(TRIANGLE).map(|b| [0, 1, 2].map(|k| corner(b, k))).collect()
}

/// Returns the triangles of a text, of all its solids: each three lines `vertex x y z`.
fn text(bytes: &[u8]) -> Result<Vec<[[f32; 3]; 3]>, FormatFault> {
    let text = std::str::from_utf8(bytes).map_err(|_| FormatFault::StlLength)?;
    let mut corners = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
        let corner = <[f32; 3]>::try_from(numbers);
        corners.push(corner.map_err(|_| FormatFault::BadLine { line: index + 1, what: "vertex" })?);
    }
    if corners.len() % 3 != 0 {
        return Err(FormatFault::IncompleteTriangle);
    }
    Ok(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

/// Returns triangles as faces of shared vertices: corners at one position are one vertex.
fn shared(corners: &[[[f32; 3]; 3]]) -> Content {
    let mut vertices = Vec::new();
    let mut known: HashMap<[u32; 3], usize> = HashMap::new();
    let mut vertex = |corner: &[f32; 3]| {
        // Adding zero makes one of the two zeros, which are one position.
        let key = corner.map(|x| (x + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            vertices.push(corner.map(f64::from));
            vertices.len() - 1
        })
    };
    let faces = corners.iter().map(|t| t.iter().map(&mut vertex).collect()).collect();
    Content { vertices, faces }
}
