//! Faults in the form of a plan: the reasons why a plan cannot be read, or cannot be judged at all.
//!
//! A fault is not a verdict on the motion. It says that an index is too large for its list, that times are out of
//! order, or that a number has no meaning, so that whoever comes after may index without asking. Times are in s,
//! positions in rad or m.

use super::node_paths::NodePathsFault;
use super::slope::SLOPE_RISE_MAX;
use super::stages::StagesFault;
use super::time::DURATION_MAX;
use super::validation::{Unwritable, check_serialisable};
use super::world::DynamicsModel;
use crate::geometry::Unsound;
use crate::robot::LibraryFault;
use serde::Serialize;
use std::fmt;

/// The first fault that was found in the form of a plan, before it is judged.
#[derive(Clone, Debug, PartialEq)]
pub enum PlanFault {
    /// An index into a list of things of one sort that is too large for the list.
    Index {
        /// The sort of things in the list, as a word: `module`.
        what: &'static str,
        /// The index that is too large, from 0.
        index: usize,
        /// The number of things in the list.
        count: usize,
    },
    /// A duration that is negative, not finite, or longer than [`DURATION_MAX`].
    Duration {
        /// The duration that the plan states, s.
        duration: f64,
    },
    /// Times that must ascend and do not.
    TimeOrder {
        /// The list that has these times, in words.
        what: &'static str,
    },
    /// A number that no file can hold, in a part of the plan.
    Unwritable {
        /// The part of the plan, in words.
        part: &'static str,
        /// The value that no file can hold.
        value: Unwritable,
    },
    /// A value that a planner minimised, or its bound, that is not a number from 0 on.
    ObjectiveValue {
        /// The value that was found, in the unit of what was minimised.
        value: f64,
    },
    /// A lower bound above the value that it is about.
    BoundAbove {
        /// The stated lower bound, in the unit of what was minimised.
        bound: f64,
        /// The stated value of the plan, in the same unit as the bound.
        reached: f64,
    },
    /// A first world that does not hold from 0 on.
    FirstWorld,
    /// An exemption that ends before it begins.
    ExemptionOrder,
    /// A gravity that points upwards (is negative), or is not a number.
    Gravity,
    /// A negative coefficient of friction in a world, or one that is not a number.
    Friction,
    /// A slope that is steeper than [`SLOPE_RISE_MAX`](super::SLOPE_RISE_MAX), given by its rise, m per m.
    SlopeTooSteep {
        /// The rise, m per m.
        rise: f64,
    },
    /// A slope on which no robot of modules settles by its weight.
    SlopeUnsettled,
    /// Worlds of one plan on different slopes.
    SlopeChanges,
    /// A world that holds the base fast, for a robot that has none.
    NoBaseToHold,
    /// A sampling interval of the judge that is not positive.
    SampleInterval {
        /// The sampling interval that was found, s.
        interval: f64,
    },
    /// A negative longest time without support, or one that is not a number.
    UnstableFor,
    /// A reserve that is not between 0 and 1.
    Reserve {
        /// The reserve that was found, as a fraction of the limits.
        reserve: f64,
    },
    /// The greatest slip is negative.
    SlipMax,
    /// A part of their speed by which contacts slip that is not from 0 to 1.
    Slip {
        /// The part.
        slip: f64,
    },
    /// Settings by which the judge may take no sample.
    NoSamples,
    /// A node of a program whose child does not stand before it in the table.
    ProgramChild {
        /// The index of the node in the program's table, from 0.
        node: usize,
        /// The index of its child in the program's table, from 0.
        child: usize,
    },
    /// An index for the root of a program at which the table has no node.
    ProgramRoot {
        /// The index that is given for the root, from 0.
        node: usize,
    },
    /// A motion in the program that is stated by its goal and has not become actions.
    Goal {
        /// The name of the built-in that makes such a goal.
        name: &'static str,
    },
    /// A path of a port in a plan of a lattice or a truss.
    PathFamily,
    /// A path of a port with a negative deviation, or an interval that ends before it begins.
    PathNumbers,
    /// A contract in the program: plans have none.
    Contract,
    /// A fault inside the track of a joint.
    InTrack {
        /// The joint, by the number in its `JointId`.
        joint: u32,
        /// The fault that the track has.
        fault: Box<PlanFault>,
    },
    /// A fault inside a stage of a lattice's plan.
    InStage {
        /// The name of the stage, as the plan states it.
        stage: String,
        /// The fault that the stage has.
        fault: Box<PlanFault>,
    },
    /// A fault in the bonds that hold after a docking or an undocking.
    After {
        /// The time of the docking or undocking, s.
        time: f64,
        /// The fault in the bonds that hold from then on.
        fault: Box<PlanFault>,
    },
    /// A name in a file that contradicts the index which it stands beside.
    Name {
        /// The sort of the thing that has the name, as a word: `module`.
        what: &'static str,
        /// The index of the thing among those of its sort, from 0.
        index: usize,
        /// The name that the file states.
        stated: String,
        /// The name of the thing that the index stands for.
        name: String,
    },
    /// Names in a file that are too few or too many, or stand in another order.
    Names {
        /// The sort of the first name that has no counterpart, as a word: `module`.
        what: &'static str,
    },
    /// A world that states other dynamics than those under which plans of this family are judged.
    Dynamics {
        /// The dynamics that the file states.
        stated: DynamicsModel,
        /// The dynamics that plans of this family are judged under.
        judged: DynamicsModel,
    },
    /// A fault of the library: of a module type, a connector, a cell or a strut.
    Library(LibraryFault),
    /// A pose or a position that is not finite, farther away than
    /// [`EXTENT_MAX`](crate::geometry::soundness::EXTENT_MAX), or no rigid displacement.
    Pose {
        /// The thing that has the pose, in words.
        of: &'static str,
        /// The fault that the pose has.
        fault: Unsound,
    },
    /// A number whose absolute value is above its limit, or that is not a number.
    Bound {
        /// The name of the quantity in words.
        what: &'static str,
        /// The value that was found, in SI units.
        value: f64,
        /// The greatest absolute value that is allowed, in SI units.
        most: f64,
    },
    /// A fault of the plan of an articulated robot.
    Tracks(TracksFault),
    /// A fault of the plan of a lattice.
    Stages(StagesFault),
    /// A fault of the plan of a truss.
    NodePaths(NodePathsFault),
}

