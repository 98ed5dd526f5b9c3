//! Convex quadratic programmes, by an interior-point method. The answer is close to the optimum; who
//! needs constraints to hold exactly checks them.

use super::linear::Unsolved;
use super::sparse::{self, Row};
use clarabel::algebra::CscMatrix;

/// `min ½ xᵀ H x + c·x` subject to `E x = e` and `G x ≤ g`. Rows are lists of (column, coefficient).
#[derive(Clone, Debug, Default)]
pub struct Problem {
    /// Entries (row, column, value) of the positive semidefinite H, those on and above the diagonal;
    /// entries at one place are summed.
    pub hessian: Vec<(usize, usize, f64)>,
    pub linear: Vec<f64>,
    pub equal: Vec<Row>,
    pub at_most: Vec<Row>,
}

pub fn quadratic_program(problem: &Problem) -> Result<Vec<f64>, Unsolved> {
    let n = problem.linear.len();
    let (mut at_row, mut at_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for &(row, column, value) in &problem.hessian {
        at_row.push(row);
        at_column.push(column);
        values.push(value);
    }
    let hessian = CscMatrix::new_from_triplets(n, n, at_row, at_column, values);
    let solution = sparse::solved(&hessian, &problem.linear, &problem.equal, &problem.at_most)?;
    Ok(solution.x)
}
