//! Motions whose cells are listed one by one; the result is compressed into arithmetic runs where it can be.

use super::Refusal;
use super::domain::{CellState, Domain};
use super::motion::{Builder, Motion, PlanLimits};
use crate::plan::lattice::{Cube, greatest_relative_displacement};
use crate::plan::{ArithmeticRun, arithmetic_runs};

/// A motion under construction whose configurations are lists of the states of all cells, by number.
pub(super) struct Listed {
    start: Vec<CellState>,
    stages: Vec<(&'static str, Vec<CellState>)>,
}

impl Listed {
    /// Returns the motion that begins at a configuration, the state of each cell by number, without stages so far.
    pub(super) fn new(start: Vec<CellState>) -> Listed {
        Listed { start, stages: vec![] }
    }

    /// Returns the last configuration: the state of each cell, by number.
    pub(super) fn last(&self) -> &[CellState] {
        self.stages.last().map_or(&self.start, |(_, states)| states)
    }

    /// Appends a stage of this name. `change` is called with the number and the last state of each cell, and changes it
    /// to the state at the end of the stage.
    pub(super) fn stage(&mut self, name: &'static str, mut change: impl FnMut(usize, &mut CellState)) {
        crate::interrupt::checkpoint();
        let mut states = self.last().to_vec();
        states.iter_mut().enumerate().for_each(|(i, state)| change(i, state));
        self.stages.push((name, states));
    }

    /// Returns the motion between the configurations in arithmetic runs of cells, under these limits. Cell `i` of the
    /// lists gets the number `number[i]`, which must be a permutation of 0..count. Stages in which nothing moves are
    /// left out.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn into_motion(self, limits: PlanLimits, number: &[u64]) -> Result<Motion, Refusal> {
        let renumbered = |states: Vec<CellState>| {
            let mut new = states.clone();
            number.iter().zip(states).for_each(|(&to, state)| new[to as usize] = state);
            new
        };
        let count = number.len() as u64;
        let start = renumbered(self.start);
        let first = start.clone();
        let mut last = start.clone();
        let mut builder = Builder::new(limits, count, &runs(&start, &start), move |i| first[i as usize])?;
        for (name, states) in self.stages {
            let states = renumbered(states);
            if states == last {
                continue;
            }
            let relative_displacement = greatest_relative_displacement(&cubes(&last), &cubes(&states), LINES)
                .ok_or(Refusal::TooLarge)?;
            let domains = runs(&last, &states);
            last.clone_from(&states);
            // The greatest relative displacement is in lines of the judge's grid.
            builder.stage(name, relative_displacement / 4, &domains, move |i| states[i as usize])?;
        }
        Ok(builder.motion())
    }
}

/// Lines of the grid to a cell: eighths hold half of three quarters.
const LINES: i64 = 8;

/// Returns the cells as cubes on the judge's grid of [`LINES`] lines to a cell.
fn cubes(states: &[CellState]) -> Vec<Cube> {
    let cube = |state: &CellState| Cube {
        lo: [0, 1, 2].map(|axis| 2 * state.center[axis] - state.size[axis]),
        hi: [0, 1, 2].map(|axis| 2 * state.center[axis] + state.size[axis]),
    };
    states.iter().map(cube).collect()
}

/// Returns domains of consecutive numbers on which both configurations are affine: runs, and runs of equal
/// runs.
fn runs(before: &[CellState], after: &[CellState]) -> Vec<Domain> {
    let step = |from: usize, to: usize| {
        let between = |states: &[CellState]| {
            let (a, b) = (states[from], states[to]);
            (a.size == b.size).then(|| [0, 1, 2].map(|axis| b.center[axis] - a.center[axis]))
        };
        Some((between(before)?, between(after)?))
    };
    let domain = |s: ArithmeticRun| {
        let counters = [(s.times as u64, s.length as i64), (s.length as u64, 1)];
        Domain::new(s.first as u64, &counters)
    };
    arithmetic_runs(before.len(), step).into_iter().filter_map(domain).collect()
}
