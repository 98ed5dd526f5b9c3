//! `tunnel`: reconfiguration of blocks of cells that do not slide, by the search of [`crate::planners::tunnel`], as a
//! motion.

use super::anchor::AnchorFault;
use super::domain::CellState;
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use super::shape::Shape;
use super::{Problem, Refusal};
use crate::planners::tunnel::{Blocks, CellBox, blocks_of, way};

/// The name of the stages.
const STAGE: &str = "tunnel";

/// The greatest number of cells of a shape for which the method is tried: each block takes some stages, in each of which
/// all cells move a little.
pub(super) const TUNNEL_MAX: usize = 2048;

/// Checks that both shapes of a problem consist of blocks of 2 × 2 × 2 cells, few enough, which with fixed cells stand on
/// one lattice.
///
/// # Errors
/// [`Refusal::Blocks`], [`Refusal::TooMany`], or [`Refusal::Anchor`] for blocks of the goal that stand beside those of the
/// start.
pub(super) fn check(problem: &Problem) -> Result<(), Refusal> {
    if problem.start.len() > TUNNEL_MAX {
        return Err(Refusal::TooMany { most: TUNNEL_MAX });
    }
    let [from, to] = [(&problem.start, true), (&problem.goal, false)]
        .map(|(cells, first)| blocks_of(cells).map_err(|site| Refusal::Blocks { first, site }));
    let (from, to) = (from?, to?);
    let beside = (0..3).find(|&axis| (to.origin[axis] - from.origin[axis]) % 2 != 0);
    match beside {
        Some(axis) if !problem.fixed.is_empty() => Err(Refusal::Anchor(AnchorFault::Beside { axis })),
        _ => Ok(()),
    }
}

/// Returns a motion from one shape to another in which blocks tunnel, while the cells at the sites `fixed` stay; `None` if
/// none is found. The shapes must consist of blocks.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn tunnel(
    limits: PlanLimits,
    (from, to): (&Shape, &Shape),
    fixed: &[[i64; 3]],
) -> Result<Option<Motion>, Refusal> {
    let blocks = |shape: &Shape| -> Option<Blocks> { blocks_of(&shape.positions).ok() };
    let (Some(start), Some(goal)) = (blocks(from), blocks(to)) else { return Ok(None) };
    let Some(way) = way(&from.positions, (&start, &goal), fixed) else { return Ok(None) };
    let state = |cell: &CellBox| CellState { center: cell.center, size: cell.size };
    let mut states: Vec<CellState> = way.start.iter().map(state).collect();
    let mut motion = Listed::new(states.clone());
    for stage in &way.stages {
        stage.iter().for_each(|(cell, to)| states[*cell] = state(to));
        motion.stage(STAGE, |cell, at| *at = states[cell]);
    }
    motion.into_motion(limits, &(0..from.count()).collect::<Vec<u64>>()).map(Some)
}
