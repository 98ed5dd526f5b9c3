//! The one judge of plans. It knows no planner, and believes nothing that a plan says of itself.

#![allow(non_snake_case)]

mod align;
mod carry;
mod contact;
mod descend;
mod footprint;
mod model;
mod sample;
mod stance;
mod support;
mod tolerances;
mod walk;

pub use contact::{Patch, Touch};
pub use model::Model;
pub use stance::Stance;
pub use tolerances::Tolerances;
pub use walk::{Course, Ended, Sample, Tip, Waypoint, walk};
