//! The family of lattices of expanding cubes: stages in closed form, in rational numbers.

mod arithmetic_runs;
mod join;
mod json;
pub(super) mod motion;
pub(super) mod ratio;
mod reversal;
mod slice;
mod validation;

pub use arithmetic_runs::{ArithmeticRun, arithmetic_runs};
pub(super) use join::joined;
pub(super) use json::StagesJson;
pub use motion::{CellBox, CellLimits, Counter, Law, Model, Run, Stage, Stages};
pub use ratio::Ratio;