/// A fault of the plan of an articulated robot.
#[derive(Clone, Debug, PartialEq)]
pub enum TracksFault {
    /// Two modules, or a module and an obstacle, that have one name.
    SharedName {
        /// The name that both have.
        name: String,
    },
    /// A start pose without one position for each joint.
    StartJoints {
        /// The number of joints, which is the number of positions that the start pose must have.
        joints: usize,
    },
    /// A start pose without one flag for each bond.
    StartBonds {
        /// The number of bonds, which is the number of flags that the start pose must have.
        bonds: usize,
    },
    /// Tracks that are not in ascending order of joint.
    TrackOrder,
    /// A segment whose degree is below 1 or above [`DEGREE_MAX`](crate::plan::polynomial::DEGREE_MAX).
    ControlPoints {
        /// The time at which the segment begins, s.
        time: f64,
        /// The number of control points of the segment, one more than its degree.
        count: usize,
    },
    /// A segment that begins before the one before ends, ends before it begins, or ends after the plan.
    SegmentOrder {
        /// The time at which the segment begins, s.
        start: f64,
        /// The time at which the segment ends, s.
        end: f64,
    },
    /// A segment that does not begin at the position where the joint is.
    Jump {
        /// The time at which the segment begins, s.
        time: f64,
    },
    /// A docking or undocking out of order, or after the end.
    EventOrder {
        /// The time of the docking or undocking, s.
        time: f64,
    },
    /// A bond that is docked while it holds, or undocked while it does not.
    BondUnchanged {
        /// The time of the docking or undocking, s.
        time: f64,
        /// The index of the bond in [`Assembly::bonds`](crate::robot::Assembly::bonds).
        bond: usize,
        /// True if the bond holds before the event.
        holds: bool,
    },
    /// A joint that is moved farther from 0 than is allowed.
    FarJoint {
        /// The greatest absolute value of a joint's position that is allowed, rad or m.
        limit: f64,
    },
    /// Two clusters at the start that bonds connect, or one with the base.
    OneCluster {
        /// The path name of the module that stands for the cluster.
        reference: String,
    },
    /// A misalignment of a bond that does not hold at the start, or that is stated twice or out of order.
    Misalignment {
        /// The name of the bond.
        bond: String,
    },
    /// An obstacle that is no solid.
    Obstacle {
        /// The name of the obstacle.
        name: String,
        /// The fault of its shapes.
        fault: Unsound,
    },
    /// A track of a joint that takes no commands.
    NoCommands {
        /// The path name of the joint.
        joint: String,
    },
    /// A port that two bonds hold at once.
    PortTaken {
        /// The path name of the port.
        port: String,
    },
    /// A bond between ports whose connectors do not mate.
    NoMate {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
}

/// Returns `Ok` if a condition holds.
///
/// # Errors
/// The fault that `fault` returns, if the condition does not hold.
pub(super) fn need<F: Into<PlanFault>>(holds: bool, fault: impl FnOnce() -> F) -> Result<(), PlanFault> {
    if holds { Ok(()) } else { Err(fault().into()) }
}

/// Returns `Ok` if an index, from 0, is less than the number `count` of things of the sort `what`, a word for the
/// message.
///
/// # Errors
/// [`PlanFault::Index`] otherwise.
pub(super) fn need_index(index: usize, count: usize, what: &'static str) -> Result<(), PlanFault> {
    need(index < count, || PlanFault::Index { what, index, count })
}

/// Returns `Ok` if every time (s) is later than the one before; `what`: the name of the times, for the message.
///
/// # Errors
/// [`PlanFault::TimeOrder`] otherwise, and if one of several times is NaN.
pub(super) fn need_ascending(times: &[f64], what: &'static str) -> Result<(), PlanFault> {
    need(times.windows(2).all(|w| w[0] < w[1]), || PlanFault::TimeOrder { what })
}

/// Returns `Ok` if the absolute value of a number is at most `most`, both in one unit; `what`: the name of the
/// number, for the message.
///
/// # Errors
/// [`PlanFault::Bound`] otherwise, and for NaN.
pub(super) fn need_bounded(value: f64, most: f64, what: &'static str) -> Result<(), PlanFault> {
    need(value.abs() <= most, || PlanFault::Bound { what, value, most })
}

/// Returns `Ok` if JSON can hold a part of a plan: all its numbers are finite, and it is not nested too deeply.
/// `part`: its name, for the message.
///
/// # Errors
/// [`PlanFault::Unwritable`] otherwise.
pub(super) fn need_finite(part: &'static str, value: &impl Serialize) -> Result<(), PlanFault> {
    check_serialisable(value).map_err(|value| PlanFault::Unwritable { part, value })
}

impl From<LibraryFault> for PlanFault {
    fn from(fault: LibraryFault) -> PlanFault {
        PlanFault::Library(fault)
    }
}

impl From<TracksFault> for PlanFault {
    fn from(fault: TracksFault) -> PlanFault {
        PlanFault::Tracks(fault)
    }
}

impl From<NodePathsFault> for PlanFault {
    fn from(fault: NodePathsFault) -> PlanFault {
        PlanFault::NodePaths(fault)
    }
}

impl fmt::Display for PlanFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlanFault::Index { what, index, count } => {
                write!(f, "there is no {what} {index}: there are {count}")
            }
            PlanFault::Duration { duration } => {
                write!(f, "the duration of {duration} s is outside 0..{DURATION_MAX}")
            }
            PlanFault::TimeOrder { what } => write!(f, "{what} are not in order of time"),
            PlanFault::Unwritable { part, value } => write!(f, "{part}: {value}"),
            PlanFault::ObjectiveValue { value } => {
                write!(
                    f,
                    "the provenance states {value} as what was minimised or as its bound; neither is below 0"
                )
            }
            PlanFault::BoundAbove { bound, reached } => write!(
                f,
                "the provenance states a lower bound of {bound}, above the {reached} that this plan reaches: no plan is below its bound"
            ),
            PlanFault::FirstWorld => write!(f, "the first world must hold from 0 on"),
            PlanFault::ExemptionOrder => write!(f, "an exemption ends before it begins"),
            PlanFault::Gravity => write!(f, "gravity points upwards"),
            PlanFault::Friction => write!(f, "friction is negative"),
            PlanFault::SlopeTooSteep { rise } => {
                write!(f, "the ground rises by {rise} m per m; at most {SLOPE_RISE_MAX} is allowed")
            }
            PlanFault::SlopeUnsettled => {
                write!(
                    f,
                    "a slope is ground on which a robot of modules settles by its weight, and nothing else"
                )
            }
            PlanFault::SlopeChanges => write!(f, "the ground slopes otherwise in another world of the plan"),
            PlanFault::NoBaseToHold => write!(f, "only a robot of modules has a base to hold"),
            PlanFault::SampleInterval { interval } => write!(f, "a sample every {interval} s is none"),
            PlanFault::UnstableFor => write!(f, "`unstable_for` is negative"),
            PlanFault::Reserve { reserve } => write!(f, "`reserve` is {reserve}, and not from 0 to 1"),
            PlanFault::SlipMax => write!(f, "`slip_max` is negative"),
            PlanFault::Slip { slip } => write!(f, "`slip` is {slip}, and not from 0 to 1"),
            PlanFault::NoSamples => write!(f, "no samples are allowed"),
            PlanFault::ProgramChild { node, child } => write!(
                f,
                "node {node} of the program has node {child} as a child, which does not stand before it"
            ),
            PlanFault::ProgramRoot { node } => write!(f, "the program has no node {node} to begin with"),
            PlanFault::Goal { name } => {
                write!(f, "`{name}` stands in the program as a goal, without its motion")
            }
            PlanFault::PathFamily => write!(f, "a path of a port stands in a plan that has no ports"),
            PlanFault::PathNumbers => {
                write!(f, "a path has a negative deviation, or an interval that ends before it begins")
            }
            PlanFault::Contract => write!(f, "a contract stands in the program"),
            PlanFault::InTrack { joint, fault } => write!(f, "in the track of joint {joint}: {fault}"),
            PlanFault::InStage { stage, fault } => write!(f, "in stage `{stage}`: {fault}"),
            PlanFault::After { time, fault } => write!(f, "at {time} s {fault}"),
            PlanFault::Name { what, index, stated, name } => {
                write!(f, "`{stated}` stands as the name of {what} {index}, whose index stands for `{name}`")
            }
            PlanFault::Names { what } => {
                write!(f, "there are not as many names as indices, from a {what} on")
            }
            PlanFault::Dynamics { stated, judged } => {
                write!(f, "a world states the dynamics `{stated}`; such plans are judged under `{judged}`")
            }
            PlanFault::Library(fault) => fault.fmt(f),
            PlanFault::Pose { of, fault } => write!(f, "{of}: {fault}"),
            PlanFault::Bound { what, value, most } => {
                write!(f, "{what} is {value} in SI units; the limit is {most}")
            }
            PlanFault::Tracks(fault) => fault.fmt(f),
            PlanFault::Stages(fault) => fault.fmt(f),
            PlanFault::NodePaths(fault) => fault.fmt(f),
        }
    }
}

