//! Stretches of a stage's progress, from 0 to 1, with ends that are exact fractions.

use super::grid::Cube;
use std::cmp::Ordering;

/// Numerator and positive denominator.
pub type Fraction = (i128, i128);

pub fn order(a: Fraction, b: Fraction) -> Ordering {
    (a.0 * b.1).cmp(&(b.0 * a.1))
}

/// An open stretch of progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub from: Fraction,
    pub to: Fraction,
}

impl Window {
    pub const WHOLE: Window = Window { from: (0, 1), to: (1, 1) };

    /// Keeps of it where what is `start` at 0 and `end` at 1, and linear between, is positive; nothing
    /// if that is nowhere.
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

    /// Whether it holds all of another.
    pub fn holds(self, other: Window) -> bool {
        order(self.from, other.from).is_le() && order(other.to, self.to).is_le()
    }
}

/// When, within a window, two cells overlap along an axis: each with its two ends.
pub fn overlap([a, b]: [(&Cube, &Cube); 2], axis: usize, window: Window) -> Option<Window> {
    let above =
        |p: (&Cube, &Cube), q: (&Cube, &Cube)| (p.0.hi[axis] - q.0.lo[axis], p.1.hi[axis] - q.1.lo[axis]);
    [above(a, b), above(b, a), above(a, a), above(b, b)]
        .into_iter()
        .try_fold(window, |window, (start, end)| window.where_positive(start, end))
}
