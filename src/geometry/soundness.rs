//! Validation of shapes: the conditions under which they are solids, and the faults of those that are not.

use super::hull::extents;
use super::pose::{Pose, Vec3};
use super::shape::{Placed, Shape};
use std::collections::BTreeMap;
use std::fmt;

/// Threshold: the least extent of a solid, m. Thinner ones have no inside that distances in double precision could
/// resolve.
pub const TOL_THICKNESS: f64 = 1e-6;

/// The greatest length, coordinate or distance of what is declared, m: 1 km. Double precision resolves positions at
/// that distance to 1e-13 m, and squares of such distances to 1e-10 m², so that the tolerances of 1e-9 m hold there
/// as they do near the origin.
pub const EXTENT_MAX: f64 = 1e3;

/// Threshold: the most by which the norm of a direction or of a rotation may differ from 1, without unit: rounding.
pub const TOL_UNIT: f64 = 1e-6;

/// The fault by which a shape is not a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum Unsound {
    /// A number of a shape or pose that is not finite, or whose absolute value is larger than [`EXTENT_MAX`].
    NotFinite,
    /// A size of a shape, given by its name, that is zero, negative or less than [`TOL_THICKNESS`].
    TooThin {
        /// The name of the size, such as `radius`.
        what: &'static str,
        /// The size that was found, m.
        value: f64,
    },
    /// A cylinder or capsule whose axis has no direction: the vector is shorter than [`TOL_THICKNESS`].
    NoAxis,
    /// A hull or mesh of fewer than four points, or of points that all lie in one plane to [`TOL_THICKNESS`].
    Flat,
    /// A triangle of a mesh with a corner whose index is too large for the list of vertices.
    NoVertex {
        /// The index of the triangle in the mesh, from 0.
        triangle: usize,
    },
    /// A mesh that is not closed: an edge has not as many triangles in one direction as in the opposite one.
    Open {
        /// The lesser index, from 0, of the edge's two vertices in the mesh.
        a: u32,
        /// The greater index, from 0, of the edge's two vertices in the mesh.
        b: u32,
    },
    /// A mesh whose triangles enclose less than the cube of [`TOL_THICKNESS`], or are turned inside out.
    NoInside,
    /// An empty list of shapes, or of vertices.
    Empty,
    /// A pose whose rotation is a quaternion with a norm that differs from 1 by [`TOL_UNIT`] or more.
    NotRigid,
}

impl fmt::Display for Unsound {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Unsound::NotFinite => write!(f, "a size or coordinate is not a finite number of at most 1 km"),
            Unsound::TooThin { what, .. } => write!(f, "the {what} must be at least 1 um"),
            Unsound::NoAxis => write!(f, "the axis has no direction"),
            Unsound::Flat => {
                write!(f, "the points span no volume; a hull needs four that are not in one plane")
            }
            Unsound::NoVertex { triangle } => {
                write!(f, "triangle {triangle} names a vertex that there isn't")
            }
            Unsound::Open { a, b } => {
                write!(f, "the mesh is not closed: the edge from vertex {a} to {b} lacks its other side")
            }
            Unsound::NoInside => write!(f, "the mesh encloses no volume, or its triangles face inwards"),
            Unsound::Empty => write!(f, "there is no shape"),
            Unsound::NotRigid => write!(f, "the rotation of a pose is no unit quaternion"),
        }
    }
}

