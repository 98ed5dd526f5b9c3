//! The family of trusses: the trajectories of the nodes, by their positions at keyframes; strut lengths
//! follow.

mod events;
mod fault;
mod join;
mod json;
mod limits;
mod motion;
mod ramps;
mod reversal;
mod slice;
mod topology;
mod validation;

pub use events::TOPOLOGY_EVENTS_MAX;
pub use fault::NodePathsFault;
pub(super) use join::joined;
pub(super) use json::NodePathsJson;
pub use limits::{LengthSum, Margins, Surroundings, TrussLimits};
pub use motion::{Interpolation, Keyframe, NodePaths};
pub use ramps::{Progress, Ramps};
pub use topology::{Topology, TopologyChange, TopologyEvent};
