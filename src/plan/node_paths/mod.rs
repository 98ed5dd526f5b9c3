//! The family of trusses: the trajectories of the nodes, by their positions at keyframes; strut lengths
//! follow.

mod join;
mod json;
mod limits;
mod motion;
mod ramps;
mod reversal;
mod slice;
mod validation;

pub(super) use join::joined;
pub(super) use json::NodePathsJson;
pub use limits::{LengthSum, Margins, Surroundings, TrussLimits};
pub use motion::{Interpolation, Keyframe, NodePaths};
pub use ramps::{Progress, Ramps};
