//! Arms: a row to a column, balanced, and faster than the accordion. The two halves of the row turn up
//! like the arms of a Λ, each other's mirror image, by the shear; then the two columns that they end as
//! merge to one, as in a fold.
//!
//! The middle stays: two cells, or one if the number is odd. The arms begin half a cell above it and so are
//! connected with it on both sides of the corner that they turn about.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use super::motion::{Builder, Motion, PlanLimits};

const HALF: i64 = WHOLE / 2;
const QUARTER: i64 = WHOLE / 4;

/// Returns the motion from a row of `count` cells along x, at least four, with cell `i` (from 0) at lattice site (i,
/// 0, 0), to a column along y. The order of the cells in the column differs from that in the row: levels from the
/// middle of the row outwards come one above the other, and of the two cells of a level the left and the right
/// alternate in being the upper one. Cells must be able to shrink to half their size. The stages: the arms slide up by
/// half a cell, turn by the shear, and the two columns that they end as are squeezed, swapped and expanded into one.
/// `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn arms(limits: PlanLimits, count: u64) -> Result<Motion, Refusal> {
    let arms = Arms { count };
    let domains = arms.domains();
    let mut builder = Builder::new(limits, count, &domains, |i| CellState::whole([i as i64, 0, 0]))?;
    builder.stage("y-slide", HALF, &domains, move |i| {
        arms.state(i, |k, x| ([x - WHOLE * k, HALF], [WHOLE; 2]))
    })?;
    builder.two_phase_stage(
        "arms",
        WHOLE,
        &domains,
        move |i| arms.state(i, |k, x| ([x - QUARTER - HALF * k, QUARTER + HALF * k], [HALF; 2])),
        move |i| arms.state(i, |k, x| ([x - HALF, WHOLE * k], [WHOLE; 2])),
    )?;
    builder.stage("x-squeeze", HALF, &domains, move |i| arms.squeezed(i))?;
    builder.stage("swap-contract", HALF, &domains, move |i| arms.contracted(i))?;
    builder.stage("swap-expand", HALF, &domains, move |i| {
        let mut state = arms.contracted(i);
        (state.center[0], state.size[0]) = (0, WHOLE);
        state
    })?;
    builder.stage("y-expand", HALF, &domains, move |i| {
        let mut state = CellState::whole([0, arms.place(i), 0]);
        state.center[0] = 0;
        state
    })?;
    Ok(builder.motion())
}

/// The arms of a row of `count` cells.
#[derive(Clone, Copy)]
struct Arms {
    count: u64,
}

/// A cell by its level and its side.
struct Part {
    /// The level from the middle outwards; 0 is the middle.
    level: i64,
    /// The side: -1 to the left, 1 to the right; 0 for a lone cell in the middle.
    side: i64,
}

impl Arms {
    fn is_odd(self) -> bool {
        self.count % 2 == 1
    }

    fn part(self, i: u64) -> Part {
        let from_left = i as i64;
        let from_right = self.count as i64 - 1 - from_left;
        let half = (self.count / 2) as i64;
        let outermost = if self.is_odd() { half } else { half - 1 };
        match from_left.cmp(&from_right) {
            std::cmp::Ordering::Less => Part { level: outermost - from_left, side: -1 },
            std::cmp::Ordering::Greater => Part { level: outermost - from_right, side: 1 },
            std::cmp::Ordering::Equal => Part { level: 0, side: 0 },
        }
    }

    /// Returns the state of a cell: the middle stays, and an arm's cell is at `place` of its level and the x at
    /// which the arm begins, mirrored on the right.
    fn state(self, i: u64, place: impl Fn(i64, i64) -> ([i64; 2], [i64; 2])) -> CellState {
        let Part { level, side } = self.part(i);
        let middle = if self.is_odd() { 0 } else { HALF };
        let ([x, y], [w, h]) = if level == 0 { ([-middle, 0], [WHOLE; 2]) } else { place(level, -middle) };
        CellState { center: [-side * x, y, HALF], size: [w, h, WHOLE] }
    }

    /// Returns the state in two columns of half the width; a lone cell in the middle stays whole.
    fn squeezed(self, i: u64) -> CellState {
        let Part { level, side } = self.part(i);
        let width = if side == 0 { WHOLE } else { HALF };
        CellState { center: [side * QUARTER, WHOLE * level, HALF], size: [width, WHOLE, WHOLE] }
    }

    /// Returns the state in which of every level one cell is up and the other down, in the next the reverse.
    fn contracted(self, i: u64) -> CellState {
        let Part { level, side } = self.part(i);
        let mut state = self.squeezed(i);
        if side != 0 {
            state.center[1] += if self.is_up(level, side) { QUARTER } else { -QUARTER };
            state.size[1] = HALF;
        }
        state
    }

    fn is_up(self, level: i64, side: i64) -> bool {
        (level % 2 == 0) == (side > 0)
    }

    /// Returns the index of a cell in the column.
    fn place(self, i: u64) -> i64 {
        let Part { level, side } = self.part(i);
        let lone = i64::from(self.is_odd());
        if side == 0 { 0 } else { 2 * level - lone + i64::from(self.is_up(level, side)) }
    }

    /// Returns domains on which all states are affine: the middle, and every second cell of each arm.
    fn domains(self) -> Vec<Domain> {
        let arm = (self.count - 1) / 2;
        let middle = arm..self.count - arm;
        let halves = |from: u64| {
            (0..2.min(arm)).filter_map(move |k| Domain::new(from + k, &[((arm - k).div_ceil(2), 2)]))
        };
        let middle = middle.filter_map(|i| Domain::new(i, &[]));
        halves(0).chain(middle).chain(halves(self.count - arm)).collect()
    }
}
