//! Optimisation: linear programs, growing quadratic programs, Cholesky's decomposition, an evolution strategy, and the generator of
//! pseudo-random numbers that searches draw from. The only user of clarabel; knows no robots.

pub mod cholesky;
pub mod cuthill_mckee;
pub mod minimum_degree;
pub mod nested_dissection;
mod panel_products;
pub mod sparse_cholesky;
mod supernodes;
pub(crate) mod wide;

pub mod random;

mod cma_es;
mod interior_point;
mod linear;

mod active_set;
mod quadratic;

pub use active_set::Side;
pub use cholesky::SymmetricMatrix;
pub use cma_es::CmaEs;
pub use linear::{LinearProgram, LinearSolution, Row, Unsolved, solve_linear_program};
pub use quadratic::QuadraticProgram;
pub use supernodes::{Slot, SymbolicFactor};
