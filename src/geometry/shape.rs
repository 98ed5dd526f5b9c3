//! The shapes that links are made of, as declared. Lengths in metres; the shape's own frame is at
//! its centre (a hull's and a mesh's where their points say).

use super::hull::extents;
use super::pose::{Pose, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A solid, the shape of a link or a part of it. Its sizes and coordinates are finite; every extent is at least 1 µm,
/// and what belongs to a link lies within 10 m of the origin of its module's frame along each axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A cuboid about the origin of its frame, with its edges along x, y and z.
    Box {
        /// The edge lengths along x, y and z of the shape's frame, m.
        #[schemars(with = "[f64; 3]")]
        size: Vec3,
    },
    /// A cylinder about the origin of its frame, as long as `length` along `axis`.
    Cylinder {
        /// The radius of the cylinder, m.
        radius: f64,
        /// The length of the cylinder along its axis, m.
        length: f64,
        /// The direction of the axis, as a unit vector in the shape's frame.
        #[schemars(with = "[f64; 3]")]
        axis: Vec3,
    },
    /// A ball about the origin of its frame.
    Sphere {
        /// The radius of the ball, m.
        radius: f64,
    },
    /// A capsule about the origin of its frame: all points within `radius` of a segment along `axis`.
    Capsule {
        /// The radius of the capsule about its segment, m.
        radius: f64,
        /// The length of the segment, between the centres of the two caps, m; it may be 0.
        length: f64,
        /// The direction of the segment, as a unit vector in the shape's frame.
        #[schemars(with = "[f64; 3]")]
        axis: Vec3,
    },
    /// The convex hull of at least four points that do not lie in one plane. A prism is one, too.
    Hull {
        /// The points whose convex hull the shape is, m, in the shape's frame.
        #[schemars(with = "Vec<[f64; 3]>")]
        points: Vec<Vec3>,
    },
    /// A closed triangle mesh; `name` is the file it was read from.
    Mesh {
        /// The name of the file that the mesh was read from, relative to the project.
        name: String,
        /// The positions of the vertices, m, in the shape's frame.
        #[schemars(with = "Vec<[f64; 3]>")]
        vertices: Vec<Vec3>,
        /// The triangles, each as three indices in `vertices`, from 0, counterclockwise as seen from outside.
        triangles: Vec<[u32; 3]>,
    },
    /// A union of solids; they may overlap.
    Union {
        /// The solids of the union, each with its pose in the frame of the union.
        parts: Vec<Placed>,
    },
}

impl Shape {
    /// Returns the least extent of the shape, m, or of a hull or mesh an estimate of it: the height of its points over
    /// three of them that are far apart, 0 if all are in one plane. For a union it is that of its thinnest part,
    /// infinite if it has none.
    pub fn thickness(&self) -> f64 {
        match self {
            Shape::Box { size } => size.min(),
            Shape::Cylinder { radius, length, .. } => f64::min(2.0 * radius, *length),
            Shape::Sphere { radius } | Shape::Capsule { radius, .. } => 2.0 * radius,
            Shape::Hull { points } | Shape::Mesh { vertices: points, .. } => {
                extents(points, 0.0).map_or(0.0, |[.., height]| height.norm())
            }
            Shape::Union { parts } => {
                parts.iter().map(|part| part.shape.thickness()).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// A shape at a pose in the frame of the link or union that it belongs to (`X_LS`, link to shape).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Placed {
    /// The pose of the shape's frame in the frame of its link or union, `X_LS`, in metres.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// The shape, in its own frame.
    pub shape: Shape,
}
