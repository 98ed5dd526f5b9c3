//! Sheets that fold along all their creases at once, without a cut: the creases round a vertex close a loop, so their
//! angles have to go together. A flat sheet comes to a folded form along a way on which every loop stays closed, by
//! continuation from the folded form back to the flat sheet.
//!
//! The entry is [`plan()`]. [`loops`] states the equations of the loops round the vertices, [`path`] follows their
//! solutions, [`timing`] makes a motion of that which no hinge is too slow
//! for. [`folded`] is the way in for crease patterns: a flat sheet with stated angles; [`assigned`] finds such angles where a
//! pattern states no more than mountains and valleys.

mod assigned;
mod effort;
pub mod loops;
pub mod path;
mod plan;
mod stated;
pub mod timing;
mod tolerances;

pub use assigned::{Unassigned, assigned};
pub use effort::SheetEffort;
pub use loops::{Loops, NoSheet};
pub use path::Stuck;
pub(crate) use plan::assembly;
pub use plan::{Problem, Refusal, Report, Settings, SheetWorld, plan};
pub use stated::{Unclosed, folded};
