//! Any connected set in a plane to a row, with the third axis to work in: `docs/planners/squeeze.md`.
//!
//! Rows merge two by two: all is squeezed along y, pairs of rows swap into stacks, and the stacks rise
//! along z. Once one row of stacks is left, every column of it becomes a hairpin of two columns of half the
//! width, the hairpins unfold to a zigzag, and that slides down to the row.

use super::Refusal;
use super::domain::{CellState, WHOLE};
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use std::collections::BTreeMap;

const HALF: i64 = WHOLE / 2;
const QUARTER: i64 = WHOLE / 4;
const DETACHED: i64 = 3 * WHOLE / 4;
const X: usize = 0;
const Y: usize = 1;
const Z: usize = 2;

/// Returns the motion from a connected set of cells at these lattice sites (x, y), all different and at least one, to a
/// row along x, in which the cell at site `i` (from 0) has the number `name(i)`, which must be a permutation. Cells
/// must be able to shrink to half their size; they move along z, too. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn to_row(
    limits: PlanLimits,
    positions: &[[i64; 2]],
    name: impl Fn(u64) -> u64,
) -> Result<Motion, Refusal> {
    let low = |axis: usize| positions.iter().map(|p| p[axis]).min().unwrap_or(0);
    let (left, bottom) = (low(X), low(Y));
    let positions: Vec<[i64; 2]> = positions.iter().map(|p| [p[0] - left, p[1] - bottom]).collect();
    let start = positions.iter().map(|p| CellState::whole([p[X], p[Y], 0])).collect();
    let mut motion = Listed::new(start);
    let stacks = merge(&mut motion, &positions);
    let number: Vec<u64> = unfold(&mut motion, &stacks, positions.len()).into_iter().map(name).collect();
    motion.into_motion(limits, &number)
}

/// The cells of each stack, lowest first, by column and row.
type Stacks = BTreeMap<(i64, i64), Vec<usize>>;

/// The role of a cell while two rows of stacks merge.
#[derive(Clone, Copy)]
struct Merging {
    level: i64,
    /// True if the other row has a cell at the same column and level.
    paired: bool,
    /// True if it goes to the lower half of a pair.
    below: bool,
    /// The row of its box.
    row: i64,
    /// Its level in the end.
    place: i64,
}

/// Appends the stages that merge all rows into one row of stacks (log₂ of the number of rows rounds).
fn merge(motion: &mut Listed, positions: &[[i64; 2]]) -> Stacks {
    let mut stacks = Stacks::new();
    for (cell, p) in positions.iter().enumerate() {
        stacks.entry((p[X], p[Y])).or_default().push(cell);
    }
    let mut rows = positions.iter().map(|p| p[Y] + 1).max().unwrap_or(1);
    while rows > 1 {
        let (merging, merged) = paired(&stacks, positions.len());
        let m = |i: usize| merging[i];
        // All rows are squeezed; cells without a partner widen again.
        motion.stage("y-squeeze", |_, state| {
            state.center[Y] /= 2;
            state.size[Y] = HALF;
        });
        let widen = |i: usize, state: &mut CellState| {
            state.center[Y] = WHOLE * m(i).row + HALF;
            state.size[Y] = WHOLE;
        };
        motion.stage("widen singles", |i, state| {
            if !m(i).paired {
                widen(i, state);
            }
        });
        // Pairs swap into stacks of two halves, every second level at a time.
        for parity in [1, 0] {
            let swaps = |i: usize| m(i).paired && m(i).level % 2 == parity;
            motion.stage("swap z-contract", |i, state| {
                if swaps(i) {
                    state.center[Z] += if m(i).below { -QUARTER } else { QUARTER };
                    state.size[Z] = HALF;
                }
            });
            motion.stage("swap widen", |i, state| {
                if swaps(i) {
                    widen(i, state);
                }
            });
        }
        // Stacks of other heights rise at other speeds: nothing above the base may rub.
        motion.stage("detach", |i, state| {
            if m(i).place > 0 {
                state.size[X] = DETACHED;
                state.size[Y] = DETACHED;
            }
        });
        motion.stage("z-expand", |i, state| {
            state.center[Z] = WHOLE * m(i).place + HALF;
            state.size[Z] = WHOLE;
        });
        motion.stage("reattach", |_, state| (state.size[X], state.size[Y]) = (WHOLE, WHOLE));
        stacks = merged;
        rows = (rows + 1) / 2;
    }
    stacks
}

