//! Linear programmes, by an interior-point method. What it answers is close to the optimum, not a
//! proof of it: who needs a proof checks the multipliers, which are returned for that.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

/// Iterations of the solver.
const ROUNDS_MAX: u32 = 200;

/// `min c·x` subject to `E x = e` and `G x ≤ g`. Rows are lists of (column, coefficient).
#[derive(Clone, Debug, Default)]
pub struct Problem {
    pub costs: Vec<f64>,
    pub equal: Vec<(Vec<(usize, f64)>, f64)>,
    pub at_most: Vec<(Vec<(usize, f64)>, f64)>,
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
    let rows: Vec<_> = problem.equal.iter().chain(&problem.at_most).collect();
    let (mut at_row, mut at_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (row, (terms, _)) in rows.iter().enumerate() {
        for &(column, value) in terms {
            at_row.push(row);
            at_column.push(column);
            values.push(value);
        }
    }
    let matrix = CscMatrix::new_from_triplets(rows.len(), n, at_row, at_column, values);
    let right: Vec<f64> = rows.iter().map(|(_, value)| *value).collect();
    let cones = [ZeroConeT(problem.equal.len()), NonnegativeConeT(problem.at_most.len())];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_iter(ROUNDS_MAX)
        .max_threads(1)
        .build()
        .map_err(|_| Unsolved::Numerical)?;
    let costs = CscMatrix::zeros((n, n));
    let mut solver = DefaultSolver::new(&costs, &problem.costs, &matrix, &right, &cones, settings)
        .map_err(|_| Unsolved::Numerical)?;
    solver.solve();
    let (y, z) = solver.solution.z.split_at(problem.equal.len());
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            Ok(Solution { x: solver.solution.x.clone(), y: y.to_vec(), z: z.to_vec() })
        }
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Err(Unsolved::Infeasible),
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Err(Unsolved::Unbounded),
        _ => Err(Unsolved::Numerical),
    }
}
