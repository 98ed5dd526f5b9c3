//! Shapes as sets of blocks.

use super::Site;
use std::collections::{BTreeMap, BTreeSet};

/// A shape that consists of blocks of 2 × 2 × 2 cells, all on one lattice.
#[derive(Clone, Debug)]
pub(in crate::planners) struct Blocks {
    /// The least coordinates of its cells along x, y and z, in cells: the lowest corner of the lattice of blocks.
    pub(in crate::planners) origin: Site,
    /// The sites of the blocks, in blocks from the origin.
    pub(in crate::planners) sites: BTreeSet<Site>,
}

/// The number of cells in a block.
const CELLS: usize = 8;

/// Returns the blocks that a shape consists of; `cells` are the lattice sites of its cells, all different.
///
/// # Errors
/// A cell of a block that is not whole.
pub(in crate::planners) fn blocks_of(cells: &[Site]) -> Result<Blocks, Site> {
    let origin = [0, 1, 2].map(|axis| cells.iter().map(|cell| cell[axis]).min().unwrap_or(0));
    let mut found: BTreeMap<Site, (usize, Site)> = BTreeMap::new();
    for cell in cells {
        let site = [0, 1, 2].map(|axis| (cell[axis] - origin[axis]).div_euclid(2));
        found.entry(site).or_insert((0, *cell)).0 += 1;
    }
    match found.values().find(|(count, _)| *count != CELLS) {
        Some((_, cell)) => Err(*cell),
        None => Ok(Blocks { origin, sites: found.into_keys().collect() }),
    }
}

impl Blocks {
    /// Returns the site of the cell at a place in a block, given by 0 or 1 along x, y and z.
    pub(super) fn cell(&self, block: Site, place: Site) -> Site {
        [0, 1, 2].map(|axis| self.origin[axis] + 2 * block[axis] + place[axis])
    }

    /// Returns the site of the block that a cell's site is in.
    pub(super) fn block(&self, cell: Site) -> Site {
        [0, 1, 2].map(|axis| (cell[axis] - self.origin[axis]).div_euclid(2))
    }
}
