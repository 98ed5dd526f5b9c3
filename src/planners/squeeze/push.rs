//! `push`: reconfiguration in place, by the search of [`crate::planners::push`], as a motion.

use super::Refusal;
use super::domain::{CellState, WHOLE};
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use super::shape::Shape;
use crate::plan::Ratio;
use crate::planners::push::{Bounds, Placed, best};

/// The name of the stages.
const STAGE: &str = "push";

/// Returns a motion from one shape to another within `bounds` in which lines of cells are pushed; `None` if none is found
/// that takes less than `time_limit` (in units of time, for cells whose speed limit is 1). `numbers`: the number of the cell at
/// each position of the first shape.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn push(
    limits: PlanLimits,
    (from, to): (&Shape, &Shape),
    numbers: &[u64],
    (bounds, time_limit): (Bounds, f64),
) -> Result<Option<Motion>, Refusal> {
    let squeezes = limits.cell.smallest.order(Ratio(1, 2)).is_le();
    let Some(way) = best(&from.positions, &to.positions, (squeezes, bounds), time_limit) else {
        return Ok(None);
    };
    let state = |placed: Placed| CellState { center: placed.center, size: placed.size };
    let states = way.places(from.positions.len());
    let states: Vec<Vec<CellState>> =
        states.into_iter().map(|places| places.into_iter().map(state).collect()).collect();
    let (Some(start), Some(end)) = (states.first(), states.last()) else { return Ok(None) };
    // A way backwards numbers its cells by the goal; where they end says which they are.
    let first = if way.backwards { end } else { start };
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
    Ok(Some(if way.backwards { motion.reversed() } else { motion }))
}
