//! The content of a mesh file or a point cloud, whatever its format.

/// The content of a mesh file or a point cloud, in the file's own unit of length.
#[derive(Debug, Default)]
pub struct Content {
    /// The corners (x, y, z) of the mesh; of a cloud, its points.
    pub vertices: Vec<[f64; 3]>,
    /// The corners of each face in order around it, as indices into `vertices`, from 0. A cloud has no faces, unless
    /// its file is one of a mesh.
    pub faces: Vec<Vec<usize>>,
}

/// Splits faces into triangles over the same indices of vertices: one with more than three corners into the fan from
/// its first corner, which is exact for a convex face; faces of one or two corners give none. Panics for a face without
/// corners, and on an index of 2^32 or more.
pub fn triangles(faces: &[Vec<usize>]) -> Vec<[u32; 3]> {
    let place = |corner: usize| u32::try_from(corner).expect("a file has fewer than 2^32 vertices");
    let fan = |face: &Vec<usize>| -> Vec<[u32; 3]> {
        face[1..].windows(2).map(|pair| [face[0], pair[0], pair[1]].map(place)).collect()
    };
    faces.iter().flat_map(fan).collect()
}

/// Returns the number, from 1, of the line in which `rest` begins; `rest` must be an end of `bytes`.
pub(super) fn line_of(bytes: &[u8], rest: &[u8]) -> usize {
    1 + bytes[..bytes.len() - rest.len()].iter().filter(|b| **b == b'\n').count()
}
