//! Reconfiguration in place of lattices of cells that do not slide along each other: they expand, contract, and hold each
//! other where the middles of two faces meet. Shapes consist of blocks of 2 × 2 × 2 cells, the meta-modules of
//! Vassilvitskii, Yim and Suh ("A complete, local and parallel reconfiguration algorithm for cube style modular robots",
//! ICRA 2002) and of Aloupis et al. ("Linear reconfiguration of cube-style modular robots", Computational Geometry 42,
//! 2009). A block tunnels through others (`route`), cell after cell: each cell takes the place of the next one on its way
//! from a site of the block to an empty site (`thread`). While the cells on one way move, the others of each block hold
//! the robot together; where they still do, several move at once (`rounds`).

mod blocks;
mod docking;
mod rounds;
mod route;
mod thread;

pub(super) use blocks::{Blocks, blocks_of};
pub(super) use rounds::way;

/// A lattice site, of a cell in cells or of a block in blocks.
type Site = [i64; 3];

/// The centre and the sides of a cell along x, y and z, in quarters of its full size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellBox {
    /// The centre, in quarters.
    pub(super) center: [i64; 3],
    /// The sides, in quarters.
    pub(super) size: [i64; 3],
}

/// The side of a cell that is expanded, in quarters.
const WHOLE: i64 = 4;
/// The side of a cell that is contracted, in quarters.
const HALF: i64 = 2;

impl CellBox {
    /// Returns the expanded cell that fills a lattice site.
    fn whole(site: Site) -> CellBox {
        CellBox { center: site.map(|x| WHOLE * x + WHOLE / 2), size: [WHOLE; 3] }
    }
}

/// Returns a site moved by `steps` along an axis.
fn moved(mut site: Site, axis: usize, steps: i64) -> Site {
    site[axis] += steps;
    site
}
