//! Arithmetic runs: numbers on which something changes by the same step from each to the next, and runs of such
//! runs, which state lists of cells in closed form.

/// The numbers `first + length·i + j` for `i` in 0..times and `j` in 0..length: `times` lines of numbers that follow
/// each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArithmeticRun {
    /// The first number.
    pub first: usize,
    /// The number of lines.
    pub times: usize,
    /// The length of a line.
    pub length: usize,
}

/// Splits 0..count greedily into arithmetic runs, in ascending order. `step` is the change from one number to
/// another; `None` if no run may hold both.
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
