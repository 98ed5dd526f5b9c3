//! The family of lattices of expanding cubes: stages in closed form, in rational numbers.

mod arithmetic_runs;
mod configurations;
mod fault;
mod join;
mod json;
pub(super) mod motion;
mod moves;
pub(super) mod ratio;
mod reversal;
mod slice;
mod validation;

pub use arithmetic_runs::{ArithmeticRun, arithmetic_runs};
pub use fault::StagesFault;
pub(super) use join::joined;
pub(super) use json::StagesJson;
pub use motion::{Anchor, CellBox, CellLimits, Counter, Law, Model, Run, Stage, StageEnd, Stages};
pub use moves::{CellMove, CellSpan, Moves};
pub use ratio::Ratio;
