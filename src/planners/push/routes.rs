//! Distances in straight lines: how many lines of cells have to move, one after another, until a hole is filled.

use super::boxes::Boxes;
use super::grid::{DIRECTIONS, Grid};
use super::stage::Stage;

/// The distance of a site that no line reaches.
pub(super) const UNREACHED: u16 = u16::MAX;

/// For each site the least number of straight lines of single cells at rest between it and the nearest source, and
/// that source (a breadth-first search over lines).
#[derive(Debug)]
pub(super) struct Routes {
    distance: Vec<u16>,
    source: Vec<usize>,
    /// The sites that are reached, in the order of the search.
    reached: Vec<usize>,
    /// The number of visits of sites so far.
    pub(super) work: u64,
}

impl Routes {
    /// Returns routes without sources.
    pub(super) fn new(sites: usize) -> Routes {
        Routes { distance: vec![UNREACHED; sites], source: vec![0; sites], reached: vec![], work: 0 }
    }

    /// Returns the number of lines from a site to the nearest source, or [`UNREACHED`].
    pub(super) fn distance(&self, site: usize) -> u16 {
        self.distance[site]
    }

    /// Returns the nearest source of a site that is reached.
    pub(super) fn source(&self, site: usize) -> usize {
        self.source[site]
    }

    /// Searches from sites that can give a cell, `supply`: a hole at distance `d` is filled by `d` lines. A site with
    /// two cells gives one along its split only.
    pub(super) fn measure_from_supply(
        &mut self,
        (grid, boxes): (&Grid, &Boxes),
        stage: &Stage,
        supply: &[usize],
    ) {
        self.begin(supply);
        let mut at = 0;
        while at < self.reached.len() {
            let site = self.reached[at];
            at += 1;
            // A site that moves in this stage is a source, but nothing passes through it.
            if self.distance[site] > 0 && !stage.is_passable(boxes, site) {
                continue;
            }
            for direction in DIRECTIONS {
                if boxes.is_double(site) && !boxes.is_split_along(site, direction) {
                    continue;
                }
                let mut next = grid.next(site, direction);
                while self.reach(next, site) && stage.is_passable(boxes, next) {
                    next = grid.next(next, direction);
                }
            }
        }
    }

    /// Searches from holes: a cell in a site at distance `d` comes to a hole by `d` lines.
    pub(super) fn measure_from_holes(
        &mut self,
        (grid, boxes): (&Grid, &Boxes),
        stage: &Stage,
        holes: &[usize],
    ) {
        self.begin(holes);
        let mut at = 0;
        while at < self.reached.len() {
            let site = self.reached[at];
            at += 1;
            for direction in DIRECTIONS {
                let mut next = grid.next(site, direction);
                while stage.is_passable(boxes, next) && self.reach(next, site) {
                    next = grid.next(next, direction);
                }
            }
        }
    }

    fn begin(&mut self, sources: &[usize]) {
        for site in self.reached.drain(..) {
            self.distance[site] = UNREACHED;
        }
        for &site in sources {
            self.distance[site] = 0;
            self.source[site] = site;
            self.reached.push(site);
        }
    }

    /// Reaches a site by one line more than another. Returns false if it is as near already as the other, so that
    /// nothing is reached behind it that is not reached from there.
    fn reach(&mut self, site: usize, from: usize) -> bool {
        self.work += 1;
        if self.distance[site] <= self.distance[from] {
            return false;
        }
        if self.distance[site] == UNREACHED {
            self.distance[site] = self.distance[from] + 1;
            self.source[site] = self.source[from];
            self.reached.push(site);
        }
        true
    }
}
