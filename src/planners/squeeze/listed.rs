//! Motions whose cells are listed one by one. A stage of the result states moves in classes, or arithmetic runs of
//! cells where these are shorter.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use super::motion::{Builder, Motion, PlanLimits};
use crate::plan::lattice::{Cube, greatest_relative_displacement};
use crate::plan::{ArithmeticRun, CellMove, Moves, Ratio, arithmetic_runs};
use std::collections::BTreeMap;

/// A motion under construction, in which every cell has its own state. Of each stage the classes of changes are kept,
/// and the class of each cell.
pub(super) struct Listed {
    start: Vec<CellState>,
    last: Vec<CellState>,
    stages: Vec<Classified>,
}

/// A stage as classes of cells whose states change alike.
struct Classified {
    name: &'static str,
    classes: Vec<Change>,
    /// The index of the class of each cell.
    of_cell: Vec<u32>,
}

/// The change of a cell's centre and size over a stage, in quarters.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Change {
    displacement: [i64; 3],
    growth: [i64; 3],
}

impl Change {
    /// Returns the change from one state to another.
    fn between(before: &CellState, after: &CellState) -> Change {
        let difference = |to: [i64; 3], from: [i64; 3]| [0, 1, 2].map(|axis| to[axis] - from[axis]);
        Change {
            displacement: difference(after.center, before.center),
            growth: difference(after.size, before.size),
        }
    }

    /// Returns the state after the change.
    fn applied(&self, before: &CellState) -> CellState {
        let sum = |from: [i64; 3], by: [i64; 3]| [0, 1, 2].map(|axis| from[axis] + by[axis]);
        CellState { center: sum(before.center, self.displacement), size: sum(before.size, self.growth) }
    }
}

impl Listed {
    /// Returns the motion that begins at a configuration, the state of each cell by number, without stages so far.
    pub(super) fn new(start: Vec<CellState>) -> Listed {
        Listed { last: start.clone(), start, stages: vec![] }
    }

    /// Appends a stage of this name. `change` is called with the number and the last state of each cell, and changes it
    /// to the state at the end of the stage.
    pub(super) fn stage(&mut self, name: &'static str, mut change: impl FnMut(usize, &mut CellState)) {
        crate::interrupt::checkpoint();
        let mut numbers: BTreeMap<Change, u32> = BTreeMap::new();
        let mut stage = Classified { name, classes: vec![], of_cell: Vec::with_capacity(self.last.len()) };
        for (cell, state) in self.last.iter_mut().enumerate() {
            let before = *state;
            change(cell, state);
            let made = Change::between(&before, state);
            let class = *numbers.entry(made).or_insert(stage.classes.len() as u32);
            if class as usize == stage.classes.len() {
                stage.classes.push(made);
            }
            stage.of_cell.push(class);
        }
        self.stages.push(stage);
    }

    /// Returns the motion of these stages under these limits. Cell `i` of the lists gets the number `number[i]`, which
    /// must be a permutation of 0..count. Stages in which nothing moves are left out.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn into_motion(self, limits: PlanLimits, number: &[u64]) -> Result<Motion, Refusal> {
        let count = number.len() as u64;
        let mut last = self.start.clone();
        number.iter().zip(self.start).for_each(|(&to, state)| last[to as usize] = state);
        let first = last.clone();
        let mut builder = Builder::new(limits, count, &runs(&last, &last), move |i| first[i as usize])?;
        for stage in self.stages {
            let mut of_cell = vec![0; number.len()];
            number.iter().zip(&stage.of_cell).for_each(|(&to, &class)| of_cell[to as usize] = class);
            let state = |(class, before): (&u32, &CellState)| stage.classes[*class as usize].applied(before);
            let states: Vec<CellState> = of_cell.iter().zip(&last).map(state).collect();
            if states == last {
                continue;
            }
            let (before, after) = (cubes(&last), cubes(&states));
            let relative_displacement = greatest_relative_displacement(&before, &after, LINES, limits.slides)
                .ok_or(Refusal::TooLarge)?;
            let domains = runs(&last, &states);
            let moves = moves(&stage.classes, &of_cell, limits.anchored)?;
            let moves = (length(&moves) < domains.len() * RUN_LENGTH).then_some(moves);
            last.clone_from(&states);
            // The greatest relative displacement is in lines of the judge's grid.
            let place = move |i: u64| states[i as usize];
            builder.stage_by(stage.name, relative_displacement / 4, &domains, place, moves)?;
        }
        builder.state_last(&runs(&last, &last))?;
        Ok(builder.motion())
    }
}

/// The length of a run of cells in a plan file, in spans of moves.
const RUN_LENGTH: usize = 40;
/// The length of a class of moves in a plan file, in spans of moves.
const CLASS_LENGTH: usize = 20;

/// Returns the length of moves in a plan file, in spans.
fn length(moves: &Moves) -> usize {
    moves.cells.len() + moves.classes.len() * CLASS_LENGTH
}

/// Returns the moves of cells, by number, that change by these classes, about the centre of mass, which is held, if
/// they are not `anchored`.
fn moves(classes: &[Change], of_cell: &[u32], anchored: bool) -> Result<Moves, Refusal> {
    let count = of_cell.len() as i128;
    let mut drift = [0_i128; 3];
    for &class in of_cell.iter().filter(|_| !anchored) {
        let displacement = classes[class as usize].displacement;
        (0..3).for_each(|axis| drift[axis] += i128::from(displacement[axis]));
    }
    let ratio = |above: i128, below: i128| Ratio::new(above, below).ok_or(Refusal::TooLarge);
    let three = |f: &dyn Fn(usize) -> Result<Ratio, Refusal>| Ok([f(0)?, f(1)?, f(2)?]);
    let class = |change: &Change| {
        let about = |axis: usize| i128::from(change.displacement[axis]) * count - drift[axis];
        Ok(CellMove {
            displacement: three(&|axis| ratio(about(axis), i128::from(WHOLE) * count))?,
            growth: three(&|axis| ratio(change.growth[axis].into(), WHOLE.into()))?,
        })
    };
    let classes = classes.iter().map(class).collect::<Result<Vec<_>, Refusal>>()?;
    Ok(Moves::new(&classes, of_cell.iter().copied()))
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
