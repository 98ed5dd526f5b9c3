//! Many runs of the search, over several overlays of the goal on the start, of which the best is kept.

use super::Bounds;
use super::boxes::Placed;
use super::grid::Grid;
use super::search::{Found, Search};
use crate::optimize::random::SplitMix64;
use std::collections::BTreeMap;

/// The greatest number of pairs of cells for which overlays are counted.
const PAIRS_MAX: usize = 4_000_000;

/// The number of overlays that are tried, of those on which most cells stay.
const OVERLAYS: usize = 8;

/// The number of overlays that are searched further, the best ones.
const BEST_OVERLAYS: usize = 3;

/// The greatest number of runs.
const RUNS_MAX: usize = 400;

/// The work after which no further run begins, in visits of sites.
const WORK_BETTER: u64 = 100_000_000;

/// The work after which the search ends while nothing is found, and nothing else is known.
const WORK_FIRST: u64 = 3_000_000_000;

/// The best way that was found, on its grid.
pub(crate) struct Best {
    grid: Grid,
    found: Found,
    /// True if the way leads from the goal to the start.
    pub(crate) backwards: bool,
}

impl Best {
    /// Returns the places of all `count` cells between the stages, and at both ends.
    pub(crate) fn places(&self, count: usize) -> Vec<Vec<Placed>> {
        self.found.states.iter().map(|state| state.places(&self.grid, count)).collect()
    }
}

/// Returns the fastest of many ways from one shape to another; `None` if none is found that takes less than
/// `time_limit`, in units of time. The goal may be translated if nothing stands fast within the `bounds`; a cell that
/// does must be one of both shapes. `squeezes`: whether cells shrink to half their size.
pub(crate) fn best(
    from: &[[i64; 3]],
    to: &[[i64; 3]],
    (squeezes, bounds): (bool, Bounds),
    time_limit: f64,
) -> Option<Best> {
    let mut overlays = if bounds.fixed.is_empty() { overlays(from, to) } else { vec![[0; 3]] };
    let mut random = SplitMix64(from.len() as u64);
    let mut best: Option<Best> = None;
    // The search need not find a way at any price where another is known already.
    let most = if time_limit.is_finite() { 2 * WORK_BETTER } else { WORK_FIRST };
    let mut work = 0;
    let mut times: Vec<(f64, [i64; 3])> = vec![];
    for run in 0..RUNS_MAX {
        if run == overlays.len() && !times.is_empty() {
            times.sort_by(|a, b| a.0.total_cmp(&b.0));
            overlays = times.iter().take(BEST_OVERLAYS).map(|(_, overlay)| *overlay).collect();
        }
        let overlay = *overlays.get(run % overlays.len().max(1))?;
        let least = best.as_ref().map_or(time_limit, |best| best.found.time);
        if work > if best.is_some() { WORK_BETTER } else { most } || least <= 0.0 {
            break;
        }
        let goal: Vec<[i64; 3]> = to.iter().map(|p| [0, 1, 2].map(|axis| p[axis] + overlay[axis])).collect();
        let grid = Grid::around(from.iter().chain(&goal))?;
        let sites = |places: &[[i64; 3]]| places.iter().map(|p| grid.site(*p)).collect::<Vec<usize>>();
        let (mut start, mut goal) = (sites(from), sites(&goal));
        let backwards = random.below(2) == 1;
        if backwards {
            std::mem::swap(&mut start, &mut goal);
        }
        let mut search = Search::new(&grid, &start, &goal, (squeezes, bounds), &mut random);
        let found = search.run(least, most);
        work += search.work();
        if let Some(found) = found {
            times.push((found.time, overlay));
            best = Some(Best { grid, found, backwards });
        }
    }
    best
}

/// Returns the translations of the goal, in cells, on which most of its cells are cells of the start, the best first.
fn overlays(from: &[[i64; 3]], to: &[[i64; 3]]) -> Vec<[i64; 3]> {
    if from.len().saturating_mul(to.len()) > PAIRS_MAX {
        let middle = |places: &[[i64; 3]], axis: usize| {
            places.iter().map(|p| p[axis]).sum::<i64>() / places.len() as i64
        };
        return vec![[0, 1, 2].map(|axis| middle(from, axis) - middle(to, axis))];
    }
    let mut shared: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    for a in from {
        for b in to {
            *shared.entry([0, 1, 2].map(|axis| a[axis] - b[axis])).or_default() += 1;
        }
    }
    let mut ranked: Vec<(usize, [i64; 3])> =
        shared.into_iter().map(|(overlay, count)| (count, overlay)).collect();
    ranked.sort_by_key(|&(count, overlay)| (std::cmp::Reverse(count), overlay));
    ranked.into_iter().take(OVERLAYS).map(|(_, overlay)| overlay).collect()
}
