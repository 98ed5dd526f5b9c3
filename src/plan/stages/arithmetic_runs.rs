//! Arithmetic runs: numbers on which something changes by the same step from each to the next, and runs of such
//! runs, which state lists of cells in closed form.

use super::motion::{Counter, Run};
use super::ratio::Ratio;

/// The numbers `first + length·i + j` for `i` in 0..times and `j` in 0..length: `times` lines of `length` consecutive
/// numbers, one line after the other, so all numbers from `first` to `first + length·times - 1`. From each number of a
/// line to the next there is one step, the same in all lines, and from each line's first number to that of the next
/// another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArithmeticRun {
    /// The first number of the first line.
    pub first: usize,
    /// The number of lines, at least 1.
    pub times: usize,
    /// The number of numbers in a line, at least 1.
    pub length: usize,
}

impl ArithmeticRun {
    /// Returns the run of the cells with these numbers, whose sizes are alike. `center`: the centre of the first one, and
    /// `size`: the size of each, in cell sizes; `step(a, b)` returns the displacement from the cell of number `a` to that of
    /// number `b` (`a < b`). `None` where `step` returns none.
    pub fn of_cells(
        &self,
        (center, size): ([Ratio; 3], [Ratio; 3]),
        step: impl Fn(usize, usize) -> Option<[Ratio; 3]>,
    ) -> Option<Run> {
        let counters =
            [(self.times, self.length), (self.length, 1)].into_iter().filter(|(count, _)| *count > 1);
        let counter = |(count, stride): (usize, usize)| {
            let step = step(self.first, self.first + stride)?;
            Some(Counter { count: count as u64, stride: stride as i64, step })
        };
        let counters = counters.map(counter).collect::<Option<_>>()?;
        Some(Run { first: self.first as u64, counters, center, size })
    }
}

/// Splits the numbers 0 to `count - 1` greedily into arithmetic runs, which follow each other in ascending order and
/// hold each number once; empty if `count` is 0. `step(a, b)` returns the change of what is attached to the numbers
/// from `a` to `b` (`a < b`), such as the displacement between two cells; `None` if no run may hold both.
pub fn arithmetic_runs<T: PartialEq>(
    count: usize,
    step: impl Fn(usize, usize) -> Option<T>,
) -> Vec<ArithmeticRun> {
    // Lines of numbers with one step: the first number of each, and its length.
    let mut lines: Vec<(usize, usize)> = Vec::new();
    let mut at = 0;
    while at < count {
        let mut end = at + 1;
        if end < count
            && let Some(first) = step(at, end)
        {
            while end < count && step(end - 1, end).as_ref() == Some(&first) {
                end += 1;
            }
        }
        lines.push((at, end - at));
        at = end;
    }
    // Lines that are alike and one step apart make a run.
    let mut found = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let (first, length) = lines[at];
        let alike = |other: (usize, usize)| {
            other.1 == length && (length == 1 || step(first, first + 1) == step(other.0, other.0 + 1))
        };
        let mut end = at + 1;
        if let Some(&next) = lines.get(end)
            && alike(next)
            && let Some(across) = step(first, next.0)
        {
            while lines.get(end).is_some_and(|&other| {
                alike(other) && step(lines[end - 1].0, other.0).as_ref() == Some(&across)
            }) {
                end += 1;
            }
        }
        found.push(ArithmeticRun { first, times: end - at, length });
        at = end;
    }
    found
}
