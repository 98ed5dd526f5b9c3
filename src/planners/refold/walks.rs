//! Walks of single panels from one sheet to another in the plane, where best-first search finds no short series of strokes.
//!
//! A panel that hangs on one other alone walks along the outline of the rest, by strokes about corners at which two to four of
//! the others follow each other. It does not get around the tip of a panel that stands alone; but panels are alike, so that
//! panel may go on in its stead, and its place is free for the next. Breadth-first search over the places that are free finds the
//! fewest panels that hand on a free place to one that is too many. When all cells are covered, connections change one by one.

use super::lattice_sheet::{Corners, LatticeSheet, Point, Side, Stroke, bond, cell, turned};
use super::rearrangement::{Goal, PanelSolids, pair};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// The greatest number of hops whose strokes collide, and which are left out from then on, before a search is given up.
const BARRED_MAX: usize = 60;
/// The fewest and the most panels about a corner around which another goes.
const ARC: std::ops::RangeInclusive<usize> = 2..=4;

/// A hop of a panel about a corner of its cell: from a place, to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Hop {
    from: Corners,
    to: Corners,
    about: Point,
    /// True if it goes counterclockwise.
    ahead: bool,
    /// The number of panels that it goes around.
    count: usize,
}

/// Returns fewer than `most` strokes that take the sheet `start` to `goal` by walks of single panels, and the sheet after
/// them; `None` if none were found. No sample of them shows a collision of `panels`. `left`: the number of cells that may still be
/// examined, for each panel that may go all others.
pub fn walked(
    start: &LatticeSheet,
    goal: &Goal,
    panels: PanelSolids,
    most: usize,
    left: &mut usize,
) -> Option<(Vec<Stroke>, LatticeSheet)> {
    let mut walk = Walk { sheet: start.clone(), goal, panels, strokes: Vec::new(), barred: BTreeSet::new() };
    while !walk.is_covered() {
        let moves = walk.holes().find_map(|hole| walk.handed_on(hole, left))?;
        // The first that can't be made bars a hop, and others are found from there.
        let barred = walk.barred.len();
        let made = moves.iter().all(|[from, to]| walk.goes(*from, *to));
        let is_stuck = walk.barred.len() == barred || barred >= BARRED_MAX;
        if (!made && is_stuck) || walk.strokes.len() >= most {
            return None;
        }
    }
    walk.connect();
    (walk.strokes.len() < most).then_some((walk.strokes, walk.sheet))
}

/// A sheet on its way to another.
struct Walk<'g> {
    sheet: LatticeSheet,
    goal: &'g Goal,
    panels: PanelSolids<'g>,
    strokes: Vec<Stroke>,
    /// The hops that collide.
    barred: BTreeSet<Hop>,
}

/// A place that is free: how a panel handed it on, after which others may go on.
struct Free {
    hole: Point,
    covered: BTreeMap<Point, Corners>,
    /// The index of the place that was free before, and the panel's way there, from cell to cell.
    before: Option<(usize, [Point; 2])>,
}

