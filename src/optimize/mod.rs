//! Optimisation. The only user of clarabel; knows no robots.

pub mod linear;
pub mod quadratic;
mod sparse;
