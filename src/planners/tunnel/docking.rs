//! The docked contacts of a stage, and if they hold the robot together.

use super::{CellBox, Site, WHOLE, moved};
use crate::planners::disjoint_sets::DisjointSets;

/// The greatest number of sites of a table for each cell; in a larger bounding box cells are sorted.
const TABLE_MAX: i64 = 64;

/// The number that stands for no cell.
const NONE: u32 = u32::MAX;

/// Returns true if the docked contacts that last from one configuration to the next, the boxes of all cells by number,
/// join all cells: along one axis two faces meet, and along the two others the middles of the cells are the same.
pub(super) fn holds(before: &[CellBox], after: &[CellBox]) -> bool {
    let sites = SitedCells::of(before);
    let mut joined = DisjointSets::new(before.len());
    for cell in 0..before.len() {
        // Cells in contact have centres at most a cell apart; the other of the pair finds those below.
        for axis in 0..3 {
            for steps in 0..2 {
                sites.for_each_at(moved(site(&before[cell]), axis, steps), |other| {
                    let docked = |cells: &[CellBox]| docked(&cells[cell], &cells[other], axis);
                    if docked(before) && docked(after) {
                        joined.join(cell, other);
                    }
                });
            }
        }
    }
    joined.count() <= 1
}

/// Returns the lattice site that the middle of a cell is in.
fn site(cell: &CellBox) -> Site {
    cell.center.map(|x| x.div_euclid(WHOLE))
}

/// The cells of each site: as lists in a table over the bounding box, or sorted.
struct SitedCells {
    low: Site,
    sides: [i64; 3],
    /// The first cell of each site of the table; empty if the cells are sorted.
    first: Vec<u32>,
    /// The next cell of the site of each cell.
    next: Vec<u32>,
    sorted: Vec<(Site, u32)>,
}

impl SitedCells {
    fn of(cells: &[CellBox]) -> SitedCells {
        let bound = |axis: usize| {
            let along = || cells.iter().map(|cell| site(cell)[axis]);
            let low = along().min().unwrap_or(0);
            (low, along().max().unwrap_or(0) - low + 1)
        };
        let bounds = [0, 1, 2].map(bound);
        let (low, sides) = (bounds.map(|(low, _)| low), bounds.map(|(_, side)| side));
        let mut sited = SitedCells { low, sides, first: vec![], next: vec![], sorted: vec![] };
        let volume = sides.iter().try_fold(1_i64, |volume, side| volume.checked_mul(*side));
        if let Some(volume) = volume.filter(|volume| *volume <= TABLE_MAX * cells.len() as i64) {
            sited.first = vec![NONE; volume as usize];
            for (number, cell) in (0..).zip(cells) {
                let index = sited.index(site(cell)).expect("it is within the bounding box");
                sited.next.push(std::mem::replace(&mut sited.first[index], number));
            }
        } else {
            sited.sorted = cells.iter().map(site).zip(0..).collect();
            sited.sorted.sort_unstable();
        }
        sited
    }

    /// Returns the index of a site in the table; `None` outside of the bounding box.
    fn index(&self, site: Site) -> Option<usize> {
        let [x, y, z] = [0, 1, 2].map(|axis| site[axis] - self.low[axis]);
        let inside = [x, y, z].iter().zip(self.sides).all(|(at, side)| (0..side).contains(at));
        inside.then_some(((x * self.sides[1] + y) * self.sides[2] + z) as usize)
    }

    /// Calls `visit` with the number of every cell of a site.
    fn for_each_at(&self, site: Site, mut visit: impl FnMut(usize)) {
        if self.sorted.is_empty() {
            let mut at = self.index(site).map_or(NONE, |index| self.first[index]);
            while at != NONE {
                visit(at as usize);
                at = self.next[at as usize];
            }
            return;
        }
        let first = self.sorted.partition_point(|&(other, _)| other < site);
        self.sorted[first..]
            .iter()
            .take_while(|(other, _)| *other == site)
            .for_each(|(_, at)| visit(*at as usize));
    }
}

/// Returns true if the upper face of a cell along an axis meets the lower one of another, middle on middle.
fn docked(low: &CellBox, high: &CellBox, axis: usize) -> bool {
    let meet = 2 * (high.center[axis] - low.center[axis]) == low.size[axis] + high.size[axis];
    meet && (0..3).all(|other| other == axis || low.center[other] == high.center[other])
}
