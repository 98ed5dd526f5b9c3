//! Poses, shapes, distances and the broad phase. The only user of parry; knows no robots.
//!
//! In reading order: vectors and poses ([`pose`], [`rigid_transform`]), declared shapes ([`Shape`]) and what makes them
//! solids ([`soundness`]), convex parts and solids compiled from them ([`Part`], [`Solid`]), distances ([`distance`],
//! [`closest_points`], [`moving_lines`], [`contact_point()`], [`protrusion()`]), the search for near pairs ([`broad_phase`]), and the parts
//! of a surface that can touch the ground ([`ground_features`]).
#![allow(non_snake_case)]

mod angle;
mod height_field;
pub(crate) mod json;
mod monotone_chain;
mod polygon;
pub mod pose;
pub mod rigid_transform;
mod shape;

pub mod soundness;
mod subdivide;
pub mod volume;

mod part;
mod solid;

pub mod broad_phase;
pub mod closest_points;
mod contact_point;
pub mod distance;
pub mod moving_lines;

mod gjk;
pub mod ground_features;
pub mod hull;
mod protrusion;

pub use angle::{sin_cos, sin_cos_of_all};
pub use contact_point::contact_point;
pub use distance::SignedDistance;
pub use height_field::HeightField;
pub use monotone_chain::monotone_chain;
pub use part::Part;
pub use polygon::triangulate;
pub use pose::{Mat3, Pose, Vec3};
pub use protrusion::protrusion;
pub use rigid_transform::RigidTransform;
pub use shape::{Placed, Shape};
pub use solid::Solid;
pub use soundness::Unsound;
pub use subdivide::subdivide;
