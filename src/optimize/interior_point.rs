//! Linear and quadratic programs put before clarabel's interior-point method.

use super::linear::{LinearSolution, Row, Unsolved};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

/// The greatest number of iterations of the solver.
const ITERATIONS_MAX: u32 = 200;

/// Solves `min ½ xᵀ H x + c·x` subject to the rows by clarabel's primal-dual interior-point method, in at most
/// `ITERATIONS_MAX` iterations. `hessian` holds the entries of H on and above the diagonal, `costs` c; `equal` are
/// equalities, `at_most` inequalities, in whose order the multipliers of the result are.
///
/// # Errors
/// [`Unsolved::Infeasible`] or [`Unsolved::Unbounded`] if the solver found that, [`Unsolved::Numerical`] if it found
/// neither that nor a solution, not even an approximate one.
pub(super) fn solve(
    hessian: &CscMatrix,
    costs: &[f64],
    equal: &[Row],
    at_most: &[Row],
) -> Result<LinearSolution, Unsolved> {
    let n = costs.len();
    let rows: Vec<_> = equal.iter().chain(at_most).collect();
    let entries = rows.iter().enumerate();
    let entries =
        entries.flat_map(|(row, (terms, _))| terms.iter().map(move |&(at, value)| (row, at, value)));
    let matrix = matrix((rows.len(), n), entries);
    let right: Vec<f64> = rows.iter().map(|(_, value)| *value).collect();
    let cones = [ZeroConeT(equal.len()), NonnegativeConeT(at_most.len())];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_iter(ITERATIONS_MAX)
        .max_threads(1)
        .build()
        .map_err(|_| Unsolved::Numerical)?;
    let mut solver = DefaultSolver::new(hessian, costs, &matrix, &right, &cones, settings)
        .map_err(|_| Unsolved::Numerical)?;
    solver.solve();
    let (y, z) = solver.solution.z.split_at(equal.len());
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            Ok(LinearSolution { x: solver.solution.x.clone(), y: y.to_vec(), z: z.to_vec() })
        }
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Err(Unsolved::Infeasible),
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Err(Unsolved::Unbounded),
        _ => Err(Unsolved::Numerical),
    }
}

/// Returns a sparse matrix of `rows` × `columns` from entries (row, column, value), indices from 0; those with equal
/// indices are summed.
pub(super) fn matrix(
    (rows, columns): (usize, usize),
    entries: impl Iterator<Item = (usize, usize, f64)>,
) -> CscMatrix {
    let (mut at_row, mut at_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column, value) in entries {
        at_row.push(row);
        at_column.push(column);
        values.push(value);
    }
    CscMatrix::new_from_triplets(rows, columns, at_row, at_column, values)
}
