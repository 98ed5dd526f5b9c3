//! The judgement of lattices, whose plans are stages, in whole numbers: nothing is rounded, and nothing
//! is sampled.
//!
//! Of each stage, in this order: sizes, speeds and accelerations by the law of its motion; what pushes
//! the robot from outside; cells that meet and cells that stay in contact; and the forces between them.

mod bound;
mod boxes;
mod contacts;
mod grid;
mod judge;
mod lanes;
mod law;
mod moments;
mod tiles;
mod window;

pub use judge::*;
