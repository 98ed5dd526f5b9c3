//! The three bodies of plans: joint tracks, lattice stages, node paths.

use super::CauseId;
use crate::robot::{Assembly, JointId, State};
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Articulated robots: piecewise polynomial joint positions, docking and undocking.
    Tracks(Tracks),
    /// Lattices of expanding cubes: closed form, exact.
    Stages(Stages),
    /// Trusses: paths of the nodes; strut lengths follow.
    NodePaths(NodePaths),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Tracks {
    pub robot: Assembly,
    pub start: State,
    /// At most one a joint, in order of joint. A joint without a track keeps its start position.
    pub tracks: Vec<Track>,
    /// In order of time.
    pub docks: Vec<Dock>,
    /// Seconds.
    pub duration: f64,
    /// Who set the start pose: (joint, cause), and the bond at an index: (bond, cause).
    pub start_causes: Vec<(JointId, CauseId)>,
    pub bond_causes: Vec<(usize, CauseId)>,
}

/// The motion of one joint: segments in order of time that do not overlap. Between two segments and
/// after the last, the joint holds where the segment before ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    pub joint: JointId,
    pub segments: Vec<Segment>,
}

/// A polynomial piece in Bernstein form over `start..end`: the control points bound it, the first
/// and last are its end positions exactly, reversing them reverses the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    pub start: f64,
    pub end: f64,
    /// Positions (rad or m), degree = number - 1; at least 2.
    pub control: Vec<f64>,
    pub cause: CauseId,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DockKind {
    Dock,
    Undock,
}

/// A bond begins or ends to hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dock {
    pub time: f64,
    pub kind: DockKind,
    /// Index in the assembly's bonds.
    pub bond: usize,
    pub cause: CauseId,
}

/// Cells on a line of stages; lengths in cell sizes, times in the model's unit (see the planner).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stages {
    /// Index in [`Library::cells`](crate::robot::Library).
    pub cell: usize,
    /// Position of each cell at the start, in cell sizes.
    pub start: Vec<[i64; 3]>,
    pub stages: Vec<Stage>,
}

/// One stage: every cell moves along one axis by the same time law scaled by its own displacement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Seconds.
    pub duration: f64,
    pub axis: u8,
    /// Displacement of each cell in half cell sizes.
    pub shift: Vec<i64>,
    /// Size of each cell along the axis at the end of the stage, in half cell sizes.
    pub size: Vec<i64>,
    pub cause: CauseId,
}

/// A truss whose nodes move on straight lines between knots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodePaths {
    /// Index in [`Library::struts`](crate::robot::Library).
    pub strut: usize,
    pub node_names: Vec<String>,
    /// Pairs of nodes.
    pub struts: Vec<(usize, usize)>,
    /// In order of time; the first at 0.
    pub knots: Vec<Knot>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knot {
    pub time: f64,
    /// World position of each node, m.
    pub nodes: Vec<[f64; 3]>,
    pub cause: CauseId,
}
