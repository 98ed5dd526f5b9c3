//! The evaluator: typed tree to values, effects and plans.
//!
//! The parts of this room: `run` puts an evaluator on a thread of its own ([`evaluator_thread`]),
//! which walks expressions ([`eval`], `operators`, `call`, `statements`) to values ([`value`]).
//! Declarations become designs ([`crate::elaborate`]); behaviours become plans (`behavior`, [`planning`]),
//! and what is wrong with these goes back to the lines that caused it ([`causes`], [`verdicts`]). The
//! built-ins ([`crate::natives`]) are the only bridge between the front end (the language) and the back end
//! (robotics).

mod host;

pub mod evaluator_thread;
pub mod stop;
pub mod value;

pub mod eval;
pub mod frame;
pub mod interpreter;
mod memory_errors;
mod operators;

pub mod argument;
mod call;
pub mod capability;
pub mod native;
pub mod nesting;
mod statements;

pub mod design;
mod groups;
pub mod identity;
pub mod keyed;
pub mod module_map;
pub mod robot;
pub mod scene;
mod scene_design;
pub mod study;
pub mod study_columns;

pub mod cells;

mod behavior;
pub mod causes;
pub mod contracts;
pub mod fields;
mod goals;
mod joining;
mod judged;
pub mod plan_value;
pub mod planning;
pub mod record;
pub mod verdicts;

pub mod printed;
pub mod recalled;
pub mod routines;
mod run;
pub mod table;
mod table_text;

pub mod session;

pub use host::{Host, Judgement, Limits, Mode, Options, Outcome, SilentHost, TestResult, WriteError};
pub use memory_errors::memory_limit;
pub use run::{judge, run, with_interpreter};
