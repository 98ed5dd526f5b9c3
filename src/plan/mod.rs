//! Plans, and the one judge of plans.
//!
//! A [`Plan`] stands alone: the library it uses, its start, its body, its program, its events and causes, and the
//! world it is judged under. The [`Body`] is of one of three families, each in a folder with its validation and its
//! operations: [`Tracks`], the joint trajectories of articulated robots, [`Stages`] of lattices, [`NodePaths`] of
//! trusses. Plans are [`reversed`], [`sliced`] and [`joined`] exactly; [`file`](mod@file) writes and reads them. The
//! judge, [`verify`](mod@verify), knows no planner.

pub mod polynomial;
pub mod time;

mod cause;
mod goal;
mod program;
mod provenance;
mod slope;
mod verdict;
pub mod visit;
mod world;

pub mod lattice;
mod node_paths;
mod stages;
mod tracks;

mod body;
mod motion_plan;

mod exceptions;
pub mod facts;
mod fault;
mod listing;
mod operation_error;
mod operations;
mod stated;
mod stated_path;
mod tolerances;
pub mod validation;

pub mod file;
pub(crate) mod forward_dynamics;
pub mod verify;

pub use body::{Body, Snapshot};
pub use cause::{Cause, CauseId};
pub use exceptions::{headline, headline_under, judged_under};
pub use fault::{PlanFault, TracksFault};
pub use goal::{Goal, GoalFrame, GoalKind, LineEnd};
pub(crate) use listing::listed;
pub use motion_plan::Plan;
pub use node_paths::{
    Interpolation, Keyframe, LengthSum, Margins, NodePaths, NodePathsFault, Progress, Ramps, Surroundings,
    TOPOLOGY_EVENTS_MAX, Topology, TopologyChange, TopologyEvent, TrussLimits,
};
pub use operation_error::OperationError;
pub use operations::{joined, retimed, reversed, sliced};
pub use program::{Action, Command, Compare, Condition, Node, Otherwise, Profile, Program, Signal, Target};
pub use provenance::{Change, ObjectiveValue, Provenance};
pub use slope::SLOPE_RISE_MAX;
pub use stages::{
    Anchor, ArithmeticRun, CellBox, CellLimits, CellMove, CellSpan, Counter, Law, Model, Moves, Ratio, Run,
    Stage, StageEnd, Stages, StagesFault, arithmetic_runs,
};
pub use stated_path::StatedPath;
pub use tolerances::{TOLERANCES, Tolerances};
pub use tracks::{
    DockingEvent, DockingKind, LastingTrees, Obstacle, Remap, Segment, Track, Tracks, timeline,
};
pub use validation::Unwritable;
pub use verdict::{
    Check, CheckKind, Dynamics, Failure, Measure, RobotVerdict, Status, Verdict, WORST_VALUES, Worst,
    WorstKind,
};
pub use world::{
    DynamicsModel, Exemption, ExemptionKind, Ground, Settings, Stability, World, WorldFrom, is_full,
};
