//! Convex quadratic programmes that grow: rows are added, and asked for more, between solutions.
//!
//! Small ones, and those whose H is nearly diagonal, are solved by an active-set method that goes on from
//! the last solution; others, and those that it can't solve, by an interior-point method from the start.

use super::active_set::ActiveSet;
use super::factor::Factor;
use super::linear::Unsolved;
use super::sparse;
pub use super::sparse::Row;
use clarabel::algebra::CscMatrix;

/// Multiplications to factor H up to which the active-set method was measured to be the faster.
const WORK_MAX: usize = 400_000_000;

/// `min ½ xᵀ H x + c·x` subject to `E x = e` and `G x ≤ g`. Rows are lists of (column, coefficient).
pub struct Programme {
    /// Of the positive semidefinite H what is on and above the diagonal; entries at one place are summed.
    hessian: Vec<(usize, usize, f64)>,
    linear: Vec<f64>,
    equal: Vec<Row>,
    at_most: Vec<Row>,
    /// The numbers of `at_most` there.
    active: Option<(ActiveSet, Vec<usize>)>,
}

impl Programme {
    /// `tolerance`: how far rows may be off, in the units of their right sides.
    pub fn new(hessian: Vec<(usize, usize, f64)>, linear: Vec<f64>, tolerance: f64) -> Programme {
        let factor = Factor::new(linear.len(), &hessian, WORK_MAX);
        let active = factor.map(|factor| (ActiveSet::new(factor, &linear, tolerance), Vec::new()));
        Programme { hessian, linear, equal: Vec::new(), at_most: Vec::new(), active }
    }

    pub fn equal(&mut self, row: Row) {
        if let Some((active, _)) = &mut self.active {
            active.equal(row.clone());
        }
        self.equal.push(row);
    }

    /// Says its number.
    pub fn at_most(&mut self, row: Row) -> usize {
        if let Some((active, places)) = &mut self.active {
            places.push(active.at_most(row.clone()));
        }
        self.at_most.push(row);
        self.at_most.len() - 1
    }

    /// Another right side for an inequality.
    pub fn set(&mut self, row: usize, right: f64) {
        self.at_most[row].1 = right;
        if let Some((active, places)) = &mut self.active {
            active.set(places[row], right);
        }
    }

    pub fn solve(&mut self) -> Result<Vec<f64>, Unsolved> {
        // Where this one fails the other decides, for rounding may hide a way here; if that can't, either,
        // what was found first holds.
        let mut doubt = Unsolved::Numerical;
        if let Some((active, _)) = &mut self.active {
            match active.solve() {
                Ok(x) => return Ok(x),
                Err(why) => doubt = why,
            }
            active.forget();
        }
        let n = self.linear.len();
        let (mut at_row, mut at_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for &(row, column, value) in &self.hessian {
            at_row.push(row);
            at_column.push(column);
            values.push(value);
        }
        let hessian = CscMatrix::new_from_triplets(n, n, at_row, at_column, values);
        let solved = sparse::solved(&hessian, &self.linear, &self.equal, &self.at_most);
        solved.map(|solution| solution.x).map_err(|why| if why == Unsolved::Numerical { doubt } else { why })
    }
}
