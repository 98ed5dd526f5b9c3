//! Cholesky's decomposition `A = L Lᵀ` of symmetric positive definite matrices (Cholesky–Banachiewicz, row by row).
//!
//! Matrices are kept in the envelope (skyline) of their lower half: every row from its first entry that may differ
//! from zero up to the diagonal. `L` fills nothing outside the envelope of `A` (George and Liu 1981, sec. 4.2). A dense
//! matrix is the case in which every row begins in column 0. Used by inverse kinematics (dense, 6 to 106 rows) and, in
//! an order that keeps the envelope small ([`super::cuthill_mckee`]), by the active-set quadratic programs. Small
//! systems of a size known when compiled are left to nalgebra's own decomposition, which needs no heap.

/// Threshold: the part of its diagonal entry, without unit, below which the sign of a pivot is not trusted.
const INERTIA_PIVOT: f64 = 1e-12;

/// A symmetric matrix, of which the lower half is stored by rows within an envelope (skyline storage; George and Liu
/// 1981, sec. 4.2): each row from its first entry that may differ from zero to the diagonal.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix {
    /// The first column of each row.
    first: Vec<usize>,
    /// The index in `values` of each row's first entry, and one more at the end.
    start: Vec<usize>,
    values: Vec<f64>,
    summation: Summation,
}

/// The order in which products are summed; it decides the last digits, and nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Summation {
    /// The sum from the first to the last: for small dense matrices, which have no long rows.
    InOrder,
    /// Four sums side by side, which a processor adds at once: rows of an envelope may be long.
    FourLanes,
}

/// The treatment of a pivot that is not positive enough, so that the matrix is not positive definite within rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PivotRule {
    /// The decomposition fails where a pivot is not above this fraction (without unit) of the diagonal entry it
    /// comes from.
    Refuse(f64),
    /// A lesser pivot is raised to this value, in the units of the matrix: the solution is damped instead of
    /// refused.
    Raise(f64),
}

/// The factor `L` of the Cholesky decomposition `A = L Lᵀ`: lower triangular with a positive diagonal, in the
/// envelope of A.
#[derive(Clone, Debug)]
pub struct Cholesky {
    lower: SymmetricMatrix,
}

impl SymmetricMatrix {
    /// Returns the zero matrix of `size` rows with room for every entry of the lower half.
    pub fn dense(size: usize) -> SymmetricMatrix {
        SymmetricMatrix { summation: Summation::InOrder, ..SymmetricMatrix::with_envelope(vec![0; size]) }
    }

    /// Returns the zero matrix with one row for each entry of `first`, where row `i` has room for the columns from
    /// `first[i]` to `i`. Panics if `first[i]` is greater than `i`.
    pub fn with_envelope(first: Vec<usize>) -> SymmetricMatrix {
        let mut start = Vec::with_capacity(first.len() + 1);
        start.push(0);
        let mut end = 0;
        for (row, first) in first.iter().enumerate() {
            assert!(*first <= row, "a row's envelope reaches to the diagonal");
            end += row + 1 - first;
            start.push(end);
        }
        SymmetricMatrix { first, start, values: vec![0.0; end], summation: Summation::FourLanes }
    }

    /// Returns the number of rows, which is that of columns.
    pub fn size(&self) -> usize {
        self.first.len()
    }

    /// Returns the first column of the envelope of a row; rows and columns count from 0. Panics if there is no such
    /// row.
    #[inline]
    pub fn first(&self, row: usize) -> usize {
        self.first[row]
    }

    /// Returns the stored entries of a row, in order of column, from the first column of its envelope up to the
    /// diagonal; rows count from 0. Panics if there is no such row.
    #[inline]
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[self.start[row]..self.start[row + 1]]
    }

    /// Returns the stored entries of a row for writing, in order of column, from the first column of its envelope up
    /// to the diagonal; rows count from 0. Panics if there is no such row.
    #[inline]
    pub fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.values[self.start[row]..self.start[row + 1]]
    }

    /// Adds `value` to the entry at a row and a column, both from 0. Panics unless the entry lies in the envelope of
    /// the lower half.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let first = self.first[row];
        self.row_mut(row)[column - first] += value;
    }

    /// Returns the trace, the sum of the diagonal entries, in the unit of the entries.
    pub fn trace(&self) -> f64 {
        (0..self.size()).map(|row| self.values[self.start[row + 1] - 1]).sum()
    }

    /// Returns the Cholesky decomposition of the matrix, made in place row by row (Cholesky–Banachiewicz). `None`
    /// where the rule refuses a pivot; [`PivotRule::Raise`] refuses none.
    pub fn cholesky(mut self, rule: PivotRule) -> Option<Cholesky> {
        for i in 0..self.size() {
            let (done, rest) = self.values.split_at_mut(self.start[i]);
            let from = self.first[i];
            let row = &mut rest[..i + 1 - from];
            for j in from..i {
                let other = &done[self.start[j]..self.start[j + 1]];
                let first = self.first[j];
                let common = from.max(first);
                let sum =
                    self.summation.dot(&row[common - from..j - from], &other[common - first..j - first]);
                row[j - from] = (row[j - from] - sum) / other[j - first];
            }
            let (diagonal, before) = row.split_last_mut()?;
            let pivot = *diagonal - self.summation.dot(before, before);
            *diagonal = libm::sqrt(rule.accepted(pivot, *diagonal)?);
        }
        Some(Cholesky { lower: self })
    }

    /// Returns the number of negative pivots of the decomposition `L D Lᵀ`, which is that of negative eigenvalues
    /// (Sylvester's law of inertia). `None` if a pivot is so small beside its diagonal entry that rounding decides its
    /// sign.
    pub fn negative_pivots(mut self) -> Option<usize> {
        let mut negative = 0;
        let mut products = Vec::new();
        for i in 0..self.size() {
            let (done, rest) = self.values.split_at_mut(self.start[i]);
            let from = self.first[i];
            let row = &mut rest[..i + 1 - from];
            // Rows hold L, `products` holds L D of this one.
            products.clear();
            products.extend_from_slice(row);
            for j in from..i {
                let other = &done[self.start[j]..self.start[j + 1]];
                let first = self.first[j];
                let common = from.max(first);
                let sum =
                    self.summation.dot(&products[common - from..j - from], &other[common - first..j - first]);
                products[j - from] -= sum;
            }
            for j in from..i {
                row[j - from] = products[j - from] / done[self.start[j + 1] - 1];
            }
            let pivot = row[i - from] - self.summation.dot(&products[..i - from], &row[..i - from]);
            if pivot.abs() <= INERTIA_PIVOT * row[i - from].abs() {
                return None;
            }
            negative += usize::from(pivot < 0.0);
            row[i - from] = pivot;
        }
        Some(negative)
    }
}

