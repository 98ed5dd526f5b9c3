//! Configurations between stages, as runs; where stages state moves, these are added up, exactly.

use super::arithmetic_runs::{ArithmeticRun, arithmetic_runs};
use super::motion::{Run, Stage, StageEnd, Stages};
use super::moves::CellMove;
use super::ratio::Ratio;
use crate::plan::lattice::LatticeFault;
use crate::plan::lattice::grid::{Cube, Grid};

impl Stages {
    /// Returns true if some stage states moves, not positions.
    fn states_moves(&self) -> bool {
        self.stages.iter().any(Stage::states_moves)
    }

    /// Returns true if a plan file needs what version 3 added: moves, or an anchor.
    pub(in crate::plan) fn needs_version_3(&self) -> bool {
        self.anchor.is_some() || self.states_moves()
    }

    /// Returns all numbers of positions, moves and obstacles, in cell sizes.
    pub(in crate::plan) fn ratios(&self) -> impl Iterator<Item = Ratio> + '_ {
        self.ratios_at_start().chain(self.stages.iter().flat_map(Stage::ratios))
    }

    /// Returns all numbers of the positions at the start and of obstacles, in cell sizes.
    pub(in crate::plan) fn ratios_at_start(&self) -> impl Iterator<Item = Ratio> + '_ {
        let obstacles = self.anchor.iter().flat_map(|anchor| &anchor.obstacles);
        self.start.iter().chain(obstacles).flat_map(Run::ratios)
    }

    /// Returns runs that state the position of every cell before the stage of this index (from 0), or at the end if it
    /// is the number of stages; none if the index is larger.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`] or [`LatticeFault::CellsTooFar`] where moves add up to no exact positions.
    pub fn before(&self, stage: usize) -> Result<Vec<Run>, LatticeFault> {
        let mut found = Vec::new();
        self.for_configurations(|index| index == stage, |_, runs| found = runs)?;
        Ok(found)
    }

    /// Calls `call` with the index of every stage that is `wanted` and runs that state the position of every cell
    /// before it, in ascending order; the number of stages is the index of the end.
    ///
    /// Without moves these are the runs since the last configuration that named every cell, in order, so that if two
    /// name a cell the later holds. After moves the positions are those on the grid.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`] or [`LatticeFault::CellsTooFar`] where moves add up to no exact positions.
    pub(super) fn for_configurations(
        &self,
        wanted: impl Fn(usize) -> bool,
        mut call: impl FnMut(usize, Vec<Run>),
    ) -> Result<(), LatticeFault> {
        let mut exact = if self.states_moves() { Some(self.exact_start()?) } else { None };
        // The runs that the configuration consists of; none after moves.
        let mut named: Vec<&[Run]> = vec![&self.start];
        for index in 0..=self.stages.len() {
            if wanted(index) {
                let runs = match &exact {
                    Some((grid, cubes)) if named.is_empty() => {
                        gathered(cubes, *grid).ok_or(LatticeFault::CellsTooFar)?
                    }
                    _ => named.concat(),
                };
                call(index, runs);
            }
            let Some(stage) = self.stages.get(index) else { break };
            if let Some((grid, cubes)) = &mut exact {
                grid.refine(|| stage.ratios(), &mut [&mut *cubes])?;
                grid.advance(&stage.end, cubes)?;
            }
            match &stage.end {
                StageEnd::Runs(runs) if stage.count() >= self.count => named = vec![runs],
                // Runs of a few cells state no whole configuration after moves.
                StageEnd::Runs(runs) if !named.is_empty() => named.push(runs),
                StageEnd::Runs(_) | StageEnd::Moves(_) => named.clear(),
            }
        }
        Ok(())
    }

    /// Returns the grid on which the plan begins, and the cells at the start on it, by number.
    fn exact_start(&self) -> Result<(Grid, Vec<Cube>), LatticeFault> {
        let grid = Grid::at_start(self)?;
        let mut cubes = vec![Cube::default(); self.count as usize];
        grid.place(&self.start, &mut cubes)?;
        Ok((grid, cubes))
    }
}

impl Stage {
    /// Returns true if the stage states moves, not positions.
    pub(super) fn states_moves(&self) -> bool {
        matches!(self.end, StageEnd::Moves(_))
    }

    /// Returns all numbers of the positions or moves, in cell sizes.
    pub(in crate::plan) fn ratios(&self) -> impl Iterator<Item = Ratio> + '_ {
        let (runs, classes): (&[Run], &[CellMove]) = match &self.end {
            StageEnd::Runs(runs) => (runs, &[]),
            StageEnd::Moves(moves) => (&[], &moves.classes),
        };
        runs.iter().flat_map(Run::ratios).chain(classes.iter().flat_map(CellMove::ratios))
    }
}

/// Returns runs that state the positions and sizes of all cells; `None` if 64 bits do not hold a number.
pub(super) fn gathered(cubes: &[Cube], grid: Grid) -> Option<Vec<Run>> {
    let sizes = |i: usize| [0, 1, 2].map(|axis| cubes[i].size(axis));
    let apart = |i: usize, j: usize| [0, 1, 2].map(|axis| cubes[j].middle(axis) - cubes[i].middle(axis));
    let found = arithmetic_runs(cubes.len(), |i, j| (sizes(i) == sizes(j)).then(|| apart(i, j)));
    let lines = i128::from(grid.lines);
    let three = |values: [i64; 3], over: i128| {
        let [x, y, z] = values.map(|value| Ratio::new(value.into(), over));
        Some([x?, y?, z?])
    };
    let run = |s: ArithmeticRun| {
        let middle = [0, 1, 2].map(|axis| cubes[s.first].middle(axis));
        let first = (three(middle, 2 * lines)?, three(sizes(s.first), lines)?);
        s.of_cells(first, |i, j| three(apart(i, j), 2 * lines))
    };
    found.into_iter().map(run).collect()
}
