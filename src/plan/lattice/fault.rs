//! Reasons for which a lattice plan has no exact arithmetic.

use std::fmt;

/// A reason for which stages of a lattice cannot be put into integers, or cannot be measured in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeFault {
    /// The common denominator of all coordinates is too large.
    GridTooFine,
    /// A coordinate is too large.
    CellsTooFar,
    /// More pairs of cells come near each other than are examined.
    Entangled,
    /// The centre of mass moves, so contact forces alone do not explain the motion.
    CentreMoves,
    /// A cell does not fill a lattice site.
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
