//! Reasons for which a lattice plan has no exact arithmetic.

use std::fmt;

/// A reason why stages of a lattice cannot be put into integers, or cannot be measured in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeFault {
    /// The common denominator of all coordinates is too large: a cell would take more than 2⁴⁰ grid lines.
    GridTooFine,
    /// A coordinate is too large: a face would lie more than 2⁴⁸ grid lines from the origin.
    CellsTooFar,
    /// More pairs of cells come near each other than are examined.
    Entangled,
    /// The centre of mass moves, so contact forces alone do not explain the motion.
    CentreMoves,
    /// A cell does not fill a lattice site, a cube of its full size at whole multiples of it from the others.
    OffLattice,
}

impl fmt::Display for LatticeFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            LatticeFault::GridTooFine => "the places of the cells are too fine to be judged exactly",
            LatticeFault::CellsTooFar => "the cells are too far apart to be judged exactly",
            LatticeFault::Entangled => "too entangled",
            LatticeFault::CentreMoves => "the centre of mass moves",
            LatticeFault::OffLattice => "cells are not at places of the lattice",
        })
    }
}

impl std::error::Error for LatticeFault {}
