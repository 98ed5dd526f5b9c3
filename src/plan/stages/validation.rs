//! The validation of stages: references and ranges, in whole numbers.

use super::fault::StagesFault;
use super::motion::{Anchor, Law, Run, StageEnd, Stages};
use super::moves::{CellMove, Moves};
use super::ratio::Ratio;
use crate::plan::fault::{PlanFault, need, need_index};
use crate::robot::Library;

/// The greatest number of cells of a lattice.
const CELLS_MAX: u64 = 4_000_000;
/// The greatest denominator of a ramp: products of two of them fit into 128 bits.
const RAMP_DENOMINATOR_MAX: i64 = 1 << 60;

impl Stages {
    /// Checks that the stages are well formed: that the cell type exists and there are not too many cells, that the
    /// start names them all, that every run names cells there are, that moves are of every cell and lead to exact
    /// positions, that an anchor has cells, that every ratio is a number, and that unit of time, limits, durations and ramps are in their
    /// ranges. `library`: that of the plan; `causes`: the number of causes of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(in crate::plan) fn validate(&self, library: &Library, causes: usize) -> Result<(), PlanFault> {
        need_index(self.cell, library.cells.len(), "cell type")?;
        need(self.count <= CELLS_MAX, || StagesFault::CellCount { most: CELLS_MAX })?;
        need(self.time_unit > 0.0, || StagesFault::TimeUnit)?;
        self.limits()?;
        let named = self.start.iter().map(|run| size_of(run).unwrap_or(0)).fold(0, u64::saturating_add);
        need(named >= self.count, || StagesFault::Start)?;
        self.start.iter().try_for_each(|run| self::run(run, self.count))?;
        if let Some(anchor) = &self.anchor {
            self.anchor(anchor)?;
        }
        for stage in &self.stages {
            need_index(stage.cause.0 as usize, causes, "cause")?;
            ratio(stage.time_squared)?;
            let name = || stage.name.clone();
            need(stage.time_squared.0 >= 0, || StagesFault::StageDuration { stage: name() })?;
            law(stage.law).map_err(|fault| PlanFault::InStage { stage: name(), fault: Box::new(fault) })?;
            match &stage.end {
                StageEnd::Runs(runs) => runs.iter().try_for_each(|run| self::run(run, self.count))?,
                StageEnd::Moves(moves) => self::moves(moves, self.count, &stage.name)?,
            }
        }
        // Whoever comes after may add up moves without asking.
        Ok(self.for_configurations(|_| false, |_, _| {}).map_err(StagesFault::Inexact)?)
    }

    fn anchor(&self, anchor: &Anchor) -> Result<(), PlanFault> {
        let ascending = anchor.cells.windows(2).all(|pair| pair[0] < pair[1]);
        let there = anchor.cells.last().is_some_and(|&last| last < self.count);
        need(ascending && there, || StagesFault::AnchorCells)?;
        need(!self.model.balanced, || StagesFault::AnchorBalance)?;
        let count = anchor.obstacles.iter().map(|run| size_of(run).unwrap_or(0)).fold(0, u64::saturating_add);
        need(count <= CELLS_MAX, || StagesFault::CellCount { most: CELLS_MAX })?;
        anchor.obstacles.iter().try_for_each(|run| self::run(run, count))?;
        let positive = anchor.obstacles.iter().all(|run| run.size.iter().all(|side| side.0 > 0));
        need(positive, || StagesFault::ObstacleSize)
    }

    fn limits(&self) -> Result<(), PlanFault> {
        let limits = &self.limits;
        ratio(limits.smallest)?;
        ratio(limits.speed_squared)?;
        let in_range =
            limits.smallest.0 > 0 && limits.smallest.order(Ratio::ONE).is_le() && limits.speed_squared.0 > 0;
        need(in_range, || StagesFault::CellLimits)?;
        if let Some(force) = self.model.contact_force {
            ratio(force)?;
            need(force.0 > 0, || StagesFault::ContactForce)?;
        }
        Ok(())
    }
}

fn law(law: Law) -> Result<(), PlanFault> {
    let (part, most) = match law {
        Law::BangBang => return Ok(()),
        Law::Trapezoid(part) => (part, Ratio(1, 2)),
        Law::SpeedUp(part) | Law::SlowDown(part) => (part, Ratio::ONE),
    };
    ratio(part)?;
    need(part.1 < RAMP_DENOMINATOR_MAX, || StagesFault::RampTooFine)?;
    need(part.0 > 0 && part.order(most).is_le(), || StagesFault::RampPart)
}

/// Returns the number of cells of a run; `None` where 64 bits do not hold it.
fn size_of(run: &Run) -> Option<u64> {
    run.counters.iter().try_fold(1_u64, |size, c| size.checked_mul(c.count))
}

fn run(run: &Run, count: u64) -> Result<(), PlanFault> {
    let size = size_of(run);
    need(size.is_some_and(|n| (1..=count).contains(&n)), || StagesFault::RunSize)?;
    let counters = &run.counters;
    counters.iter().flat_map(|c| c.step).chain(run.center).chain(run.size).try_for_each(ratio)?;
    // The lowest and the highest cell, in numbers too wide to overflow.
    let ends = counters.iter().map(|c| i128::from(c.stride) * (i128::from(c.count) - 1));
    let (low, high) = ends.fold((0, 0), |(low, high), end| (low + end.min(0), high + end.max(0)));
    let (low, high) = (i128::from(run.first) + low, i128::from(run.first) + high);
    let inside = low >= 0 && high < i128::from(count);
    need(inside, || StagesFault::RunCells { low, high, count })
}

/// Checks moves of a lattice of `count` cells in the stage of this name.
fn moves(moves: &Moves, count: u64, stage: &str) -> Result<(), PlanFault> {
    moves.classes.iter().flat_map(CellMove::ratios).try_for_each(ratio)?;
    let classes = moves.classes.len();
    let unfit = moves.cells.iter().find(|span| span.count == 0 || span.class as usize >= classes);
    if let Some(span) = unfit {
        return Err(StagesFault::MoveSpan { stage: stage.to_owned(), class: span.class, classes }.into());
    }
    let stated = moves.count();
    need(stated == count, || StagesFault::MoveCells { stage: stage.to_owned(), stated, count })
}

fn ratio(ratio: Ratio) -> Result<(), PlanFault> {
    need(ratio.1 > 0, || StagesFault::Ratio { numerator: ratio.0, denominator: ratio.1 })
}
