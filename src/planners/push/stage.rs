//! One stage under construction: lines of cells that move on by one cell, boxes whose split turns, and whether the
//! robot hangs together meanwhile.

use super::boxes::Boxes;
use super::grid::{DIRECTIONS, Direction, Grid, axis_of, opposite};

/// The motion of the cells of a site in a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// They rest.
    Still,
    /// They move on by one cell in a direction.
    Moves(Direction),
    /// They make room for one more, or one of two leaves: the site stays full.
    Changes,
    /// Two cells turn their split; they move along this axis.
    Turns(u8),
}

/// A line of cells that moves on by one cell, from the site `from` to the site `to`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The site behind which nothing moves; it holds the last cell of the line.
    pub(super) from: usize,
    /// The site that the first cell of the line moves into.
    pub(super) to: usize,
    /// The direction of the motion.
    pub(super) direction: Direction,
    /// True if `from` holds two cells, of which one stays.
    stays: bool,
    /// True if `to` is filled, so that it holds two cells at the end.
    joins: bool,
}

impl Line {
    /// Returns true if the sites of the line, its ends among them, have a neighbour across it among the sites between
    /// two that differ along the line's axis only, or are the same.
    fn is_beside(&self, grid: &Grid, first: usize, last: usize) -> bool {
        let axis = usize::from(axis_of(self.direction));
        let ends = [self.from, self.to, first, last].map(|site| grid.place(site));
        let across: i64 = (0..3).filter(|&k| k != axis).map(|k| (ends[0][k] - ends[2][k]).abs()).sum();
        let span = |a: i64, b: i64| (a.min(b), a.max(b));
        let (own, other) = (span(ends[0][axis], ends[1][axis]), span(ends[2][axis], ends[3][axis]));
        across == 1 && own.0 <= other.1 && other.0 <= own.1
    }
}

/// A stage under construction on the state of a robot.
#[derive(Debug)]
pub(super) struct Stage {
    roles: Vec<Role>,
    /// True for sites that a line moves into, and for those of obstacles.
    claimed: Vec<bool>,
    /// True for sites whose cells stand fast.
    fixed: Vec<bool>,
    /// The sites that hold cells at the start of the stage, in ascending order.
    filled: Vec<usize>,
    /// The lines of the stage.
    pub(super) lines: Vec<Line>,
    /// The sites whose split makes half of a turn, each with the axis that it turns to.
    pub(super) turns: Vec<(usize, u8)>,
    /// The position in `filled`, or in the list of sites at rest, of each site, from 1; 0 for none.
    slots: Vec<u32>,
    /// Union and find over `slots`.
    above: Vec<u32>,
    /// The number of visits of sites so far: the measure of work.
    pub(super) work: u64,
}

impl Stage {
    /// Returns a stage in which nothing moves.
    pub(super) fn new(sites: usize) -> Stage {
        Stage {
            roles: vec![Role::Still; sites],
            claimed: vec![false; sites],
            fixed: vec![false; sites],
            filled: vec![],
            lines: vec![],
            turns: vec![],
            slots: vec![0; sites],
            above: vec![],
            work: 0,
        }
    }

    /// Binds all stages: the cells of `fixed` sites stand fast, and those of `obstacles` stay empty.
    pub(super) fn bind(
        &mut self,
        fixed: impl Iterator<Item = usize>,
        obstacles: impl Iterator<Item = usize>,
    ) {
        fixed.for_each(|site| self.fixed[site] = true);
        obstacles.for_each(|site| self.claimed[site] = true);
    }

    /// Begins a stage at the state `boxes`: turns that are half done are finished.
    pub(super) fn begin(&mut self, boxes: &Boxes) {
        for line in self.lines.drain(..) {
            self.claimed[line.to] = false;
        }
        self.roles.fill(Role::Still);
        self.turns.clear();
        self.filled.clear();
        self.filled.extend((0..self.roles.len()).filter(|&site| boxes.is_filled(site)));
        self.work += self.roles.len() as u64;
        for &site in &self.filled {
            if let Some(axis) = boxes.turning(site) {
                self.roles[site] = Role::Turns(boxes.moves_along(site, axis));
                self.turns.push((site, axis));
            }
        }
    }

    /// Returns the sites that hold cells at the start of the stage, in ascending order.
    pub(super) fn filled(&self) -> &[usize] {
        &self.filled
    }

