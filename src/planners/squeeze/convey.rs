//! One cell too many in a site, conveyed through the sites of a robot that floats to another, straight ahead in one
//! motion, around corners as a pair that spins.

use super::Refusal;
use super::floating::{Floating, Robot, Target};
use super::pair::{CellPlace, Pair, Site};
use std::collections::{BTreeMap, BTreeSet};

const DIRECTIONS: [Site; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// Returns the neighbours of a site.
pub(super) fn neighbours(site: Site) -> impl Iterator<Item = Site> {
    DIRECTIONS.into_iter().map(move |by| [site[0] + by[0], site[1] + by[1]])
}

/// Returns the sites of a connected set, each of which the others hang together without: those that are no articulation
/// points (Hopcroft and Tarjan 1973).
pub(super) fn dispensable(sites: &BTreeSet<Site>) -> BTreeSet<Site> {
    let list: Vec<Site> = sites.iter().copied().collect();
    let numbers: BTreeMap<Site, usize> = list.iter().copied().zip(0..).collect();
    // The depth at which each site is found, and the least depth that is reached from it and what is found behind it.
    let mut found: Vec<Option<(usize, usize)>> = vec![None; list.len()];
    let mut is_cut = vec![false; list.len()];
    let mut branches_of_first = 0;
    let mut open: Vec<(usize, usize)> = Vec::new();
    if !list.is_empty() {
        found[0] = Some((0, 0));
        open.push((0, 0));
    }
    while let Some((site, way)) = open.pop() {
        let (depth, low) = found[site].expect("sites are open once they are found");
        let Some(by) = DIRECTIONS.get(way) else {
            let Some(&(before, _)) = open.last() else { continue };
            let (depth_before, low_before) = found[before].expect("it was found before");
            found[before] = Some((depth_before, low_before.min(low)));
            if before == 0 {
                branches_of_first += 1;
            } else if low >= depth_before {
                is_cut[before] = true;
            }
            continue;
        };
        open.push((site, way + 1));
        let Some(&next) = numbers.get(&[list[site][0] + by[0], list[site][1] + by[1]]) else { continue };
        match found[next] {
            None => {
                found[next] = Some((depth + 1, depth + 1));
                open.push((next, 0));
            }
            // The way back to the site before is seen as well: it is not less deep than that site, so it changes nothing.
            Some((reached, _)) => found[site] = Some((depth, low.min(reached))),
        }
    }
    if let Some(first) = is_cut.first_mut() {
        *first = branches_of_first > 1;
    }
    list.into_iter().zip(is_cut).filter(|(_, is_cut)| !is_cut).map(|(site, _)| site).collect()
}

/// Returns the sites that are reached from one through those that `is_in`.
pub(super) fn reached(from: Site, is_in: impl Fn(Site) -> bool) -> BTreeSet<Site> {
    let mut found = BTreeSet::from([from]);
    let mut open = vec![from];
    while let Some(site) = open.pop() {
        for next in neighbours(site) {
            if is_in(next) && found.insert(next) {
                open.push(next);
            }
        }
    }
    found
}

/// A site with the direction in which it is entered, as an index in [`DIRECTIONS`].
type Entry = (Site, usize);

/// The bends and the length of a path, its last site with the direction in which it is entered, and the entry before.
type OpenPath = (usize, usize, Site, usize, Option<Entry>);

/// Returns the paths with the fewest bends, and of these the shortest, from a site through those that the robot fills to
/// each of the sites `ends`, filled or not, by their last site.
pub(super) fn paths(robot: &Robot, from: Site, ends: &BTreeSet<Site>) -> BTreeMap<Site, Vec<Site>> {
    let filled: BTreeSet<Site> = robot.sites().into_iter().collect();
    let mut before: BTreeMap<Entry, Option<Entry>> = BTreeMap::new();
    let mut found: BTreeMap<Site, Entry> = BTreeMap::new();
    let mut open: BTreeSet<OpenPath> = (0..4).map(|way| (0, 0, from, way, None)).collect();
    while let Some((bends, length, site, way, last)) = open.pop_first() {
        if before.contains_key(&(site, way)) {
            continue;
        }
        before.insert((site, way), last);
        found.entry(site).or_insert((site, way));
        if site != from && !filled.contains(&site) {
            continue;
        }
        for (turn, by) in DIRECTIONS.into_iter().enumerate() {
            let next = [site[0] + by[0], site[1] + by[1]];
            if next != from && (filled.contains(&next) || ends.contains(&next)) {
                let bent = usize::from(turn != way && site != from);
                open.insert((bends + bent, length + 1, next, turn, Some((site, way))));
            }
        }
    }
    let path = |end: Entry| {
        let mut path = vec![end.0];
        let mut at = end;
        while let Some(Some(last)) = before.get(&at) {
            path.push(last.0);
            at = *last;
        }
        path.reverse();
        path
    };
    found.into_iter().filter(|(site, _)| ends.contains(site)).map(|(site, end)| (site, path(end))).collect()
}

impl Floating<'_> {
    /// Conveys a cell along a path: from its first site, which a leaf leaves or a pair becomes single, to the last, which is
    /// empty, or single and becomes a pair. If pairs are on the path, the cell of the farthest goes first, and each takes the place of
    /// the next. False, and the robot is in some state between, if there is no pair left to spin against it, or
    /// the robot would fall apart.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit.
    pub(super) fn convey(&mut self, path: &[Site]) -> Result<bool, Refusal> {
        let pairs: Vec<usize> =
            (1..path.len()).filter(|&at| self.robot.pair_at(path[at]).is_some()).collect();
        let Some(&first) = pairs.first() else { return self.hop(path) };
        // A pair that spins while all others move.
        let mut stops = vec![0];
        if self.robot.pair_at(path[0]).is_none() && pairs.len() == self.robot.pairs.len() {
            let Some(wait) = [first.saturating_sub(2), first - 1].into_iter().find(|&at| at > 0) else {
                return Ok(false);
            };
            if !self.hop(&path[..=wait])? {
                return Ok(false);
            }
            stops = vec![wait];
        }
        stops.extend(pairs);
        let mut end = path.len() - 1;
        for start in stops.into_iter().rev() {
            if start < end && !self.hop(&path[start..=end])? {
                return Ok(false);
            }
            end = start;
        }
        Ok(true)
    }

    /// Conveys a cell along a path without pairs between its ends.
    fn hop(&mut self, path: &[Site]) -> Result<bool, Refusal> {
        let mut start = 0;
        while start + 1 < path.len() {
            let by = [path[start + 1][0] - path[start][0], path[start + 1][1] - path[start][1]];
            let mut end = start + 1;
            while end + 1 < path.len() && path[end + 1] == [path[end][0] + by[0], path[end][1] + by[1]] {
                end += 1;
            }
            if !self.advance(&path[start..=end], by)? {
                return Ok(false);
            }
            start = end;
        }
        Ok(true)
    }

    /// Moves the cells of a straight line of sites on: one cell leaves the first, and one more comes to the last.
    fn advance(&mut self, line: &[Site], by: Site) -> Result<bool, Refusal> {
        let mover = self.robot.pair_at(line[0]);
        let others: Vec<usize> = (0..self.robot.pairs.len()).filter(|&index| Some(index) != mover).collect();
        if let Some(index) = mover
            && !self.split(index, usize::from(by[0] == 0), &others)?
        {
            return Ok(false);
        }
        let leaf = mover.is_none();
        let mut cells: Vec<usize> = match mover {
            Some(index) => self.robot.pairs[index].along(by).to_vec(),
            None => vec![self.robot.singles[&line[0]]],
        };
        let (&last, between) = line.split_last().expect("a line has two ends");
        cells.extend(between[1..].iter().map(|site| self.robot.singles[site]));
        cells.extend(self.robot.singles.get(&last));
        let full = if leaf { &between[1..] } else { between };
        let (whole, rest) = cells.split_at(full.len());
        let mut target = Target::default();
        target.cells.extend(whole.iter().zip(full).map(|(&cell, &site)| (cell, CellPlace::whole(site))));
        let center = CellPlace::whole(last).center;
        let pair = if let [first, second] = *rest {
            let pair = Pair { site: last, center, cells: [first, second], phase: Pair::split_along(by) };
            target.cells.extend(pair.cells.into_iter().zip(Pair::places(pair.phase, center)));
            Some(pair)
        } else {
            target.cells.extend(rest.iter().map(|&cell| (cell, CellPlace::whole(last))));
            None
        };
        if !self.carry("pass", &target, &others)? {
            return Ok(false);
        }
        let robot = &mut self.robot;
        line.iter().for_each(|site| {
            robot.singles.remove(site);
        });
        robot.singles.extend(full.iter().copied().zip(whole.iter().copied()));
        if let Some(index) = mover {
            robot.pairs.remove(index);
        }
        match pair {
            Some(pair) => robot.pairs.push(pair),
            None => robot.singles.extend(rest.iter().map(|&cell| (last, cell))),
        }
        Ok(true)
    }
}
