//! Behaviours, series-parallel programs of actions, and how they become plans: when every joint
//! moves how, what contradicts itself, what asks for more than a joint can do; gaits.
#![allow(non_snake_case)]

pub mod joints;
pub mod law;
pub mod refusal;

mod command;
mod condition;
mod cyclic;
mod docking;
mod motion;
mod run;
pub mod schedule;

pub mod conflict;
pub mod faithful;
pub mod limits;

pub mod gait;
pub mod mirror;

pub use conflict::{Conflict, Conflicts, conflicts};
pub use faithful::unfaithful;
pub use limits::{Issue, IssueKind, Part, issues};
pub use refusal::{Reason, Refusal};
pub use schedule::{Problem, Scheduled, Settings, schedule};
