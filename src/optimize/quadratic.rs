//! Convex quadratic programs that grow: rows are added, or their right sides changed, between solutions.
//!
//! Small ones, and those whose H is nearly diagonal, are solved by a dual active-set method that goes on from the
//! last solution and its Lagrange multipliers ([`super::active_set`]); others, and those that it can't solve, by an
//! interior-point method from the start.

use super::active_set::{ActiveSet, Kind, Side};
use super::cholesky::PivotRule;
use super::cuthill_mckee::neighbours;
use super::interior_point;
use super::linear::{Row, Unsolved};
use super::sparse_cholesky::{SparseCholesky, SparseMatrix};
use super::supernodes::SymbolicFactor;
use std::sync::Arc;

/// The greatest number of multiplications to decompose H for which the active-set method is used: up to there it was
/// measured to be the faster.
const WORK_MAX: usize = 400_000_000;
/// Threshold: H counts as singular if a pivot is not above this fraction, without unit, of its diagonal entry, a
/// hundred times the rounding of double precision.
const TOL_PIVOT: f64 = 1e-14;

/// The convex quadratic program `min ½ xᵀ H x + c·x + Σ |a·x - b|` subject to `E x = e` and `G x ≤ g`, whose rows are added
/// one by one; between solutions it is warm-started.
pub struct QuadraticProgram {
    /// The entries of the positive semidefinite H on and above the diagonal; those with equal indices are
    /// summed.
    hessian: Vec<(usize, usize, f64)>,
    /// The linear term c of the objective.
    linear: Vec<f64>,
    /// Each row, with its kind.
    rows: Vec<(Row, Kind)>,
    /// The same rows, by the same numbers; `None` where H is singular or too dense.
    active: Option<ActiveSet>,
}

impl QuadraticProgram {
    /// Returns the program without constraints. `hessian`: entries (row, column, value) of the positive semidefinite
    /// H on and above the diagonal, with indices from 0, of which those with equal indices are summed; `linear`: c,
    /// one entry for every variable; `tolerance`: the most by which the active-set method may leave a row violated,
    /// in the units of its right side.
    pub fn new(hessian: Vec<(usize, usize, f64)>, linear: Vec<f64>, tolerance: f64) -> QuadraticProgram {
        QuadraticProgram::in_blocks(hessian, linear, tolerance, (1, None))
    }

    /// Returns the program of [`new`](Self::new) over variables in consecutive blocks of equal size, such as the
    /// coordinates of nodes. `blocks`: that size, and an order of the blocks, numbered from 0, in which the decomposition of
    /// H fills little; `None` for that of minimum degree.
    pub fn in_blocks(
        hessian: Vec<(usize, usize, f64)>,
        linear: Vec<f64>,
        tolerance: f64,
        blocks: (usize, Option<&[usize]>),
    ) -> QuadraticProgram {
        let factor = factor(linear.len(), &hessian, blocks);
        let active = factor.map(|factor| ActiveSet::new(factor, &linear, tolerance));
        QuadraticProgram { hessian, linear, rows: Vec::new(), active }
    }

    /// Adds an equality `a·x = b`, which takes the next row number, from 0.
    pub fn equal(&mut self, row: Row) {
        self.add(row, Kind::Equal);
    }

    /// Adds an inequality `a·x ≤ b`. Returns its row number, for [`set`](Self::set): equalities and inequalities are
    /// counted together, from 0.
    pub fn at_most(&mut self, row: Row) -> usize {
        self.add(row, Kind::AtMost)
    }

    /// Adds the cost `|a·x - b|`, which takes the next row number.
    pub fn absolute(&mut self, row: Row) {
        self.add(row, Kind::Absolute);
    }

    /// Returns for each cost of [`absolute`](Self::absolute), in the order in which they were added, the side of b on which
    /// a·x was at the last solution; empty if it was not found by the active-set method.
    pub fn sides(&self) -> Vec<Side> {
        self.active.as_ref().map_or_else(Vec::new, ActiveSet::sides)
    }

    /// Begins the next solution with the costs of [`absolute`](Self::absolute) on these sides, in their order: those of a
    /// program like this one, whose solution is then found sooner.
    pub fn begin(&mut self, sides: &[Side]) {
        self.active.iter_mut().for_each(|active| active.begin(sides));
    }

