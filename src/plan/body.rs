//! The three bodies of plans behind one interface: duration, state at a time, instants.

use super::{CellBox, NodePaths, Stages, Tracks};
use crate::robot::State;

/// The motion itself.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Articulated robots: piecewise polynomial joint positions, docking and undocking.
    Tracks(Tracks),
    /// Lattices of expanding cubes: closed form, exact.
    Stages(Stages),
    /// Trusses: paths of the nodes; strut lengths follow.
    NodePaths(NodePaths),
}

/// What a plan's robot is like at an instant.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshot {
    Robot(State),
    /// In cell sizes.
    Cells(Vec<CellBox>),
    /// World positions, m.
    Nodes(Vec<[f64; 3]>),
}

impl Body {
    /// Seconds.
    pub fn duration(&self) -> f64 {
        match self {
            Body::Tracks(tracks) => tracks.duration,
            Body::Stages(stages) => stages.duration(),
            Body::NodePaths(paths) => paths.duration(),
        }
    }

    /// The robot at a time in seconds, held at the ends outside `0..duration`.
    pub fn state(&self, t: f64) -> Snapshot {
        match self {
            Body::Tracks(tracks) => Snapshot::Robot(tracks.state(t)),
            Body::Stages(stages) => Snapshot::Cells(stages.state(t)),
            Body::NodePaths(paths) => Snapshot::Nodes(paths.state(t)),
        }
    }

    /// Every instant at which the law of motion changes, with 0 and the end, in order.
    pub fn instants(&self) -> Vec<f64> {
        match self {
            Body::Tracks(tracks) => tracks.instants(),
            Body::Stages(stages) => stages.instants(),
            Body::NodePaths(paths) => paths.keyframes.iter().map(|k| k.time).collect(),
        }
    }

    /// The tracks of an articulated robot's plan.
    pub fn tracks(&self) -> Option<&Tracks> {
        match self {
            Body::Tracks(tracks) => Some(tracks),
            Body::Stages(_) | Body::NodePaths(_) => None,
        }
    }
}
