//! Poses, shapes and distances. The only user of parry; knows no robots.

pub mod json;
pub mod pose;
pub mod shape;
pub mod soundness;
pub mod volume;

mod hull;

pub use pose::{Pose, Vec3};
pub use shape::{Placed, Shape};
pub use soundness::Unsound;