    fn add(&mut self, row: Row, kind: Kind) -> usize {
        if let Some(active) = &mut self.active {
            active.add(row.clone(), kind);
        }
        self.rows.push((row, kind));
        self.rows.len() - 1
    }

    /// Sets the right side of the row of this number, from 0 in the order in which rows were added. Panics if there
    /// is no such row.
    pub fn set(&mut self, row: usize, right: f64) {
        self.rows[row].0.1 = right;
        if let Some(active) = &mut self.active {
            active.set(row, right);
        }
    }

    /// Returns the optimal x for the rows as they are now, one entry for every variable, by the dual active-set
    /// method of Goldfarb and Idnani (1983), to the tolerance of [`new`](Self::new); where that fails, and if H is
    /// singular or too dense for it, by an interior-point method to the tolerance of
    /// [`solve_linear_program`](super::solve_linear_program).
    ///
    /// # Errors
    /// The reason that there is none. [`Unsolved::Numerical`] also where a strictly convex program has a solution
    /// that rounding hides.
    pub fn solve(&mut self) -> Result<Vec<f64>, Unsolved> {
        // The other method decides where the active-set method fails, for rounding may hide the solution; if
        // that can't, either, the first result holds.
        let mut doubt = Unsolved::Numerical;
        if let Some(active) = &mut self.active {
            match active.solve() {
                Ok(x) => return Ok(x),
                Err(why) => doubt = why,
            }
            active.forget();
        }
        let (linear, equal, at_most) = self.lifted();
        let n = linear.len();
        let hessian = interior_point::matrix((n, n), self.hessian.iter().copied());
        let solved = interior_point::solve(&hessian, &linear, &equal, &at_most);
        let mut solution = solved.map_err(|why| if why == Unsolved::Numerical { doubt } else { why })?;
        solution.x.truncate(self.linear.len());
        Ok(solution.x)
    }

    /// Returns the linear term, the equalities and the inequalities of the program in which each absolute value |a·x - b| has
    /// become a variable t of its own, behind the others, with t ≥ a·x - b and t ≥ b - a·x.
    fn lifted(&self) -> (Vec<f64>, Vec<Row>, Vec<Row>) {
        let mut linear = self.linear.clone();
        let (mut equal, mut at_most) = (Vec::new(), Vec::new());
        for ((terms, right), kind) in &self.rows {
            match kind {
                Kind::Equal => equal.push((terms.clone(), *right)),
                Kind::AtMost => at_most.push((terms.clone(), *right)),
                Kind::Absolute => {
                    for sign in [1.0, -1.0] {
                        let terms = terms.iter().map(|(at, value)| (*at, sign * value));
                        at_most.push((terms.chain([(linear.len(), -1.0)]).collect(), sign * right));
                    }
                    linear.push(1.0);
                }
            }
        }
        (linear, equal, at_most)
    }
}

/// Returns the decomposition of an n × n matrix from its entries on and above the diagonal; `None` if it is not positive
/// definite within rounding, or takes too much work.
fn factor(
    n: usize,
    entries: &[(usize, usize, f64)],
    (size, order): (usize, Option<&[usize]>),
) -> Option<SparseCholesky> {
    let mut positive = vec![false; n];
    entries.iter().filter(|(i, j, value)| i == j && *value > 0.0).for_each(|(i, _, _)| positive[*i] = true);
    if positive.contains(&false) || !n.is_multiple_of(size) {
        return None;
    }
    // Entries of one block often stand together.
    let mut pairs: Vec<(usize, usize)> = entries.iter().map(|&(i, j, _)| (i / size, j / size)).collect();
    pairs.dedup();
    let neighbours = neighbours(n / size, pairs.into_iter());
    let symbolic = match order {
        Some(order) => SymbolicFactor::in_order(size, &neighbours, order),
        None => SymbolicFactor::new(size, &neighbours),
    };
    if symbolic.work() > WORK_MAX {
        return None;
    }
    let mut matrix = SparseMatrix::new(&Arc::new(symbolic));
    entries.iter().for_each(|&(i, j, value)| matrix.add(i, j, value));
    matrix.cholesky(PivotRule::Refuse(TOL_PIVOT))
}
