//! Linear programs, by an interior-point method. The answer is close to the optimum, not a proof of it: who needs a
//! proof checks the Lagrange multipliers, which are returned for that.

use super::interior_point;
use clarabel::algebra::CscMatrix;

/// A row `Σ coefficient · x[column]` of a constraint: terms (column, coefficient), with columns from 0, and the
/// value on the right.
pub type Row = (Vec<(usize, f64)>, f64);

/// The linear program `min c·x` subject to `E x = e` and `G x ≤ g`. Variables are free: bounds on them are rows of G.
#[derive(Clone, Debug, Default)]
pub struct LinearProgram {
    /// The vector c: one cost for every variable.
    pub costs: Vec<f64>,
    /// The rows of `E x = e`; the multipliers of a solution are in their order.
    pub equal: Vec<Row>,
    /// The rows of `G x ≤ g`; the multipliers of a solution are in their order.
    pub at_most: Vec<Row>,
}

/// A solution of a [`LinearProgram`], whose letters c, E and G these are, with its Lagrange multipliers:
/// `c + Eᵀ y + Gᵀ z = 0`, `z ≥ 0`, to the tolerance that [`solve_linear_program`] states.
#[derive(Clone, Debug)]
pub struct LinearSolution {
    /// The optimal values of the variables, in the order of [`LinearProgram::costs`].
    pub x: Vec<f64>,
    /// The Lagrange multiplier of each equality, in the order of [`LinearProgram::equal`].
    pub y: Vec<f64>,
    /// The Lagrange multiplier of each inequality, in the order of [`LinearProgram::at_most`]; 0, to the tolerance,
    /// where it is not active.
    pub z: Vec<f64>,
}

/// The reason that a linear or quadratic program has no solution, as the solver found it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// The constraints exclude each other: no x meets them all.
    Infeasible,
    /// The objective has no lower bound on the feasible set.
    Unbounded,
    /// The solver did not converge, or refused the numbers.
    Numerical,
}

/// Solves a linear program by clarabel's primal-dual interior-point method.
///
/// # Errors
/// The status of the solver, as [`Unsolved`], where it found no solution. A status, and a solution, holds to the
/// solver's tolerance: 1e-8, or 5e-5 (the rows 1e-4) where it could get no nearer.
pub fn solve_linear_program(problem: &LinearProgram) -> Result<LinearSolution, Unsolved> {
    crate::interrupt::checkpoint();
    let n = problem.costs.len();
    interior_point::solve(&CscMatrix::zeros((n, n)), &problem.costs, &problem.equal, &problem.at_most)
}
