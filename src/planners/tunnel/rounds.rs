//! Rounds of transfers: in each, some blocks tunnel along routes that do not meet, as many cells at once as the robot
//! can spare.

use super::blocks::Blocks;
use super::docking::holds;
use super::route::{Cost, Routes, component, connected, directions};
use super::thread::{Thread, order, thread};
use super::{CellBox, Site, moved};
use std::collections::{BTreeMap, BTreeSet};

/// The greatest number of blocks that tunnel in one round.
const TRANSFERS_MAX: usize = 8;

/// The number of ways that are tried in vain beside others before these begin.
const FAILURES_MAX: usize = 8;

/// The number of overlays that are planned, of those on which most blocks stay.
const OVERLAYS: usize = 4;

/// The number of blocks up to which more than one overlay is planned.
const OVERLAY_BLOCKS_MAX: usize = 64;

/// A way from one shape to another: its stages, each as what changes of the cells, by number, over it.
#[derive(Clone, Debug)]
pub(in crate::planners) struct Way {
    /// The boxes of all cells at the start.
    pub(in crate::planners) start: Vec<CellBox>,
    /// The cells that change in each stage, with their boxes at its end.
    pub(in crate::planners) stages: Vec<Vec<(usize, CellBox)>>,
}

/// Returns a way from one shape to another of as many blocks, in which cells have the numbers of their sites `cells`, which
/// are those of the start; `None` if none is found. `to` is translated to where most blocks stay, unless some cells are
/// `fixed`, which no way touches; then the blocks of both must stand on one lattice.
pub(in crate::planners) fn way(
    cells: &[Site],
    (from, to): (&Blocks, &Blocks),
    fixed: &[Site],
) -> Option<Way> {
    let shifts = if fixed.is_empty() {
        overlays(from, to)
    } else {
        let apart = [0, 1, 2].map(|axis| to.origin[axis] - from.origin[axis]);
        if apart.iter().any(|x| x % 2 != 0) {
            return None;
        }
        vec![apart.map(|x| x / 2)]
    };
    let fixed: BTreeSet<Site> = fixed.iter().map(|cell| from.block(*cell)).collect();
    let mut best: Option<Way> = None;
    for shift in shifts {
        let goal = to.sites.iter().map(|site| [0, 1, 2].map(|axis| site[axis] + shift[axis])).collect();
        let found = Search::new(cells, from, goal, &fixed)?.run();
        let fewest = best.as_ref().map_or(usize::MAX, |best| best.stages.len());
        best = found.filter(|way| way.stages.len() < fewest).or(best);
    }
    best
}

/// Returns the translations of the goal, in blocks, on which most of its blocks are blocks of the start, the best first.
fn overlays(from: &Blocks, to: &Blocks) -> Vec<Site> {
    let mut shared: BTreeMap<Site, usize> = BTreeMap::new();
    for a in &from.sites {
        for b in &to.sites {
            *shared.entry([0, 1, 2].map(|axis| a[axis] - b[axis])).or_default() += 1;
        }
    }
    let mut ranked: Vec<(usize, Site)> = shared.into_iter().map(|(shift, count)| (count, shift)).collect();
    ranked.sort_by_key(|&(count, shift)| (std::cmp::Reverse(count), shift));
    let most = if from.sites.len() > OVERLAY_BLOCKS_MAX { 1 } else { OVERLAYS };
    ranked.into_iter().take(most).map(|(_, shift)| shift).collect()
}

/// The state of the robot between two stages of a search.
struct Search<'a> {
    blocks: &'a Blocks,
    /// The blocks there are, and those that are to be.
    filled: BTreeSet<Site>,
    goal: BTreeSet<Site>,
    fixed: &'a BTreeSet<Site>,
    /// A block of the start and of the goal that never leaves.
    root: Site,
    cells: Vec<CellBox>,
    /// The cell that fills each site.
    at: BTreeMap<Site, usize>,
    way: Way,
}

/// A block on its way.
struct Transfer {
    /// The blocks of the route, and the empty site at its end.
    route: Vec<Site>,
    /// The places in the block whose cells have not left yet, in the order in which they may.
    left: Vec<Site>,
}

