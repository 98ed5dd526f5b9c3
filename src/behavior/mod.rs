//! Behaviours: series-parallel action graphs (Definition IV.3 and Section V-B of the
//! compositional-design paper), and their scheduling, which makes plans of them.
//!
//! [`schedule`] runs a behaviour undisturbed and records the trajectory of every joint. Before that,
//! [`issues`] finds commands that ask for more than a joint can do, and [`conflicts`] those that command one joint
//! twice at one time (Definition IV.5), both without running anything. [`gait`] composes cyclic
//! behaviours, [`mirror`] reflects them, [`Execution`] carries them out step by step with sensors, and [`unfaithful`]
//! compares a plan's program with its motion.
#![allow(non_snake_case)]

mod joints;
pub mod law;
mod refusal;

mod command;
mod condition;
mod cyclic;
mod docking;
mod execution;
mod motion;
mod played;
mod run;
mod schedule;
mod tolerances;

mod conflict;
mod faithful;
mod limits;

pub mod gait;
pub mod mirror;

pub use condition::Sensors;
pub use conflict::{Conflict, Conflicts, PAIRS_MAX, conflicts};
pub use execution::{Ending, Execution};
pub use faithful::unfaithful;
pub use joints::Uncommandable;
pub use limits::{Issue, IssueKind, Part, issues};
pub use refusal::{Reason, Refusal};
pub use schedule::{ContractInterval, Problem, Scheduled, Settings, schedule};