/// Checks that a shape is a solid that can be weighed and judged.
///
/// # Errors
/// Its first fault; of a union the first fault of a part or its pose.
pub fn check(shape: &Shape) -> Result<(), Unsound> {
    match shape {
        Shape::Box { size } => {
            ["length", "width", "height"].iter().zip(size.iter()).try_for_each(|(what, v)| extent(what, *v))
        }
        Shape::Cylinder { radius, length, axis } => {
            extent("radius", *radius)?;
            extent("length", *length)?;
            direction(axis)
        }
        Shape::Sphere { radius } => extent("radius", *radius),
        Shape::Capsule { radius, length, axis } => {
            extent("radius", *radius)?;
            finite(*length)?;
            if *length < 0.0 {
                return Err(Unsound::TooThin { what: "length", value: *length });
            }
            direction(axis)
        }
        Shape::Hull { points } => hull(points),
        Shape::Mesh { vertices, triangles, .. } => mesh(vertices, triangles),
        Shape::Union { parts } => {
            if parts.is_empty() {
                return Err(Unsound::Empty);
            }
            parts.iter().try_for_each(check_placed)
        }
    }
}

/// Checks that a shape is a solid at a rigid pose not farther away than [`EXTENT_MAX`].
///
/// # Errors
/// The first fault of the pose, or of the shape.
pub fn check_placed(placed: &Placed) -> Result<(), Unsound> {
    check_pose(&placed.pose)?;
    check(&placed.shape)
}

/// Checks that a pose is a rigid displacement by at most [`EXTENT_MAX`] along each axis.
///
/// # Errors
/// [`Unsound::NotFinite`] of its position, or [`Unsound::NotRigid`] of its rotation.
pub fn check_pose(pose: &Pose) -> Result<(), Unsound> {
    pose.translation.vector.iter().try_for_each(|v| finite(*v))?;
    let norm = pose.rotation.quaternion().norm();
    if (norm - 1.0).abs() < TOL_UNIT { Ok(()) } else { Err(Unsound::NotRigid) }
}

/// Returns true if all coordinates (m) are finite and of an absolute value of at most [`EXTENT_MAX`].
pub fn in_reach(position: &[f64]) -> bool {
    position.iter().all(|c| c.abs() <= EXTENT_MAX)
}

fn finite(value: f64) -> Result<(), Unsound> {
    if value.abs() <= EXTENT_MAX { Ok(()) } else { Err(Unsound::NotFinite) }
}

fn extent(what: &'static str, value: f64) -> Result<(), Unsound> {
    finite(value)?;
    if value < TOL_THICKNESS { Err(Unsound::TooThin { what, value }) } else { Ok(()) }
}

fn direction(axis: &Vec3) -> Result<(), Unsound> {
    axis.iter().try_for_each(|v| finite(*v))?;
    if axis.norm() < TOL_THICKNESS { Err(Unsound::NoAxis) } else { Ok(()) }
}

/// Checks that the points' extent across their flattest direction is more than rounding.
fn hull(points: &[Vec3]) -> Result<(), Unsound> {
    points.iter().flat_map(|p| p.iter()).try_for_each(|v| finite(*v))?;
    extents(points, TOL_THICKNESS).map(|_| ()).ok_or(Unsound::Flat)
}

/// Checks that a mesh is closed and oriented: every directed edge has its opposite, as often.
fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), Unsound> {
    vertices.iter().flat_map(|p| p.iter()).try_for_each(|v| finite(*v))?;
    let mut edges: BTreeMap<(u32, u32), i64> = BTreeMap::new();
    for (index, &[a, b, c]) in triangles.iter().enumerate() {
        if [a, b, c].iter().any(|&v| v as usize >= vertices.len()) {
            return Err(Unsound::NoVertex { triangle: index });
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (key, way) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *edges.entry(key).or_default() += way;
        }
    }
    if let Some(((a, b), _)) = edges.iter().find(|(_, ways)| **ways != 0) {
        return Err(Unsound::Open { a: *a, b: *b });
    }
    let origin = *vertices.first().ok_or(Unsound::Empty)?;
    let inside = triangles.iter().map(|t| {
        let [a, b, c] = t.map(|i| vertices[i as usize] - origin);
        a.dot(&b.cross(&c)) / 6.0
    });
    let least = TOL_THICKNESS * TOL_THICKNESS * TOL_THICKNESS;
    if inside.sum::<f64>() < least { Err(Unsound::NoInside) } else { hull(vertices) }
}
