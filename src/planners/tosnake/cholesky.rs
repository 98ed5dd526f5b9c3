//! Symmetric positive definite systems of linear equations, by Cholesky decomposition.

/// A symmetric positive definite matrix, of which the lower half is kept, row by row.
pub(super) struct NormalMatrix {
    size: usize,
    cells: Vec<f64>,
}

impl NormalMatrix {
    /// Returns the zero matrix of a size.
    pub(super) fn zeros(size: usize) -> NormalMatrix {
        NormalMatrix { size, cells: vec![0.0; size * size] }
    }

    /// Adds to an entry with `row >= column`.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.cells[row * self.size + column] += value;
    }

    /// Returns the trace.
    pub(super) fn trace(&self) -> f64 {
        (0..self.size).map(|i| self.cells[i * self.size + i]).sum()
    }

    /// Replaces the right side by the solution. A pivot that rounding made smaller than [`PIVOT_MIN`] is raised
    /// to it.
    pub(super) fn solve(mut self, right: &mut [f64]) {
        let n = self.size;
        for i in 0..n {
            for j in 0..=i {
                let (above, row) = self.cells.split_at_mut(i * n);
                let other: &[f64] = if j < i { &above[j * n..j * n + j] } else { &[] };
                let sum: f64 = if j < i {
                    row[..j].iter().zip(other).map(|(x, y)| x * y).sum()
                } else {
                    row[..i].iter().map(|x| x * x).sum()
                };
                if j < i {
                    row[j] = (row[j] - sum) / above[j * n + j];
                } else {
                    row[i] = libm::sqrt((row[i] - sum).max(PIVOT_MIN));
                }
            }
        }
        for i in 0..n {
            let sum: f64 = (0..i).map(|j| self.cells[i * n + j] * right[j]).sum();
            right[i] = (right[i] - sum) / self.cells[i * n + i];
        }
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|j| self.cells[j * n + i] * right[j]).sum();
            right[i] = (right[i] - sum) / self.cells[i * n + i];
        }
    }
}

/// Smallest pivot. The matrices here have diagonals of about 1, and are damped by more than this.
const PIVOT_MIN: f64 = 1e-12;
