//! The way of one cell from a block to an empty site: all cells on it move on by one site.
//!
//! The way has legs, straight lines of sites between bends. On a leg the last three cells contract about the middle of
//! the last one, at the bend, which is docked to cells beside the way and stays; so the third from the end gets to the middle of the next
//! site, where it is docked to cells beside the way in its turn. The cell at the bend, half as long as before, moves on
//! with the next leg. Then the others expand about the middle of the one that is docked now, and the leg has moved on by one
//! site. At the end, where the last leg leads into an empty site, the first two cells of it contract about the middle of
//! the second, and give way to the cell that follows at the bend, half as wide, about whose middle they then expand.

use super::blocks::Blocks;
use super::{CellBox, HALF, Site, WHOLE, moved};
use std::collections::BTreeMap;

/// The cells on one way, with what they do.
pub(super) struct Thread {
    /// The cells from the block on, in the order of their sites.
    pub(super) cells: Vec<usize>,
    /// The sites of the cells, and the empty site at the end.
    pub(super) sites: Vec<Site>,
    /// The cells that change in each stage, with their boxes at its end.
    pub(super) stages: Vec<Vec<(usize, CellBox)>>,
}

/// A straight line of blocks or of sites, from the first to the last.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Leg {
    axis: usize,
    sign: i64,
    first: Site,
    last: Site,
}

impl Leg {
    /// Returns the line between two sites that differ along one axis.
    fn between(first: Site, last: Site) -> Leg {
        let axis = (0..3).find(|&axis| first[axis] != last[axis]).unwrap_or(0);
        Leg { axis, sign: (last[axis] - first[axis]).signum(), first, last }
    }

    /// Returns the number of steps from the first site to the last.
    fn steps(&self) -> usize {
        (self.last[self.axis] - self.first[self.axis]).unsigned_abs() as usize
    }
}

/// Returns the legs of a way over sites that are each beside the one before.
fn legs(sites: &[Site]) -> Vec<Leg> {
    let mut found: Vec<Leg> = Vec::new();
    for pair in sites.windows(2) {
        let step = Leg::between(pair[0], pair[1]);
        match found.last_mut() {
            Some(leg) if (leg.axis, leg.sign) == (step.axis, step.sign) => leg.last = pair[1],
            _ => found.push(step),
        }
    }
    found
}

/// Returns 0 or 1 for the place in a block that comes first (`ahead` 0) or second (1) in the direction of a leg.
fn place_along(leg: &Leg, ahead: i64) -> i64 {
    if leg.sign > 0 { ahead } else { 1 - ahead }
}

/// Returns the places, 0 or 1 along x, y and z, of the cells of a route's first block, in the order in which they leave:
/// those in front of others, seen from the route, last; and so that the sites of the last block are filled from there on.
pub(super) fn order(route: &[Site]) -> Vec<Site> {
    let legs = legs(route);
    let (Some(first), Some(last)) = (legs.first(), legs.last()) else { return vec![] };
    let rank = |place: &Site| {
        let ahead = |leg: &Leg| place_along(leg, place[leg.axis]);
        (ahead(first), ahead(last))
    };
    let mut places: Vec<Site> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2]).collect();
    places.sort_by_key(|place| (rank(place), *place));
    places
}

/// Returns the way along a route of blocks of the cell that is at a place (0 or 1 along x, y and z) in the first block;
/// the last block of the route is not there yet. `at` gives the cells that fill sites. `None` if another cell has to go
/// first.
pub(super) fn thread(
    blocks: &Blocks,
    at: &BTreeMap<Site, usize>,
    route: &[Site],
    place: Site,
) -> Option<Thread> {
    let corners = corners(blocks, at, route, place)?;
    let legs: Vec<Leg> = corners.windows(2).map(|pair| Leg::between(pair[0], pair[1])).collect();
    let mut sites = vec![corners[0]];
    let mut lines = Vec::with_capacity(legs.len());
    for leg in &legs {
        let from = sites.len() - 1;
        sites.extend((1..=leg.steps() as i64).map(|step| moved(leg.first, leg.axis, step * leg.sign)));
        lines.push(from..sites.len());
    }
    let cells: Vec<usize> =
        sites[..sites.len() - 1].iter().map(|site| at.get(site).copied()).collect::<Option<_>>()?;
    let boxes = sites.iter().map(|site| CellBox::whole(*site)).collect();
    let mut chain = Chain { boxes, changed: vec![] };
    // Of a line that ends at a bend the cell there is the first of the next line.
    let lines: Vec<Line> = legs
        .iter()
        .zip(lines)
        .map(|(leg, range)| Line { leg: *leg, at: range.start, end: range.end - 1 })
        .collect();
    let stages = match &lines[..] {
        [line] => straight(line, &mut chain, place),
        _ => bent(&lines, &mut chain)?,
    };
    let stages = stages
        .into_iter()
        .map(|changes| changes.into_iter().map(|(index, to)| (cells[index], to)).collect())
        .collect();
    Some(Thread { cells, sites, stages })
}

