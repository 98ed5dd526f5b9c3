//! Convex quadratic programmes that grow: rows are added, and asked for more, between solutions.
//!
//! Small ones, and those whose H is nearly diagonal, are solved by an active-set method that goes on from
//! the last solution; others, and those that it can't solve, by an interior-point method from the start.

use super::active_set::ActiveSet;
use super::factor::Factor;
use super::linear::Unsolved;
use super::sparse;
pub use super::sparse::Row;

/// Multiplications to factor H up to which the active-set method was measured to be the faster.
const WORK_MAX: usize = 400_000_000;

/// `min ½ xᵀ H x + c·x` subject to `E x = e` and `G x ≤ g`. Rows are lists of (column, coefficient).
pub struct Programme {
    /// Of the positive semidefinite H what is on and above the diagonal; entries at one place are summed.
    hessian: Vec<(usize, usize, f64)>,
    linear: Vec<f64>,
    /// With whether it is an equality.
    rows: Vec<(Row, bool)>,
    /// The same rows, by the same numbers.
    active: Option<ActiveSet>,
}

impl Programme {
    /// `tolerance`: how far rows may be off, in the units of their right sides.
    pub fn new(hessian: Vec<(usize, usize, f64)>, linear: Vec<f64>, tolerance: f64) -> Programme {
        let factor = Factor::new(linear.len(), &hessian, WORK_MAX);
        let active = factor.map(|factor| ActiveSet::new(factor, &linear, tolerance));
        Programme { hessian, linear, rows: Vec::new(), active }
    }

    pub fn equal(&mut self, row: Row) {
        self.add(row, true);
    }

    /// Says its number.
    pub fn at_most(&mut self, row: Row) -> usize {
        self.add(row, false)
    }

    fn add(&mut self, row: Row, equal: bool) -> usize {
        if let Some(active) = &mut self.active {
            active.add(row.clone(), equal);
        }
        self.rows.push((row, equal));
        self.rows.len() - 1
    }

    /// Another right side for a row.
    pub fn set(&mut self, row: usize, right: f64) {
        self.rows[row].0.1 = right;
        if let Some(active) = &mut self.active {
            active.set(row, right);
        }
    }

    pub fn solve(&mut self) -> Result<Vec<f64>, Unsolved> {
        // Where this one fails the other decides, for rounding may hide a way here; if that can't, either,
        // what was found first holds.
        let mut doubt = Unsolved::Numerical;
        if let Some(active) = &mut self.active {
            match active.solve() {
                Ok(x) => return Ok(x),
                Err(why) => doubt = why,
            }
            active.forget();
        }
        let n = self.linear.len();
        let hessian = sparse::matrix((n, n), self.hessian.iter().copied());
        let of = |kind: bool| -> Vec<Row> {
            self.rows.iter().filter(|(_, equal)| *equal == kind).map(|(row, _)| row.clone()).collect()
        };
        let solved = sparse::solved(&hessian, &self.linear, &of(true), &of(false));
        solved.map(|solution| solution.x).map_err(|why| if why == Unsolved::Numerical { doubt } else { why })
    }
}
