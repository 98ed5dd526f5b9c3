//! Symmetric positive definite systems of equations, by Cholesky's decomposition.

/// The lower half of a symmetric matrix.
pub struct Square {
    size: usize,
    cells: Vec<f64>,
}

impl Square {
    pub fn zeros(size: usize) -> Square {
        Square { size, cells: vec![0.0; size * size] }
    }

    /// Adds to a cell with `row >= column`.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.cells[row * self.size + column] += value;
    }

    pub fn trace(&self) -> f64 {
        (0..self.size).map(|i| self.cells[i * self.size + i]).sum()
    }

    /// Replaces the right side by the solution. A pivot that rounding has made too small is enlarged.
    pub fn solve(mut self, right: &mut [f64]) {
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

const PIVOT_MIN: f64 = 1e-12;
