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
use super::domain::{CellState, WHOLE};
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use super::shape::Shape;
use crate::plan::Ratio;
use runs::Best;

/// The name of the stages.
const STAGE: &str = "push";

/// Returns a motion from one shape to another in which lines of cells are pushed; `None` if none is found that takes
/// less than `time_limit` (in units of time, for cells whose speed limit is 1). `numbers`: the number of the cell at
/// each position of the first shape.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn push(
    limits: PlanLimits,
    (from, to): (&Shape, &Shape),
    numbers: &[u64],
    time_limit: f64,
) -> Result<Option<Motion>, Refusal> {
    let squeezes = limits.cell.smallest.order(Ratio(1, 2)).is_le();
    let Some(Best { grid, found, backwards }) = runs::best(from, to, squeezes, time_limit) else {
        return Ok(None);
    };
    let count = from.positions.len();
    let states: Vec<Vec<CellState>> = found.states.iter().map(|state| state.states(&grid, count)).collect();
    let (Some(start), Some(end)) = (states.first(), states.last()) else { return Ok(None) };
    // A way backwards numbers its cells by the goal; where they end says which they are.
    let first = if backwards { end } else { start };
    let site = |state: &CellState| state.center.map(|x| x.div_euclid(WHOLE));
    let number = |state: &CellState| from.positions.binary_search(&site(state)).ok().map(|at| numbers[at]);
    let Some(numbers) = first.iter().map(number).collect::<Option<Vec<u64>>>() else {
        return Err(Refusal::Defect("a push does not begin at its start".into()));
    };
    let mut motion = Listed::new(start.clone());
    for state in &states[1..] {
        motion.stage(STAGE, |cell, at| *at = state[cell]);
    }
    let motion = motion.into_motion(limits, &numbers)?;
    Ok(Some(if backwards { motion.reversed() } else { motion }))
}
