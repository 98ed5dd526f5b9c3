//! Shapes taken apart into drawable primitives: boxes, cylinders, balls and triangle surfaces. Pages and
//! still pictures draw the same primitives.
#![allow(non_snake_case)]

use crate::geometry::pose::shifted;
use crate::geometry::{Placed, Pose, Shape, Vec3, hull};

/// A primitive shape (box, cylinder, ball or triangle surface) around the origin of its own frame; lengths in metres.
pub enum Primitive<'a> {
    /// A box.
    Box {
        /// The edge lengths along x, y and z, m.
        size: Vec3,
    },
    /// A cylinder along z.
    Tube {
        /// The radius, m.
        radius: f64,
        /// The length along z, m.
        length: f64,
    },
    /// A ball.
    Ball {
        /// The radius, m.
        radius: f64,
    },
    /// A surface of triangles.
    Surface {
        /// The corners, m.
        points: &'a [Vec3],
        /// The triangles as indices into `points`, from 0, counter-clockwise as seen from outside.
        triangles: &'a [[u32; 3]],
    },
}

/// Calls `draw` with each primitive of `shapes` and its pose in the frame in which the shapes are placed.
pub fn primitives(shapes: &[Placed], draw: &mut dyn FnMut(&Pose, Primitive)) {
    shapes.iter().for_each(|placed| take_apart(placed, &Pose::identity(), draw));
}

/// Calls `draw` with each primitive of one shape placed in frame L.
fn take_apart(placed: &Placed, X_LS: &Pose, draw: &mut dyn FnMut(&Pose, Primitive)) {
    let X = X_LS * placed.pose;
    match &placed.shape {
        Shape::Box { size } => draw(&X, Primitive::Box { size: *size }),
        Shape::Cylinder { radius, length, axis } => {
            draw(&(X * along(axis)), Primitive::Tube { radius: *radius, length: *length });
        }
        Shape::Sphere { radius } => draw(&X, Primitive::Ball { radius: *radius }),
        Shape::Capsule { radius, length, axis } => {
            let turned = X * along(axis);
            draw(&turned, Primitive::Tube { radius: *radius, length: *length });
            for end in [-0.5, 0.5] {
                let cap = turned * shifted(Vec3::new(0.0, 0.0, end * length));
                draw(&cap, Primitive::Ball { radius: *radius });
            }
        }
        Shape::Hull { points } => {
            if let Some(faces) = hull::faces(points) {
                draw(&X, Primitive::Surface { points: &faces.points, triangles: &faces.triangles });
            }
        }
        Shape::Mesh { vertices, triangles, .. } => {
            draw(&X, Primitive::Surface { points: vertices, triangles });
        }
        Shape::Union { parts } => parts.iter().for_each(|part| take_apart(part, &X, draw)),
    }
}

/// Returns the rotation that takes +z to the direction of `axis`, as a pose without translation; for -z it is half a
/// turn about x.
pub(super) fn along(axis: &Vec3) -> Pose {
    let turn = nalgebra::UnitQuaternion::rotation_between(&Vec3::z(), axis);
    // The axis that points down: half a turn about x.
    let turn = turn.unwrap_or_else(|| {
        nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(0.0, 1.0, 0.0, 0.0))
    });
    Pose::from_parts(Vec3::zeros().into(), turn)
}
