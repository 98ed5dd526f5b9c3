//! The state of a robot between two stages: which cells are in which site of the lattice.

use super::grid::{Direction, Grid, axis_of};

/// The number that stands for no cell.
const NONE: u32 = u32::MAX;

/// The axis that stands for none.
const NO_AXIS: u8 = 3;

/// A quarter of a cell's side, on the grid of quarters.
const QUARTER: i64 = 1;

/// Half of a cell's side.
const HALF: i64 = 2;

/// A cell's side.
const WHOLE: i64 = 4;

/// The cells of a robot by site. A site is empty, or holds one whole cell, or two that are each half as long along one
/// axis, the split; while these two turn their split to another axis they are half as long along both.
#[derive(Clone, Debug)]
pub(super) struct Boxes {
    /// The cells of each site: the only one, or the lower and the upper one along the split.
    cells: Vec<[u32; 2]>,
    /// The axis of the split of each site with two cells.
    split: Vec<u8>,
    /// The axis to which the split of a site turns, half way of the turn.
    turning: Vec<u8>,
}

impl Boxes {
    /// Returns whole cells, numbered in this order, at these sites of a grid of `sites` sites.
    pub(super) fn whole(sites: usize, filled: &[usize]) -> Boxes {
        let mut boxes = Boxes {
            cells: vec![[NONE; 2]; sites],
            split: vec![NO_AXIS; sites],
            turning: vec![NO_AXIS; sites],
        };
        filled.iter().enumerate().for_each(|(cell, &site)| boxes.cells[site][0] = cell as u32);
        boxes
    }

    /// Returns what the sites `filled` hold, which are all that hold cells.
    pub(super) fn snapshot(&self, filled: &[usize]) -> Snapshot {
        let content = |&site: &usize| (site, self.cells[site], self.split[site], self.turning[site]);
        Snapshot(filled.iter().map(content).collect())
    }

    /// Restores the state of a snapshot; `filled` are the sites that hold cells now.
    pub(super) fn restore(&mut self, snapshot: &Snapshot, filled: &[usize]) {
        for &site in filled {
            (self.cells[site], self.split[site], self.turning[site]) = ([NONE; 2], NO_AXIS, NO_AXIS);
        }
        for &(site, cells, split, turning) in &snapshot.0 {
            (self.cells[site], self.split[site], self.turning[site]) = (cells, split, turning);
        }
    }

    /// Returns true if a site holds a cell.
    pub(super) fn is_filled(&self, site: usize) -> bool {
        self.cells[site][0] != NONE
    }

    /// Returns true if a site holds two cells.
    pub(super) fn is_double(&self, site: usize) -> bool {
        self.cells[site][1] != NONE
    }

    /// Returns true if a site holds exactly one cell.
    pub(super) fn is_single(&self, site: usize) -> bool {
        self.is_filled(site) && !self.is_double(site)
    }

    /// Returns true if a site holds two cells, one behind the other along this direction.
    pub(super) fn is_split_along(&self, site: usize, direction: Direction) -> bool {
        self.is_double(site) && self.split[site] == axis_of(direction)
    }

    /// Returns the axis to which the two cells of a site are turning their split, half way of the turn.
    pub(super) fn turning(&self, site: usize) -> Option<u8> {
        (self.turning[site] != NO_AXIS).then_some(self.turning[site])
    }

    /// Returns the axis along which the two cells of a site move in the half of a turn that comes next, for a turn to
    /// the axis `to`: along that first, and then away from their old split.
    pub(super) fn moves_along(&self, site: usize, to: u8) -> u8 {
        if self.turning[site] == NO_AXIS { to } else { self.split[site] }
    }

    /// Does half of a turn of the split of a site with two cells to an axis: the first half, or the second if the first
    /// is done.
    pub(super) fn turn(&mut self, site: usize, axis: u8) {
        if self.turning[site] == NO_AXIS {
            self.turning[site] = axis;
        } else {
            (self.split[site], self.turning[site]) = (axis, NO_AXIS);
        }
    }

    /// Moves a line of cells on by one cell: from the site `from` to the site `to`, which differ along `direction`; all
    /// sites between hold one cell each. A single cell at `from` leaves it empty, of two cells there one stays; an empty
    /// site `to` gets a whole cell, a filled one gets a second.
    pub(super) fn advance(&mut self, grid: &Grid, from: usize, to: usize, direction: Direction) {
        let forward = direction.is_multiple_of(2);
        let (stays, joins) = (self.is_double(from), self.is_filled(to));
        // The cells of the line from its back to its front.
        let mut line = Vec::new();
        let mut site = from;
        loop {
            let [first, second] = std::mem::replace(&mut self.cells[site], [NONE; 2]);
            let ordered = if forward { [first, second] } else { [second, first] };
            line.extend(ordered.into_iter().filter(|cell| *cell != NONE));
            if site == to {
                break;
            }
            site = grid.next(site, direction);
        }
        self.split[from] = NO_AXIS;
        let mut site = if stays { from } else { grid.next(from, direction) };
        let mut line = line.into_iter();
        for cell in line.by_ref() {
            self.cells[site][0] = cell;
            if site == to {
                break;
            }
            site = grid.next(site, direction);
        }
        if let (true, Some(front)) = (joins, line.next()) {
            let back = self.cells[to][0];
            self.cells[to] = if forward { [back, front] } else { [front, back] };
            self.split[to] = axis_of(direction);
        }
    }
}

/// The cells of a robot by site, as a list of the sites that hold any.
#[derive(Clone, Debug)]
pub(super) struct Snapshot(Vec<(usize, [u32; 2], u8, u8)>);

/// The place of a cell, in quarters of its full side: its centre and its sides along x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Placed {
    /// The centre; a whole cell at the site 0 has it at 2.
    pub(crate) center: [i64; 3],
    /// The sides, 4 for a whole cell.
    pub(crate) size: [i64; 3],
}

impl Snapshot {
    /// Returns the places of all cells by number, of `count` cells.
    pub(super) fn places(&self, grid: &Grid, count: usize) -> Vec<Placed> {
        let whole =
            |site: usize| Placed { center: grid.place(site).map(|x| WHOLE * x + HALF), size: [WHOLE; 3] };
        let mut places = vec![Placed { center: [HALF; 3], size: [WHOLE; 3] }; count];
        for &(site, cells, split, turning) in &self.0 {
            if cells[1] == NONE {
                places[cells[0] as usize] = whole(site);
                continue;
            }
            for (cell, side) in cells.into_iter().zip([-QUARTER, QUARTER]) {
                let mut placed = whole(site);
                for axis in [split, turning] {
                    if axis != NO_AXIS {
                        placed.center[usize::from(axis)] += side;
                        placed.size[usize::from(axis)] = HALF;
                    }
                }
                places[cell as usize] = placed;
            }
        }
        places
    }
}