/// Returns the sites at the start of the way, at its bends and at its end; `None` if another cell has to go first.
fn corners(blocks: &Blocks, at: &BTreeMap<Site, usize>, route: &[Site], place: Site) -> Option<Vec<Site>> {
    let legs = legs(route);
    let (first, last) = (legs.first()?, legs.last()?);
    let start = blocks.cell(first.first, place);
    if place_along(first, place[first.axis]) == 1 && at.contains_key(&moved(start, first.axis, -first.sign)) {
        return None;
    }
    // Between a first and a last leg that lead there and back, the bends are at the far end of the first.
    let mut inner = place;
    if legs.len() > 1 && first.axis == last.axis && first.sign != last.sign {
        inner[first.axis] = place_along(first, 1);
    }
    let mut corners = vec![start];
    corners.extend(legs[1..].iter().map(|leg| blocks.cell(leg.first, inner)));
    let mut end = inner;
    end[last.axis] = place_along(last, 0);
    if at.contains_key(&blocks.cell(last.last, end)) {
        end[last.axis] = place_along(last, 1);
    }
    corners.push(blocks.cell(last.last, end));
    Some(corners)
}

/// The cells of a leg: those from index `at` of the way to before `end`, the index of the site at which the leg ends.
struct Line {
    leg: Leg,
    at: usize,
    end: usize,
}

/// The boxes of the cells on a way by index, and what changes of them in a stage.
struct Chain {
    boxes: Vec<CellBox>,
    changed: Vec<usize>,
}

impl Chain {
    /// Puts the cell of an index of a line at a distance along it, in quarters from the first site, with this length.
    fn put(&mut self, line: &Line, index: usize, along: usize, length: i64) {
        let axis = line.leg.axis;
        let first = WHOLE * line.leg.first[axis] + WHOLE / 2;
        self.boxes[line.at + index].center[axis] = first + line.leg.sign * along as i64;
        self.widen(line.at + index, axis, length);
    }

    /// Gives the cell of an index of the way a length along an axis, about its middle.
    fn widen(&mut self, index: usize, axis: usize, length: i64) {
        self.boxes[index].size[axis] = length;
        self.changed.push(index);
    }

    /// Ends a stage and returns what has changed.
    fn stage(&mut self) -> Vec<(usize, CellBox)> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        changed.into_iter().map(|index| (index, self.boxes[index])).collect()
    }

    /// Contracts the cell of an index of a line, which stays, and the two before it; those behind follow.
    fn contract_to(&mut self, line: &Line, index: usize) {
        self.put(line, index, 4 * index, HALF);
        self.put(line, index - 1, 4 * index - 2, HALF);
        self.put(line, index - 2, 4 * index - 4, HALF);
        (0..index - 2).for_each(|behind| self.put(line, behind, 4 * behind + 5, WHOLE));
    }

    /// Expands the first `count` cells of a line, each to the site ahead of its own.
    fn expand(&mut self, line: &Line, count: usize) {
        (0..count).for_each(|index| self.put(line, index, 4 * (index + 1), WHOLE));
    }
}

/// Returns the stages of a way without bends; `place`: that of its first cell in the block that it leaves.
fn straight(line: &Line, chain: &mut Chain, place: Site) -> Vec<Vec<(usize, CellBox)>> {
    let count = line.end - line.at;
    // The second site of the block behind the first.
    let last = 3 - place_along(&line.leg, place[line.leg.axis]) as usize;
    chain.contract_to(line, last);
    (last + 1..count).for_each(|ahead| chain.put(line, ahead, 4 * ahead - 1, WHOLE));
    let contracted = chain.stage();
    chain.expand(line, count);
    vec![contracted, chain.stage()]
}

/// Returns the stages of a way with bends; `None` if a leg has fewer than two cells.
fn bent(lines: &[Line], chain: &mut Chain) -> Option<Vec<Vec<(usize, CellBox)>>> {
    let steps = |line: &Line| line.end - line.at;
    if lines.iter().any(|line| steps(line) < 2) {
        return None;
    }
    let (last, before) = lines.split_last()?;
    // The cell that follows to the last bend.
    let follower = last.at - 1;
    let mut stages = Vec::with_capacity(before.len() + 3);
    for time in 0..before.len() + 3 {
        match before.get(time) {
            Some(line) => chain.contract_to(line, steps(line)),
            None if time == before.len() => {
                chain.put(last, 0, 2, HALF);
                chain.put(last, 1, 4, HALF);
                (2..steps(last)).for_each(|ahead| chain.put(last, ahead, 4 * ahead - 1, WHOLE));
                chain.widen(follower, last.leg.axis, HALF);
            }
            None if time == before.len() + 2 => {
                chain.expand(last, steps(last));
                chain.widen(follower, last.leg.axis, WHOLE);
            }
            None => {}
        }
        if let Some(line) = time.checked_sub(2).and_then(|earlier| before.get(earlier)) {
            chain.expand(line, steps(line));
            chain.widen(line.end, line.leg.axis, WHOLE);
        }
        stages.push(chain.stage());
    }
    Some(stages)
}
