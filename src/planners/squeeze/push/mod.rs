//! `push`: reconfiguration in place. The goal is laid over the start so that most cells stay, and those that are too
//! many go to the sites that are missing: lines of cells move on by one cell, which takes 2 units of time whatever
//! their length. A hole so wanders through the robot as a rook does on a chessboard; where it would cut the robot in
//! two, a cell squeezes in beside another instead, and on from there, so that every site stays full.
//!
//! Line moves are those of Almethen, Michail and Potapov ("Pushing lines helps: Efficient universal centralised
//! transformations for programmable matter", Theoretical Computer Science 830, 2020); here whole sets of lines move at
//! once. The way that is best of many runs with other choices is taken.

mod boxes;
mod grid;
mod routes;
mod runs;
mod search;
mod stage;

use super::Refusal;
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use super::shape::Shape;
use crate::plan::Ratio;
use runs::Best;

/// The name of the stages.
const STAGE: &str = "push";

/// Returns a motion from one shape to another in which lines of cells are pushed; `None` if none is found that takes
/// less than `time_limit` (in units of time, for cells whose speed limit is 1).
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn push(
    limits: PlanLimits,
    from: &Shape,
    to: &Shape,
    time_limit: f64,
) -> Result<Option<Motion>, Refusal> {
    let squeezes = limits.cell.smallest.order(Ratio(1, 2)).is_le();
    let Some(Best { grid, found }) = runs::best(from, to, squeezes, time_limit) else { return Ok(None) };
    let count = from.positions.len();
    let mut states = found.states.iter().map(|state| state.states(&grid, count));
    let Some(start) = states.next() else { return Ok(None) };
    let mut motion = Listed::new(start);
    for state in states {
        motion.stage(STAGE, |cell, at| *at = state[cell]);
    }
    motion.into_motion(limits, &(0..from.count()).collect::<Vec<u64>>()).map(Some)
}
