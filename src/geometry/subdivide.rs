//! Subdivision of triangle meshes.

use super::pose::Vec3;
use std::collections::BTreeMap;

/// Vertices (m), and faces as indices among them.
type Surface = (Vec<Vec3>, Vec<[usize; 3]>);

/// The identity of a new vertex: a corner; a point along an edge, given by the lower and the higher corner and the
/// number of steps from the lower one; or a point within a face. Faces that share an edge so share the vertices on
/// it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum VertexKey {
    Corner(usize),
    Edge([usize; 2], usize),
    Face(usize, [usize; 2]),
}

/// Returns the vertices (m, in the frame of those given) and faces (three indices of vertices each, from 0) of a mesh
/// in which every triangle is cut into `parts`² similar ones, in the order of the triangles and of the same
/// orientation. `parts` is at least 1. Panics if an entry of `faces` has an index that is not a vertex.
pub fn subdivide(vertices: &[Vec3], faces: &[[usize; 3]], parts: usize) -> Surface {
    let mut found: BTreeMap<VertexKey, usize> = BTreeMap::new();
    let mut points: Vec<Vec3> = Vec::new();
    let mut triangles = Vec::with_capacity(faces.len() * parts * parts);
    for (face, &corners) in faces.iter().enumerate() {
        let mut at = |i: usize, j: usize| {
            let weights = [parts - i - j, i, j];
            let key = vertex_key(face, corners, weights, parts);
            *found.entry(key).or_insert_with(|| {
                let parted = corners.iter().zip(weights).map(|(c, w)| vertices[*c] * w as f64);
                points.push(parted.sum::<Vec3>() / parts as f64);
                points.len() - 1
            })
        };
        for i in 0..parts {
            for j in 0..parts - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < parts {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    (points, triangles)
}

/// Returns the identity of the vertex with these barycentric weights, which sum up to `parts`, in a face.
fn vertex_key(face: usize, corners: [usize; 3], weights: [usize; 3], parts: usize) -> VertexKey {
    if let Some(k) = weights.iter().position(|w| *w == parts) {
        return VertexKey::Corner(corners[k]);
    }
    match weights.iter().position(|w| *w == 0) {
        Some(k) => {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let (low, high) = if corners[a] < corners[b] { (a, b) } else { (b, a) };
            VertexKey::Edge([corners[low], corners[high]], weights[high])
        }
        None => VertexKey::Face(face, [weights[1], weights[2]]),
    }
}
