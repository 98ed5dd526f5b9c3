//! Poses, shapes and distances. The only user of parry; knows no robots.
#![allow(non_snake_case)]

pub mod angle;
pub mod height_field;
pub mod json;
pub mod polygon;
pub mod pose;
pub mod rigid_transform;
pub mod shape;

pub mod soundness;
pub mod subdivide;
pub mod volume;

pub mod part;
pub mod solid;

pub mod distance;
pub mod meeting;

mod approach;
pub mod hull;

pub use distance::Nearness;
pub use height_field::HeightField;
pub use part::Part;
pub use pose::{Pose, Vec3};
pub use rigid_transform::RigidTransform;
pub use shape::{Placed, Shape};
pub use solid::Solid;
pub use soundness::Unsound;
