//! Behaviours: schedules, conflicts, gaits.

pub mod behaviors_of_designs;
pub mod conflicts;
pub mod faithful;
pub mod gaits;
mod runs;
pub mod schedule;
