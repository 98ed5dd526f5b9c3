//! Optimisation. The only user of clarabel; knows no robots.

mod active_set;
mod factor;
pub mod linear;
pub mod quadratic;
mod sparse;