impl Walk<'_> {
    /// Returns true if the sheet covers all cells that are wanted.
    fn is_covered(&self) -> bool {
        self.holes().next().is_none()
    }

    /// Returns the cells that are wanted and free.
    fn holes(&self) -> impl Iterator<Item = Point> + '_ {
        self.goal.cells.iter().filter(|cell| !self.sheet.cells.contains_key(*cell)).copied()
    }

    /// Returns the fewest moves of panels, each from a cell to one that is free then, after which a place is free that no panel
    /// is wanted on instead of `hole`; `None` if there are none, or nothing is left of the cells that may be examined.
    fn handed_on(&self, hole: Point, left: &mut usize) -> Option<Vec<[Point; 2]>> {
        let covered = self.sheet.corners.iter().map(|corners| (cell(corners), *corners)).collect();
        let mut places = vec![Free { hole, covered, before: None }];
        let mut known = BTreeSet::from([hole]);
        let mut next = 0;
        while let Some(Free { hole, covered, .. }) = places.get(next) {
            crate::interrupt::checkpoint();
            let mut found = Vec::new();
            for (&from, corners) in covered.iter().filter(|(from, _)| !known.contains(*from)) {
                *left = left.checked_sub(covered.len())?;
                let rest: BTreeSet<Point> = covered.keys().filter(|cell| **cell != from).copied().collect();
                if !is_connected(&rest) {
                    continue;
                }
                if let Some(hops) = self.hops(corners, &rest, *hole) {
                    let mut covered = covered.clone();
                    covered.remove(&from);
                    covered.insert(*hole, hops.last().map_or(*corners, |hop| hop.to));
                    found.push(Free { hole: from, covered, before: Some((next, [from, *hole])) });
                }
            }
            for place in found {
                known.insert(place.hole);
                let is_end = !self.goal.cells.contains(&place.hole);
                places.push(place);
                if is_end {
                    return Some(moves(&places));
                }
            }
            next += 1;
        }
        None
    }

    /// Returns the fewest hops of a panel with these corners to a cell, around the panels on the cells `rest`; `None` if it does
    /// not get there.
    fn hops(&self, corners: &Corners, rest: &BTreeSet<Point>, to: Point) -> Option<Vec<Hop>> {
        let mut before: BTreeMap<Point, Option<Hop>> = BTreeMap::from([(cell(corners), None)]);
        let mut queue = VecDeque::from([*corners]);
        while let Some(at) = queue.pop_front() {
            if cell(&at) == to {
                let mut hops = Vec::new();
                let mut at = to;
                while let Some(Some(hop)) = before.get(&at) {
                    hops.push(*hop);
                    at = cell(&hop.from);
                }
                hops.reverse();
                return Some(hops);
            }
            for hop in hops_from(&at, rest).filter(|hop| !self.barred.contains(hop)) {
                before.entry(cell(&hop.to)).or_insert_with(|| {
                    queue.push_back(hop.to);
                    Some(hop)
                });
            }
        }
        None
    }

    /// Takes the panel on a cell to another cell, alone; false, and it is somewhere on the way, if a hop collides, which is
    /// barred then.
    fn goes(&mut self, from: Point, to: Point) -> bool {
        let Some(&panel) = self.sheet.cells.get(&from) else { return false };
        let rest: BTreeSet<Point> = self.sheet.cells.keys().filter(|cell| **cell != from).copied().collect();
        let Some(hops) = self.hops(&self.sheet.corners[panel], &rest, to) else { return false };
        hops.iter().all(|hop| {
            let made = self.hop(panel, hop);
            if !made {
                self.barred.insert(*hop);
            }
            made
        })
    }

    /// Takes a panel around a corner, joined as it has to be; false if the stroke collides.
    fn hop(&mut self, panel: usize, hop: &Hop) -> bool {
        let arc: Vec<usize> = (1..=hop.count)
            .map(|k| if hop.ahead { k } else { 6 - k })
            .map(|sixths| self.sheet.cells[&cell(&hop.from.map(|point| turned(point, hop.about, sixths)))])
            .collect();
        self.hang(panel, arc[0]);
        for two in arc.windows(2) {
            self.join(two[0], two[1], &arc);
        }
        let corner = |panel: usize| {
            let corner = self.sheet.corners[panel].iter().position(|point| *point == hop.about);
            (panel, corner.expect("it is about its corner"))
        };
        let mut fan: Vec<(usize, usize)> = std::iter::once(panel).chain(arc).map(corner).collect();
        if !hop.ahead {
            fan.reverse();
        }
        let Some(stroke) = self.sheet.walk(&fan, panel) else { return false };
        let PanelSolids { solids, side } = self.panels;
        let other = Stroke { angle: -stroke.angle, ..stroke.clone() };
        let Some(stroke) = [stroke, other].into_iter().find(|s| self.sheet.is_free(s, solids, side)) else {
            return false;
        };
        self.apply(stroke);
        true
    }

    /// Joins a panel to one beside it and to no other; the others stay in one piece.
    fn hang(&mut self, panel: usize, on: usize) {
        let own: Vec<[Side; 2]> = self.sheet.joined(panel).map(|(own, other)| bond(own, other)).collect();
        if let Some(make) = self.bond_between(panel, on)
            && !own.contains(&make)
        {
            let cut = self.sheet.path(on, panel).into_iter().find(|bond| own.contains(bond));
            self.change(make, cut.expect("the path ends with a connection of the panel"));
        }
        let others: Vec<[Side; 2]> = self.sheet.joined(panel).map(|(own, other)| bond(own, other)).collect();
        for cut in others.into_iter().filter(|bond| bond.iter().all(|side| side.0 != on)) {
            let end = cut.iter().find(|side| side.0 != panel).expect("a connection joins two").0;
            let part = self.sheet.part(end, &cut);
            let is_between = |make: &[Side; 2]| {
                make.iter().all(|side| side.0 != panel)
                    && make.iter().filter(|side| part.contains(&side.0)).count() == 1
            };
            let open: Vec<[Side; 2]> = self.sheet.open().into_iter().filter(is_between).collect();
            let wanted = open.iter().find(|make| self.is_wanted(make)).or(open.first()).copied();
            if let Some(make) = wanted {
                self.change(make, cut);
            }
        }
    }

    /// Joins two panels that lie side by side, and undoes a connection that is neither between panels of the arc nor wanted, if
    /// there is one.
    fn join(&mut self, a: usize, b: usize, arc: &[usize]) {
        let Some(make) = self.bond_between(a, b) else { return };
        if self.sheet.bonds.contains(&make) {
            return;
        }
        let worth = |bond: &[Side; 2]| {
            let is_needed = bond.iter().all(|side| arc.contains(&side.0));
            if is_needed { 2 } else { usize::from(self.is_wanted(bond)) }
        };
        let stroke = self.sheet.change(make, worth);
        self.apply(stroke);
    }

    /// Makes the connections that are wanted, once all cells are covered.
    fn connect(&mut self) {
        while let Some(make) = self.sheet.open().into_iter().find(|make| self.is_wanted(make)) {
            let stroke = self.sheet.change(make, |bond| usize::from(self.is_wanted(bond)));
            self.apply(stroke);
        }
    }

    /// Returns true if the goal has a connection.
    fn is_wanted(&self, bond: &[Side; 2]) -> bool {
        let [a, b] = bond.map(|side| cell(&self.sheet.corners[side.0]));
        self.goal.bonds.contains(&pair(a, b))
    }

    /// Returns the connection that two panels side by side would have; `None` if they are not.
    fn bond_between(&self, a: usize, b: usize) -> Option<[Side; 2]> {
        let sides = (0..3).map(|side| (a, side));
        sides
            .filter_map(|own| Some(bond(own, self.sheet.beside(own)?)))
            .find(|bond| bond.iter().any(|s| s.0 == b))
    }

    /// Changes a connection without any motion.
    fn change(&mut self, make: [Side; 2], cut: [Side; 2]) {
        self.apply(Stroke { fold: Vec::new(), angle: 0.0, make, cut, moved: Vec::new() });
    }

    fn apply(&mut self, stroke: Stroke) {
        self.sheet.apply(&stroke);
        self.strokes.push(stroke);
    }
}