impl<'a> Search<'a> {
    /// Returns the state at the start; `None` if no block of the start is one of the goal.
    fn new(
        cells: &[Site],
        blocks: &'a Blocks,
        goal: BTreeSet<Site>,
        fixed: &'a BTreeSet<Site>,
    ) -> Option<Search<'a>> {
        let filled = blocks.sites.clone();
        let common: BTreeSet<Site> = filled.intersection(&goal).copied().collect();
        // The largest part that is right already stays and grows; with fixed blocks theirs.
        let mut root: Option<(usize, Site)> = None;
        let mut open = common.clone();
        while let Some(&first) = fixed.intersection(&open).next().or(open.first()) {
            let part = component(&common, first);
            open.retain(|block| !part.contains(block));
            if root.is_none_or(|(most, _)| part.len() > most && fixed.is_empty()) {
                root = Some((part.len(), first));
            }
        }
        let (_, root) = root?;
        let start: Vec<CellBox> = cells.iter().map(|site| CellBox::whole(*site)).collect();
        let at = cells.iter().copied().zip(0..).collect();
        let way = Way { start: start.clone(), stages: vec![] };
        Some(Search { blocks, filled, goal, fixed, root, cells: start, at, way })
    }

    /// Returns the way to the goal; `None` if none is found.
    fn run(mut self) -> Option<Way> {
        while self.filled != self.goal {
            crate::interrupt::progress_checkpoint(|| {
                format!("{} blocks are left to tunnel", self.goal.difference(&self.filled).count())
            });
            let round = self.transfers();
            if round.is_empty() {
                return None;
            }
            for transfer in &round {
                if let (Some(first), Some(last)) = (transfer.route.first(), transfer.route.last()) {
                    self.filled.remove(first);
                    self.filled.insert(*last);
                }
            }
            self.tunnel(round)?;
        }
        Some(self.way)
    }

    /// Returns the transfers of a round, on routes that share no block: at first of blocks that are too many, then of one
    /// that is far from the part that is right already, to where this part lacks one.
    fn transfers(&self) -> Vec<Transfer> {
        let mut passable: BTreeSet<Site> = self.filled.difference(self.fixed).copied().collect();
        let mut targets: BTreeSet<Site> = self.goal.difference(&self.filled).copied().collect();
        let mut staying = self.filled.clone();
        let mut round = Vec::new();
        while round.len() < TRANSFERS_MAX {
            let surplus = passable.iter().copied().filter(|block| !self.goal.contains(block));
            let Some(route) = best_route((&targets, &passable), surplus, &staying) else { break };
            for block in &route {
                passable.remove(block);
                targets.remove(block);
            }
            staying.remove(&route[0]);
            round.push(Transfer { left: order(&route), route });
        }
        if round.is_empty() {
            let common: BTreeSet<Site> = self.filled.intersection(&self.goal).copied().collect();
            let right = component(&common, self.root);
            targets.retain(|target| {
                directions().any(|(axis, sign)| right.contains(&moved(*target, axis, sign)))
            });
            let others = passable.iter().copied().filter(|block| !right.contains(block));
            let route = best_route((&targets, &passable), others, &staying);
            round.extend(route.map(|route| Transfer { left: order(&route), route }));
        }
        round
    }

    /// Takes all cells of the transfers of a round along their ways; `None` if one is left that can't go.
    fn tunnel(&mut self, mut round: Vec<Transfer>) -> Option<()> {
        while round.iter().any(|transfer| !transfer.left.is_empty()) {
            let mut group: Vec<Thread> = Vec::new();
            let mut failures = 0;
            for transfer in &mut round {
                let mut index = 0;
                while index < transfer.left.len() && failures < FAILURES_MAX {
                    let place = transfer.left[index];
                    index += 1;
                    let Some(next) = thread(self.blocks, &self.at, &transfer.route, place) else { continue };
                    let meets = |other: &Thread| other.sites.iter().any(|site| next.sites.contains(site));
                    if group.iter().any(meets) {
                        continue;
                    }
                    group.push(next);
                    if self.held(&group) {
                        index -= 1;
                        transfer.left.remove(index);
                    } else {
                        group.pop();
                        failures += 1;
                    }
                }
            }
            if group.is_empty() {
                return None;
            }
            self.advance(&group);
        }
        Some(())
    }

    /// Returns true if docked contacts hold the robot together in all stages of ways that begin at once.
    fn held(&self, group: &[Thread]) -> bool {
        crate::interrupt::checkpoint();
        let mut before = self.cells.clone();
        stages(group).all(|stage| {
            let mut after = before.clone();
            stage.iter().for_each(|&(cell, to)| after[cell] = to);
            let holds = holds(&before, &after);
            before = after;
            holds
        })
    }

    /// Appends the stages of ways that begin at once.
    fn advance(&mut self, group: &[Thread]) {
        for stage in stages(group) {
            stage.iter().for_each(|&(cell, to)| self.cells[cell] = to);
            self.way.stages.push(stage);
        }
        for thread in group {
            self.at.remove(&thread.sites[0]);
            self.at.extend(thread.sites[1..].iter().copied().zip(thread.cells.iter().copied()));
        }
    }
}

/// Returns the stages of ways that begin at once.
fn stages(group: &[Thread]) -> impl Iterator<Item = Vec<(usize, CellBox)>> + '_ {
    let most = group.iter().map(|thread| thread.stages.len()).max().unwrap_or(0);
    (0..most)
        .map(|stage| group.iter().filter_map(|thread| thread.stages.get(stage)).flatten().copied().collect())
}

/// Returns the best route to one of the `targets`, through those that are `passable`, of one of the blocks, without which all
/// that are `staying` still hang together; `None` if there is none.
fn best_route(
    (targets, passable): (&BTreeSet<Site>, &BTreeSet<Site>),
    blocks: impl Iterator<Item = Site>,
    staying: &BTreeSet<Site>,
) -> Option<Vec<Site>> {
    let routes = Routes::to(targets, passable);
    let mut ranked: Vec<(Cost, Site)> =
        blocks.filter_map(|block| Some((routes.least_cost(block)?, block))).collect();
    ranked.sort_unstable();
    let mut best: Option<(Cost, Vec<Site>)> = None;
    for (least, block) in ranked {
        if best.as_ref().is_some_and(|(cost, _)| *cost <= least) {
            break;
        }
        let without = |blocks: &BTreeSet<Site>| -> BTreeSet<Site> {
            blocks.iter().copied().filter(|other| *other != block).collect()
        };
        if !connected(&without(staying)) {
            continue;
        }
        if let Some(found) = Routes::to(targets, &without(passable)).route(block)
            && best.as_ref().is_none_or(|(cost, _)| found.0 < *cost)
        {
            best = Some(found);
        }
    }
    best.map(|(_, route)| route)
}
