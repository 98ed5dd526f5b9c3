//! Accordion: a row to a column in four stages, with cells that keep their size. The row folds up to an
//! array like an accordion, and the array unrolls, row after row.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use super::motion::{Builder, Motion, PlanLimits};

/// Returns the motion from a row of `count` cells along x, at least one, with cell `i` (from 0) at lattice site (i, 0,
/// 0), to a column of them along y, in which the row folds up and unrolls like an accordion; all cells keep their full
/// size. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn accordion(limits: PlanLimits, count: u64) -> Result<Motion, Refusal> {
    of_height(limits, count, rounded_root(count).max(1))
}

/// Returns the motion of [`accordion`], folded into the squarest array whose numbers of rows and columns are both even:
/// mirror symmetry keeps its angular momentum at zero. `None` if `count` has no such factors; [`Refusal::TooLarge`]
/// inside if a number does not fit 64 bits.
pub(super) fn balanced_accordion(limits: PlanLimits, count: u64) -> Option<Result<Motion, Refusal>> {
    let root = rounded_root(count);
    let even = |height: u64| count.is_multiple_of(height) && (count / height).is_multiple_of(2);
    let height = (1..=root / 2).rev().map(|half| 2 * half).find(|&height| even(height))?;
    Some(of_height(limits, count, height))
}

/// Returns the motion through an array of this height.
fn of_height(limits: PlanLimits, count: u64, height: u64) -> Result<Motion, Refusal> {
    let array = Array::new(count, height);
    let row = |i: u64| CellState::whole([i as i64, 0, 0]);
    let columns = array.columns_in_turn();
    let mut builder = Builder::new(limits, count, &columns, row)?;
    builder.stage("y-slide", WHOLE, &columns, move |i| CellState::whole([i as i64, array.level(i), 0]))?;
    builder.stage("x-collapse", WHOLE, &columns, move |i| {
        CellState::whole([array.column(i), array.level(i), 0])
    })?;
    let rows = array.rows_in_turn();
    builder
        .stage("y-unfold", WHOLE, &rows, move |i| CellState::whole([array.column(i), array.index(i), 0]))?;
    builder.stage("x-slide", WHOLE, &rows, move |i| CellState::whole([0, array.index(i), 0]))?;
    Ok(builder.motion())
}

/// Returns for each of `count` cells, in their order, its index in the column (from 0, upwards) at the end of
/// [`accordion`].
pub(super) fn places_in_column(count: u64) -> Vec<u64> {
    let array = Array::new(count, rounded_root(count).max(1));
    (0..count).map(|i| array.index(i) as u64).collect()
}

/// Returns the square root, rounded.
fn rounded_root(count: u64) -> u64 {
    libm::round(libm::sqrt(count as f64)) as u64
}

/// Columns that go up and down in turn; the last one may be short.
#[derive(Clone, Copy)]
struct Array {
    count: u64,
    height: u64,
    /// The rows from this on are of another length than those before; the height if there are none.
    change: u64,
    /// Lengths of the rows before the change and from it on.
    lengths: [u64; 2],
}

impl Array {
    fn new(count: u64, height: u64) -> Array {
        let width = count.div_ceil(height);
        let last = count - (width - 1) * height;
        let (change, lengths) = match (last == height, (width - 1).is_multiple_of(2)) {
            (true, _) => (height, [width, width]),
            // The last column begins at the bottom, or at the top.
            (false, true) => (last, [width, width - 1]),
            (false, false) => (height - last, [width - 1, width]),
        };
        Array { count, height, change, lengths }
    }

    fn column(self, i: u64) -> i64 {
        (i / self.height) as i64
    }

    fn level(self, i: u64) -> i64 {
        let (column, k) = (i / self.height, i % self.height);
        (if column.is_multiple_of(2) { k } else { self.height - 1 - k }) as i64
    }

    /// Returns the index of a cell in the boustrophedon order over all rows. It turns at the left where the
    /// row lengths change, because all rows begin there.
    fn index(self, i: u64) -> i64 {
        let (x, y) = (self.column(i) as u64, self.level(i) as u64);
        let (before, from) = (self.change * self.lengths[0], y.saturating_sub(self.change));
        let start = if y < self.change { y * self.lengths[0] } else { before + from * self.lengths[1] };
        let length = self.lengths[usize::from(y >= self.change)];
        // The row before the change goes left; without a change the first row goes right.
        let first = if self.change < self.height { self.change } else { 0 };
        let right = (first + y).is_multiple_of(2);
        (start + if right { x } else { length - 1 - x }) as i64
    }

    /// Returns domains on which column and level are affine.
    fn columns_in_turn(self) -> Vec<Domain> {
        let full = self.count / self.height;
        let step = 2 * self.height as i64;
        let rest = Domain::new(full * self.height, &[(self.count % self.height, 1)]);
        [
            Domain::new(0, &[(full.div_ceil(2), step), (self.height, 1)]),
            Domain::new(self.height, &[(full / 2, step), (self.height, 1)]),
            rest,
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Returns domains on which the index is affine as well.
    fn rows_in_turn(self) -> Vec<Domain> {
        let mut domains = Vec::new();
        let regions = [(0, self.change, self.lengths[0]), (self.change, self.height, self.lengths[1])];
        for (from, to, length) in regions {
            for first in [from, from + 1].into_iter().filter(|first| *first < to) {
                let rows = (to - first).div_ceil(2);
                for column in [0, 1].into_iter().filter(|column| *column < length) {
                    let columns = (length - column).div_ceil(2);
                    let (cell, down) = match column {
                        0 => (first, 2),
                        _ => (self.height + self.height - 1 - first, -2),
                    };
                    domains.extend(Domain::new(cell, &[(columns, 2 * self.height as i64), (rows, down)]));
                }
            }
        }
        domains
    }
}
