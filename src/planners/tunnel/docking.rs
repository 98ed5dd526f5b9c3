//! The docked contacts of a stage, and if they hold the robot together.

use super::{CellBox, Site, WHOLE};

/// Returns true if the docked contacts that last from one configuration to the next, the boxes of all cells by number,
/// join all cells: along one axis two faces meet, and along the two others the middles of the cells are the same.
pub(super) fn holds(before: &[CellBox], after: &[CellBox]) -> bool {
    let key = |cell: &CellBox| cell.center.map(|x| x.div_euclid(WHOLE));
    let mut order: Vec<(Site, usize)> = before.iter().map(key).zip(0..).collect();
    order.sort_unstable();
    let mut groups = Groups { above: (0..before.len()).collect(), left: before.len() };
    for &(site, cell) in &order {
        // Cells in contact have centres at most a cell apart; the other of the pair finds those below.
        for axis in 0..3 {
            for steps in 0..2 {
                let mut near = site;
                near[axis] += steps;
                let first = order.partition_point(|&(other, _)| other < near);
                for &(_, other) in order[first..].iter().take_while(|&&(other, _)| other == near) {
                    let docked = |cells: &[CellBox]| docked(&cells[cell], &cells[other], axis);
                    if docked(before) && docked(after) {
                        groups.join(cell, other);
                    }
                }
            }
        }
    }
    groups.left <= 1
}

/// Returns true if the upper face of a cell along an axis meets the lower one of another, middle on middle.
fn docked(low: &CellBox, high: &CellBox, axis: usize) -> bool {
    let meet = 2 * (high.center[axis] - low.center[axis]) == low.size[axis] + high.size[axis];
    meet && (0..3).all(|other| other == axis || low.center[other] == high.center[other])
}

/// Groups of cells that are joined, by union and find.
struct Groups {
    above: Vec<usize>,
    /// The number of groups.
    left: usize,
}

impl Groups {
    fn root(&mut self, cell: usize) -> usize {
        let mut at = cell;
        while self.above[at] != at {
            self.above[at] = self.above[self.above[at]];
            at = self.above[at];
        }
        at
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.above[a.max(b)] = a.min(b);
            self.left -= 1;
        }
    }
}