/// Returns the role of each cell where rows merge two by two, and the merged stacks.
fn paired(stacks: &Stacks, count: usize) -> (Vec<Merging>, Stacks) {
    let nothing = Merging { level: 0, paired: false, below: false, row: 0, place: 0 };
    let mut merging = vec![nothing; count];
    let mut merged = Stacks::new();
    let boxes: std::collections::BTreeSet<(i64, i64)> =
        stacks.keys().map(|&(x, row)| (x, row.div_euclid(2))).collect();
    let none = Vec::new();
    for (x, row) in boxes {
        let halves = [0, 1].map(|half| stacks.get(&(x, 2 * row + half)).unwrap_or(&none));
        let common = halves[0].len().min(halves[1].len());
        let stack: &mut Vec<usize> = merged.entry((x, row)).or_default();
        for level in 0..halves[0].len().max(halves[1].len()) {
            // In even boxes the cell of the lower row goes below: so neighbouring bases keep a face.
            let order = if row % 2 == 0 { [0, 1] } else { [1, 0] };
            for half in order {
                let Some(&cell) = halves[half].get(level) else { continue };
                merging[cell] = Merging {
                    level: level as i64,
                    paired: level < common,
                    below: half == order[0],
                    row,
                    place: stack.len() as i64,
                };
                stack.push(cell);
            }
        }
    }
    (merging, merged)
}

/// Appends the stages from one row of stacks to a row along x; returns the number of each cell in it.
fn unfold(motion: &mut Listed, stacks: &Stacks, count: usize) -> Vec<u64> {
    /// A cell's part in the hairpin of its column.
    #[derive(Clone, Copy, Default)]
    struct Pin {
        /// The index of the box of two levels that it is in.
        level: i64,
        /// True for the last cell of an odd column, which stays whole.
        alone: bool,
        /// True if it goes to the left half.
        left: bool,
    }
    let mut pins = vec![Pin::default(); count];
    let mut number = vec![0_u64; count];
    let mut next = 0;
    // Every column becomes a hairpin of two columns of half the width.
    if stacks.values().any(|stack| stack.len() > 1) {
        for (&(column, _), stack) in stacks {
            for (level, pair) in stack.chunks(2).enumerate() {
                for (half, &cell) in pair.iter().enumerate() {
                    let left = (half == 0) == (column % 2 == 0);
                    pins[cell] = Pin { level: level as i64, alone: pair.len() == 1, left };
                }
            }
        }
        let p = |i: usize| pins[i];
        motion.stage("z-squeeze", |_, state| {
            state.center[Z] /= 2;
            state.size[Z] = HALF;
        });
        let heighten = |i: usize, state: &mut CellState| {
            state.center[Z] = WHOLE * p(i).level + HALF;
            state.size[Z] = WHOLE;
        };
        motion.stage("restore odd tops", |i, state| {
            if p(i).alone {
                heighten(i, state);
            }
        });
        for parity in [0, 1] {
            let opens = |i: usize| !p(i).alone && p(i).level % 2 == parity;
            motion.stage("hairpin narrow", |i, state| {
                if opens(i) {
                    state.center[X] += if p(i).left { -QUARTER } else { QUARTER };
                    state.size[X] = HALF;
                }
            });
            motion.stage("hairpin heighten", |i, state| {
                if opens(i) {
                    heighten(i, state);
                }
            });
        }
    }
    // Cells are numbered up the left of each column and down its right.
    for stack in stacks.values() {
        let mut chain: Vec<usize> =
            stack.iter().copied().filter(|&cell| pins[cell].left || pins[cell].alone).collect();
        let mut down: Vec<usize> =
            stack.iter().copied().filter(|&cell| !(pins[cell].left || pins[cell].alone)).collect();
        if stack.len() == 1 {
            (chain, down) = (stack.clone(), vec![]);
        }
        down.reverse();
        for cell in chain.into_iter().chain(down) {
            number[cell] = next;
            next += 1;
        }
    }
    // The hairpins unfold to a zigzag, which slides down to the row.
    motion.stage("x-unfold", |i, state| {
        state.center[X] = WHOLE * number[i] as i64 + HALF;
        state.size[X] = WHOLE;
    });
    motion.stage("z-slide", |_, state| state.center[Z] = HALF);
    number
}