/// Returns the moves that lead to the last place.
fn moves(places: &[Free]) -> Vec<[Point; 2]> {
    let mut moves = Vec::new();
    let mut at = places.len() - 1;
    while let Some((before, way)) = places[at].before {
        moves.push(way);
        at = before;
    }
    moves.reverse();
    moves
}

/// Returns the hops of a panel with these corners around panels on the cells `rest`.
fn hops_from<'r>(corners: &Corners, rest: &'r BTreeSet<Point>) -> impl Iterator<Item = Hop> + use<'r> {
    let from = *corners;
    let about = from.into_iter().flat_map(|about| [(about, true), (about, false)]);
    about.filter_map(move |(about, ahead)| {
        let place = |k: usize| from.map(|p| turned(p, about, if ahead { k } else { 6 - k }));
        let count = (1..6).take_while(|k| rest.contains(&cell(&place(*k)))).count();
        ARC.contains(&count).then(|| Hop { from, to: place(count + 1), about, ahead, count })
    })
}

/// Returns true if cells hang together over their sides.
fn is_connected(cells: &BTreeSet<Point>) -> bool {
    let Some(&first) = cells.first() else { return true };
    let (mut found, mut open) = (BTreeSet::from([first]), vec![first]);
    while let Some(at) = open.pop() {
        for next in neighbours(at) {
            if cells.contains(&next) && found.insert(next) {
                open.push(next);
            }
        }
    }
    found.len() == cells.len()
}

/// Returns the names of the three cells beside a cell.
fn neighbours(cell: Point) -> [Point; 3] {
    // The sum of the corners of a cell that points up is one more than a multiple of three, of one that points down two more.
    let by = if cell[0].rem_euclid(3) == 1 { 1 } else { -1 };
    [[by, by], [by, -2 * by], [-2 * by, by]].map(|[i, j]| [cell[0] + i, cell[1] + j])
}
