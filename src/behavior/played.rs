//! The result of a run of a program.

use super::limits::Issue;
use super::schedule::ContractInterval;
use crate::plan::{DockingEvent, Exemption, Track};
use crate::robot::Assembly;
use std::sync::Arc;

/// The result of a run that has come to its end.
pub(super) struct Played {
    /// The robot, with the bonds that docking added.
    pub(super) robot: Arc<Assembly>,
    /// The trajectory of every joint that moves, ascending by joint.
    pub(super) tracks: Vec<Track>,
    /// The positions at the start, by the number in the joint's `JointId`, rad or m.
    pub(super) joints: Vec<f64>,
    /// The positions at the end, by the number in the joint's `JointId`, rad or m.
    pub(super) end: Vec<f64>,
    /// The changes of bonds, in order of time.
    pub(super) docks: Vec<DockingEvent>,
    /// The bonds whose turns depend on how robots stand; see [`Run::open_turns`].
    pub(super) open_turns: Vec<usize>,
    /// The time at which all is done and at rest, s.
    pub(super) duration: f64,
    /// The intervals that are excused from a check.
    pub(super) exemptions: Vec<Exemption>,
    /// The intervals over which contracts are judged.
    pub(super) contracts: Vec<ContractInterval>,
    /// Stated durations that are shorter than the limits allow.
    pub(super) issues: Vec<Issue>,
    /// The number of actions executed.
    pub(super) actions: u64,
    /// The number of nodes entered, which measures the work.
    pub(super) steps: u64,
}