/// Returns an upper bound on the number of multiplications that a Cholesky decomposition of a matrix takes, to the
/// leading order, from the first column of the envelope of each row (as for [`SymmetricMatrix::with_envelope`]). It is
/// reached where the first columns never decrease. Panics if `first[i]` is greater than `i`.
pub fn cholesky_work(first: &[usize]) -> usize {
    first.iter().enumerate().map(|(row, first)| (row - first) * (row - first)).sum::<usize>() / 2
}

impl PivotRule {
    fn accepted(self, pivot: f64, diagonal: f64) -> Option<f64> {
        match self {
            PivotRule::Refuse(part) => (pivot > part * diagonal).then_some(pivot),
            PivotRule::Raise(least) => Some(pivot.max(least)),
        }
    }
}

impl Cholesky {
    /// Returns the lower triangular factor `L` of `A = L Lᵀ`.
    pub fn lower(&self) -> &SymmetricMatrix {
        &self.lower
    }

    /// Replaces `b`, with an entry for every row, by `L⁻¹ b` (forward substitution). Leading zeros of `b` stay zeros
    /// and cost nothing. Panics if `b` has more entries than the matrix has rows.
    pub fn solve_lower(&self, b: &mut [f64]) {
        let begin = b.iter().position(|value| *value != 0.0).unwrap_or(b.len());
        for i in begin..b.len() {
            let first = self.lower.first[i].max(begin);
            let row = &self.lower.row(i)[first - self.lower.first[i]..];
            let Some((pivot, row)) = row.split_last() else { continue };
            b[i] = (b[i] - self.lower.summation.dot(row, &b[first..i])) / pivot;
        }
    }

    /// Replaces `y`, with an entry for every row, by `L⁻ᵀ y` (backward substitution). Panics if `y` has more entries
    /// than the matrix has rows.
    pub fn solve_upper(&self, y: &mut [f64]) {
        match self.lower.summation {
            Summation::InOrder => self.solve_upper_by_columns(y),
            Summation::FourLanes => self.solve_upper_by_rows(y),
        }
    }

    /// Solves by backward substitution with the columns of a dense L.
    fn solve_upper_by_columns(&self, y: &mut [f64]) {
        let n = y.len();
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|j| self.lower.row(j)[i] * y[j]).sum();
            y[i] = (y[i] - sum) / self.lower.row(i)[i];
        }
    }

    /// Solves by backward substitution with the rows of L, each within its envelope.
    fn solve_upper_by_rows(&self, y: &mut [f64]) {
        for i in (0..y.len()).rev() {
            let Some((pivot, row)) = self.lower.row(i).split_last() else { continue };
            let value = y[i] / pivot;
            y[i] = value;
            y[self.lower.first[i]..i].iter_mut().zip(row).for_each(|(x, l)| *x -= l * value);
        }
    }

    /// Replaces the right side `b`, with an entry for every row, by the solution x of `A x = b`, by forward and
    /// backward substitution. Panics if `b` has more entries than the matrix has rows.
    pub fn solve(&self, b: &mut [f64]) {
        self.solve_lower(b);
        self.solve_upper(b);
    }
}

impl Summation {
    /// Returns the dot product of two rows of one length.
    #[inline]
    fn dot(self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            Summation::InOrder => a.iter().zip(b).map(|(x, y)| x * y).sum(),
            Summation::FourLanes => four_lanes(a, b),
        }
    }
}

/// Returns the dot product by four sums side by side.
pub(super) fn four_lanes(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3]) + rest
}
