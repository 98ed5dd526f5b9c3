//! Reconfiguration of lattices in place by pushes. The goal is laid over the start so that most cells stay, and those that are too
//! many go to the sites that are missing: lines of cells move on by one cell, which takes 2 units of time whatever
//! their length. A hole so wanders through the robot as a rook does on a chessboard; where it would cut the robot in
//! two, a cell squeezes in beside another instead, and on from there, so that every site stays full.
//!
//! Line moves are those of Almethen, Michail and Potapov ("Pushing lines helps: Efficient universal centralised
//! transformations for programmable matter", Theoretical Computer Science 830, 2020); here whole sets of lines move at
//! once. The way that is best of many runs with other choices is taken.

mod boxes;
mod grid;
mod routes;
mod runs;
mod search;
mod stage;

pub(super) use boxes::Placed;
pub(super) use runs::best;

/// The lattice sites that bind a reconfiguration: those of cells that stand fast, and those of obstacles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds<'a> {
    /// The sites of the cells that stand fast, of the start and of the goal, in cells. None for a lattice that floats.
    pub(crate) fixed: &'a [[i64; 3]],
    /// The sites that stay empty, in cells.
    pub(crate) obstacles: &'a [[i64; 3]],
}
