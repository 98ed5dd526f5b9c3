//! Cholesky's decomposition of sparse matrices, in the order of reverse Cuthill and McKee.

use super::cholesky::{Cholesky, PivotRule, SymmetricMatrix, cholesky_work};
use super::cuthill_mckee;

/// Threshold: a matrix counts as not positive definite if a pivot is not above this fraction, without unit, of its
/// diagonal entry, a hundred times the rounding of double precision.
const TOL_PIVOT: f64 = 1e-14;

/// The Cholesky decomposition `L Lᵀ = P A Pᵀ` of a sparse matrix A, where the permutation P (reverse Cuthill-McKee)
/// keeps the envelope of L small.
pub(crate) struct SparseCholesky {
    /// The row of L for each row of A, and the row of A for each row of L.
    position: Vec<usize>,
    order: Vec<usize>,
    factor: Cholesky,
}

impl SparseCholesky {
    /// Returns the decomposition of an n × n matrix given by its entries (row, column, value) on and above the
    /// diagonal, or below, with indices from 0; those with equal indices are summed. `None` if it is not positive
    /// definite, or if the bound on its multiplications ([`cholesky_work`]) is above `work_max`.
    pub(crate) fn new(n: usize, entries: &[(usize, usize, f64)], work_max: usize) -> Option<SparseCholesky> {
        let order = cuthill_mckee::reverse_order(n, entries.iter().map(|&(i, j, _)| (i, j)));
        let mut position = vec![0; n];
        order.iter().enumerate().for_each(|(at, i)| position[*i] = at);
        let lower = |&(i, j, v): &(usize, usize, f64)| {
            let (a, b) = (position[i], position[j]);
            (a.max(b), a.min(b), v)
        };
        let mut first: Vec<usize> = (0..n).collect();
        for (row, column, _) in entries.iter().map(lower) {
            first[row] = first[row].min(column);
        }
        // The bound comes before the matrix, which would be large where the bound is exceeded.
        if cholesky_work(&first) > work_max {
            return None;
        }
        let mut matrix = SymmetricMatrix::with_envelope(first);
        for (row, column, value) in entries.iter().map(lower) {
            matrix.add(row, column, value);
        }
        let factor = matrix.cholesky(PivotRule::Refuse(TOL_PIVOT))?;
        Some(SparseCholesky { position, order, factor })
    }

    /// Replaces `x`, with an entry for every row, by `L⁻¹ P x` (forward substitution); P is the permutation of the
    /// factor.
    pub(crate) fn solve_lower(&self, x: &mut [f64]) {
        let mut y: Vec<f64> = self.order.iter().map(|i| x[*i]).collect();
        self.factor.solve_lower(&mut y);
        x.copy_from_slice(&y);
    }

    /// Replaces `y`, with an entry for every row, by `Pᵀ L⁻ᵀ y` (backward substitution); P is the permutation of the
    /// factor.
    pub(crate) fn solve_upper(&self, y: &mut [f64]) {
        self.factor.solve_upper(y);
        let x: Vec<f64> = self.position.iter().map(|at| y[*at]).collect();
        y.copy_from_slice(&x);
    }
}
