//! Shapes as a page draws them: unit boxes, cylinders and balls, placed and scaled, and meshes.
#![allow(non_snake_case)]

use super::number::{list, rotation, vector};
use super::primitives::{Primitive, primitives};
use crate::geometry::{Placed, Vec3};
use serde_json::{Value, json};

/// The indices of the unit shapes that every page has: a box, a cylinder along z, a ball.
const BOX: usize = 0;
const CYLINDER: usize = 1;
const BALL: usize = 2;
const FIRST_MESH: usize = 3;

/// The meshes of a page, each stored once for all links that use it.
#[derive(Default)]
pub(super) struct Meshes {
    /// The meshes as JSON, in order of index: the first one has the shape index after those of box, cylinder and ball.
    pub list: Vec<Value>,
    known: Vec<String>,
}

/// Returns the solids of a link, in its frame, as `{shape, p, q, s}`: the index of a shape of unit size, its position
/// in metres, its rotation as the quaternion `[x, y, z, w]`, and its size along x, y and z in metres. Adds new meshes
/// to `meshes`.
pub(super) fn solids(shapes: &[Placed], meshes: &mut Meshes) -> Value {
    let mut found = Vec::new();
    primitives(shapes, &mut |X, piece| {
        let (shape, size) = match piece {
            Primitive::Box { size } => (BOX, size),
            Primitive::Tube { radius, length } => (CYLINDER, Vec3::new(2.0 * radius, 2.0 * radius, length)),
            Primitive::Ball { radius } => (BALL, Vec3::repeat(2.0 * radius)),
            Primitive::Surface { points, triangles } => (meshes.index(points, triangles), Vec3::repeat(1.0)),
        };
        let p = vector(&X.translation.vector);
        found.push(json!({ "shape": shape, "p": p, "q": rotation(X), "s": vector(&size) }));
    });
    Value::Array(found)
}

impl Meshes {
    /// Returns the shape index of a mesh; adds the mesh if it is new.
    fn index(&mut self, points: &[Vec3], triangles: &[[u32; 3]]) -> usize {
        let radius = points.iter().map(Vec3::norm).fold(0.0, f64::max);
        let mesh = json!({
            "points": list(points.iter().flat_map(|p| [p.x, p.y, p.z])),
            "triangles": triangles.as_flattened(),
            "radius": super::number::number(radius),
        });
        let text = mesh.to_string();
        let known = self.known.iter().position(|other| *other == text);
        FIRST_MESH
            + known.unwrap_or_else(|| {
                self.known.push(text);
                self.list.push(mesh);
                self.list.len() - 1
            })
    }
}
