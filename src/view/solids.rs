//! Shapes as a page draws them: unit boxes, cylinders and balls, placed and scaled, and meshes.
#![allow(non_snake_case)]

use super::mesh::along;
use super::number::{list, rotation, vector};
use crate::geometry::pose::shifted;
use crate::geometry::{Placed, Pose, Shape, Vec3, hull};
use serde_json::{Value, json};

/// Unit shapes that every page has: 0 a box, 1 a cylinder along z, 2 a ball.
const BOX: usize = 0;
const CYLINDER: usize = 1;
const BALL: usize = 2;
const FIRST_MESH: usize = 3;

/// The meshes of a page, each once.
#[derive(Default)]
pub struct Meshes {
    pub list: Vec<Value>,
    known: Vec<String>,
}

/// The solids of a link, in its frame: `{shape, p, q, s}`.
pub fn solids(shapes: &[Placed], meshes: &mut Meshes) -> Value {
    let mut found = Vec::new();
    shapes.iter().for_each(|placed| add(placed, &Pose::identity(), meshes, &mut found));
    Value::Array(found)
}

fn add(placed: &Placed, X_LS: &Pose, meshes: &mut Meshes, found: &mut Vec<Value>) {
    let X = X_LS * placed.pose;
    let mut solid = |shape: usize, X: &Pose, size: Vec3| {
        let p = vector(&X.translation.vector);
        found.push(json!({ "shape": shape, "p": p, "q": rotation(X), "s": vector(&size) }));
    };
    match &placed.shape {
        Shape::Box { size } => solid(BOX, &X, *size),
        Shape::Cylinder { radius, length, axis } => {
            solid(CYLINDER, &(X * along(axis)), Vec3::new(2.0 * radius, 2.0 * radius, *length));
        }
        Shape::Sphere { radius } => solid(BALL, &X, Vec3::repeat(2.0 * radius)),
        Shape::Capsule { radius, length, axis } => {
            let turned = X * along(axis);
            solid(CYLINDER, &turned, Vec3::new(2.0 * radius, 2.0 * radius, *length));
            for end in [-0.5, 0.5] {
                let cap = turned * shifted(Vec3::new(0.0, 0.0, end * length));
                solid(BALL, &cap, Vec3::repeat(2.0 * radius));
            }
        }
        Shape::Hull { points } => {
            if let Some(faces) = hull::faces(points) {
                solid(meshes.index(&faces.points, &faces.triangles), &X, Vec3::repeat(1.0));
            }
        }
        Shape::Mesh { vertices, triangles, .. } => {
            solid(meshes.index(vertices, triangles), &X, Vec3::repeat(1.0));
        }
        Shape::Union { parts } => parts.iter().for_each(|part| add(part, &X, meshes, found)),
    }
}

impl Meshes {
    /// The number of a mesh's shape.
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
