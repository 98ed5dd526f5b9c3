//! The family of articulated robots: joint trajectories (tracks), piecewise polynomials in Bernstein form,
//! with docking and undocking.

mod join;
mod json;
mod lasting_trees;
mod motion;
mod names;
mod obstacle;
mod remap;
mod reversal;
mod slice;
mod timeline;
mod validation;

pub(super) use join::fitted;
pub(super) use json::TracksJson;
pub use lasting_trees::LastingTrees;
pub use motion::{DockingEvent, DockingKind, Segment, Track, Tracks};
pub(super) use names::RobotNames;
pub use obstacle::Obstacle;
pub use remap::Remap;
pub use timeline::timeline;
