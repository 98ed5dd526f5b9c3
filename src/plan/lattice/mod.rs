//! The law of lattice motion in exact integer arithmetic, which the planner of lattices and the judge share: the
//! positions of cells, their overlaps and contacts during a stage, their speeds under the stage's time scaling, and
//! the forces that their contacts carry.
//!
//! The law describes a stage; it knows no limits of a plan, and accepts nothing. `squeeze` uses it to choose
//! durations of stages, the judge ([`verify::lattice`](crate::plan::verify::lattice)) to compare every quantity of
//! the finished stages with the plan's limits again.

pub mod fault;
pub mod grid;

mod window;

pub mod contacts;

mod tiles;

pub mod boxes;
pub mod lanes;
pub mod transient;

pub mod law;
pub mod lower_bound;

pub mod measures;

pub use fault::LatticeFault;
pub use grid::{Cube, Grid};
pub use measures::{Places, end_shapes, greatest_relative_displacement, peak_forces, time_lower_bound};