    /// Returns true if nothing moves in the stage.
    pub(super) fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.turns.is_empty()
    }

    /// Returns true if the cells of a site rest in the stage, so far, and do not stand fast.
    pub(super) fn is_still(&self, site: usize) -> bool {
        self.roles[site] == Role::Still && !self.fixed[site]
    }

    /// Returns true if a site holds one cell, which rests: a line may move through it.
    pub(super) fn is_passable(&self, boxes: &Boxes, site: usize) -> bool {
        self.is_still(site) && boxes.is_single(site)
    }

    /// Returns true if a line moves into a site, or if it is that of an obstacle.
    pub(super) fn is_claimed(&self, site: usize) -> bool {
        self.claimed[site]
    }

    /// Adds a line if it can move beside all that moves already and then at most `limit` pieces hang together by
    /// contacts that last the stage, and returns their number. With `firm`, the robot must hang together over faces at
    /// the end of the stage, too.
    pub(super) fn try_line(
        &mut self,
        (grid, boxes): (&Grid, &Boxes),
        (from, to, direction): (usize, usize, Direction),
        limit: usize,
        firm: bool,
    ) -> Option<usize> {
        let (stays, joins) = (boxes.is_double(from), boxes.is_filled(to));
        let free = !self.claimed[to]
            && self.is_still(from)
            && (!stays || boxes.is_split_along(from, direction))
            && (!joins || self.is_passable(boxes, to));
        if !free || !self.has_clear_way(grid, boxes, (from, to, direction)) {
            return None;
        }
        self.lines.push(Line { from, to, direction, stays, joins });
        self.mark(grid, self.lines[self.lines.len() - 1]);
        let pieces = self.pieces(grid, boxes);
        if pieces <= limit && (!firm || self.is_firm_after(grid)) {
            return Some(pieces);
        }
        if let Some(line) = self.lines.pop() {
            self.unmark(grid, line);
        }
        None
    }

    /// Adds half a turn of the split of a site with two cells to an axis if that leaves at most `limit` pieces, and
    /// returns their number.
    pub(super) fn try_turn(
        &mut self,
        (grid, boxes): (&Grid, &Boxes),
        (site, axis): (usize, u8),
        limit: usize,
    ) -> Option<usize> {
        // Two that turn side by side could touch by an edge only.
        let turns = |d: Direction| matches!(self.roles[grid.next(site, d)], Role::Turns(_));
        let along = boxes.moves_along(site, axis);
        // Past a line that moves along the same axis they would go too fast.
        let passed = |line: &Line| axis_of(line.direction) == along && line.is_beside(grid, site, site);
        if DIRECTIONS.into_iter().any(turns) || self.lines.iter().any(passed) {
            return None;
        }
        self.roles[site] = Role::Turns(along);
        let pieces = self.pieces(grid, boxes);
        if pieces > limit {
            self.roles[site] = Role::Still;
            return None;
        }
        self.turns.push((site, axis));
        Some(pieces)
    }

    /// Returns true if the cells between two sites rest and are single, and if nothing beside moves against them: cells in
    /// contact would pass each other faster than one cell in the time of a line.
    fn has_clear_way(
        &self,
        grid: &Grid,
        boxes: &Boxes,
        (from, to, direction): (usize, usize, Direction),
    ) -> bool {
        let axis = axis_of(direction);
        let against = |line: &Line| line.direction == opposite(direction) && line.is_beside(grid, from, to);
        if self.lines.iter().any(against) {
            return false;
        }
        let mut site = from;
        loop {
            if site != from && site != to && !self.is_passable(boxes, site) {
                return false;
            }
            let turns = |side: Direction| self.roles[grid.next(site, side)] == Role::Turns(axis);
            if DIRECTIONS.into_iter().any(|side| axis_of(side) != axis && turns(side)) {
                return false;
            }
            if site == to {
                return true;
            }
            site = grid.next(site, direction);
        }
    }

    fn mark(&mut self, grid: &Grid, line: Line) {
        self.claimed[line.to] = true;
        let mut site = line.from;
        while site != line.to {
            self.roles[site] = Role::Moves(line.direction);
            site = grid.next(site, line.direction);
        }
        if line.stays {
            self.roles[line.from] = Role::Changes;
        }
        if line.joins {
            self.roles[line.to] = Role::Changes;
        }
    }

    fn unmark(&mut self, grid: &Grid, line: Line) {
        self.claimed[line.to] = false;
        self.roles[line.to] = Role::Still;
        let mut site = line.from;
        while site != line.to {
            self.roles[site] = Role::Still;
            site = grid.next(site, line.direction);
        }
    }

    /// Returns the number of pieces that hang together over faces in contact during the whole stage. Contacts of which
    /// it is not certain are not counted.
    pub(super) fn pieces(&mut self, grid: &Grid, boxes: &Boxes) -> usize {
        self.work += self.filled.len() as u64;
        self.above.clear();
        self.above.extend(0..self.filled.len() as u32);
        let mut pieces = self.filled.len();
        let mut join = |a: u32, b: u32| pieces -= usize::from(united(&mut self.above, a, b));
        for (slot, &site) in self.filled.iter().enumerate() {
            self.slots[site] = slot as u32 + 1;
        }
        let (roles, slots) = (&self.roles, &self.slots);
        for &site in &self.filled {
            for direction in [0, 2, 4] {
                let other = grid.next(site, direction);
                if slots[other] > 0 && lasts(grid, boxes, roles, (site, other), axis_of(direction)) {
                    join(slots[site] - 1, slots[other] - 1);
                }
            }
        }
        for line in &self.lines {
            let first = grid.next(line.to, opposite(line.direction));
            let second = grid.next(line.from, line.direction);
            if line.stays && (second != line.to || line.joins) {
                join(slots[line.from] - 1, slots[second] - 1);
            }
            if line.joins {
                join(slots[first] - 1, slots[line.to] - 1);
                continue;
            }
            // The cell that moves into an empty site touches what rests beside it.
            for side in DIRECTIONS.into_iter().filter(|d| axis_of(*d) != axis_of(line.direction)) {
                let beside = grid.next(line.to, side);
                if slots[beside] > 0 && matches!(roles[beside], Role::Still | Role::Changes) {
                    join(slots[first] - 1, slots[beside] - 1);
                }
            }
        }
        for &site in &self.filled {
            self.slots[site] = 0;
        }
        pieces
    }

    /// Returns true if the robot hangs together over faces of its boxes once the stage has been made.
    fn is_firm_after(&mut self, grid: &Grid) -> bool {
        self.work += self.filled.len() as u64;
        let mut sites = self.filled.clone();
        for line in &self.lines {
            if !line.joins {
                sites.push(line.to);
            }
        }
        for (slot, &site) in sites.iter().enumerate() {
            self.slots[site] = slot as u32 + 1;
        }
        let mut pieces = sites.len();
        for line in self.lines.iter().filter(|line| !line.stays) {
            self.slots[line.from] = 0;
            pieces -= 1;
        }
        self.above.clear();
        self.above.extend(0..sites.len() as u32);
        for &site in sites.iter().filter(|site| self.slots[**site] > 0) {
            for direction in [0, 2, 4] {
                let other = self.slots[grid.next(site, direction)];
                if other > 0 && united(&mut self.above, self.slots[site] - 1, other - 1) {
                    pieces -= 1;
                }
            }
        }
        for site in sites {
            self.slots[site] = 0;
        }
        pieces == 1
    }
}

