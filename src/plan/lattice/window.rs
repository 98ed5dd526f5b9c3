//! Intervals of the path parameter of a stage, which goes from 0 to 1, with exact fractions as ends.

use super::grid::Cube;
use std::cmp::Ordering;

/// A fraction: numerator and positive denominator, not reduced.
pub(super) type Fraction = (i128, i128);

/// Compares two fractions exactly.
pub(super) fn order(a: Fraction, b: Fraction) -> Ordering {
    (a.0 * b.1).cmp(&(b.0 * a.1))
}

/// An open interval of the path parameter of a stage, which goes from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The lower end of the interval, not below 0.
    pub from: Fraction,
    /// The upper end of the interval, not above 1.
    pub to: Fraction,
}

impl Window {
    /// The interval of the whole stage, from 0 to 1.
    pub const WHOLE: Window = Window { from: (0, 1), to: (1, 1) };

    /// Returns the part of the interval in which the linear function of the path parameter with the values `start` at
    /// 0 and `end` at 1 is positive; `None` if there is none.
    pub fn where_positive(self, start: i64, end: i64) -> Option<Window> {
        let (start, end) = (i128::from(start), i128::from(end));
        let mut window = self;
        match (start > 0, end > 0) {
            (true, true) => return Some(self),
            (false, false) => return None,
            (true, false) => {
                let bound = (start, start - end);
                if order(bound, window.to).is_lt() {
                    window.to = bound;
                }
            }
            (false, true) => {
                let bound = (-start, end - start);
                if order(window.from, bound).is_lt() {
                    window.from = bound;
                }
            }
        }
        order(window.from, window.to).is_lt().then_some(window)
    }

    /// Returns true if the interval contains all of another.
    pub fn contains(self, other: Window) -> bool {
        order(self.from, other.from).is_le() && order(other.to, self.to).is_le()
    }
}

/// Returns the part of `window`, an interval of the path parameter, in which the projections of two moving cells onto
/// an axis (0 to 2 for x, y, z) overlap; `None` if there is none. `[a, b]`: each cell as (before, after) the stage;
/// its faces move linearly.
pub(super) fn overlap([a, b]: [(&Cube, &Cube); 2], axis: usize, window: Window) -> Option<Window> {
    let above =
        |p: (&Cube, &Cube), q: (&Cube, &Cube)| (p.0.hi[axis] - q.0.lo[axis], p.1.hi[axis] - q.1.lo[axis]);
    [above(a, b), above(b, a), above(a, a), above(b, b)]
        .into_iter()
        .try_fold(window, |window, (start, end)| window.where_positive(start, end))
}
