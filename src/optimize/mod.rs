//! Optimisation: linear programs, growing quadratic programs, Cholesky's decomposition, and the generator of
//! pseudo-random numbers that searches draw from. The only user of clarabel; knows no robots.

pub mod cholesky;
pub mod cuthill_mckee;
mod sparse_cholesky;

pub mod random;

mod interior_point;
mod linear;

mod active_set;
mod quadratic;

pub use linear::{LinearProgram, LinearSolution, Row, Unsolved, solve_linear_program};
pub use quadratic::QuadraticProgram;