impl fmt::Display for TracksFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TracksFault::SharedName { name } => write!(f, "two modules or obstacles have the name `{name}`"),
            TracksFault::StartJoints { joints } => {
                write!(f, "the start pose must have {joints} joint positions")
            }
            TracksFault::StartBonds { bonds } => write!(f, "the start pose must have {bonds} bonds"),
            TracksFault::TrackOrder => write!(f, "tracks are not in order of joint"),
            TracksFault::ControlPoints { time, count } => {
                write!(f, "at {time} s a segment has {count} control points")
            }
            TracksFault::SegmentOrder { start, end } => {
                write!(f, "the segment of {start}..{end} s is out of order or beyond the end")
            }
            TracksFault::Jump { time } => write!(f, "the joint jumps at {time} s"),
            TracksFault::EventOrder { time } => write!(f, "docking at {time} s is out of order"),
            TracksFault::BondUnchanged { time, bond, holds } => {
                write!(
                    f,
                    "at {time} s bond {bond} {}",
                    if *holds { "holds already" } else { "does not hold" }
                )
            }
            TracksFault::FarJoint { limit } => write!(f, "a joint is moved beyond {limit} rad or m"),
            TracksFault::OneCluster { reference } => {
                write!(f, "`{reference}` stands for a cluster that is part of another")
            }
            TracksFault::Misalignment { bond } => {
                write!(f, "the misalignment of {bond} is that of no bond at the start, or out of order")
            }
            TracksFault::Obstacle { name, fault } => write!(f, "the obstacle `{name}`: {fault}"),
            TracksFault::NoCommands { joint } => write!(f, "{joint} takes no commands"),
            TracksFault::PortTaken { port } => write!(f, "{port} is taken twice"),
            TracksFault::NoMate { a, b } => write!(f, "{a} does not mate with {b}"),
        }
    }
}

impl std::error::Error for PlanFault {}