/// Returns true if the cells of two sites, neighbours along an axis, are certainly in contact over a face during the
/// whole stage.
fn lasts(grid: &Grid, boxes: &Boxes, roles: &[Role], (a, b): (usize, usize), axis: u8) -> bool {
    // A box that turns touches a cell that moves past it for sure if another follows that cell.
    let followed = |site: usize, direction: Direction| {
        let behind = grid.next(site, opposite(direction));
        boxes.is_filled(behind) && roles[behind] == Role::Moves(direction)
    };
    match (roles[a], roles[b]) {
        (Role::Moves(p), Role::Moves(q)) => {
            p == q || (axis_of(p) != axis && axis_of(q) != axis && axis_of(p) != axis_of(q))
        }
        (Role::Moves(p), other) => axis_of(p) != axis && (!matches!(other, Role::Turns(_)) || followed(a, p)),
        (other, Role::Moves(q)) => axis_of(q) != axis && (!matches!(other, Role::Turns(_)) || followed(b, q)),
        _ => true,
    }
}

/// Joins the trees of two slots; returns true if they were two.
fn united(above: &mut [u32], a: u32, b: u32) -> bool {
    let (a, b) = (root(above, a), root(above, b));
    above[a.max(b) as usize] = a.min(b);
    a != b
}

/// Returns the root of a slot in the forest of union and find.
fn root(above: &mut [u32], mut slot: u32) -> u32 {
    while above[slot as usize] != slot {
        above[slot as usize] = above[above[slot as usize] as usize];
        slot = above[slot as usize];
    }
    slot
}
