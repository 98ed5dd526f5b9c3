//! Typed tree to values, effects and plans.

pub mod host;

pub use host::{Host, Limits, Mode, Options, Outcome, TestResult, WriteError};
