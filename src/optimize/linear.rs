//! Linear programmes, by an interior-point method. What it answers is close to the optimum, not a
//! proof of it: who needs a proof checks the multipliers, which are returned for that.

use super::sparse::{self, Row};
use clarabel::algebra::CscMatrix;

/// `min c·x` subject to `E x = e` and `G x ≤ g`. Rows are lists of (column, coefficient).
#[derive(Clone, Debug, Default)]
pub struct Problem {
    pub costs: Vec<f64>,
    pub equal: Vec<Row>,
    pub at_most: Vec<Row>,
}

/// A solution with its multipliers: `c + Eᵀ y + Gᵀ z = 0`, `z ≥ 0`, as nearly as the solver gets.
#[derive(Clone, Debug)]
pub struct Solution {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub z: Vec<f64>,
}

/// Why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// No x meets the constraints.
    Infeasible,
    /// The costs have no lower bound.
    Unbounded,
    /// The solver did not get there.
    Numerical,
}

pub fn linear_program(problem: &Problem) -> Result<Solution, Unsolved> {
    crate::interrupt::checkpoint();
    let n = problem.costs.len();
    sparse::solved(&CscMatrix::zeros((n, n)), &problem.costs, &problem.equal, &problem.at_most)
}
