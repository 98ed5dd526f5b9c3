//! Routes of blocks: with the fewest bends, and of these the shortest (Dijkstra).

use super::{Site, moved};
use std::collections::{BTreeMap, BTreeSet};

/// A block on a route with the direction of the next one: an axis, 0 to 2, and a sign.
type State = (Site, usize, i64);

/// The number of bends of a route, and of its steps.
pub(super) type Cost = (u32, u32);

/// The best routes from all blocks to the nearest of several empty sites.
pub(super) struct Routes {
    /// The cost of each state that leads to such a site, with the state that follows; that of the last block has none.
    known: BTreeMap<State, (Cost, Option<State>)>,
}

impl Routes {
    /// Finds the best routes through the blocks `passable` to one of the sites `targets`, of which none is passable.
    pub(super) fn to(targets: &BTreeSet<Site>, passable: &BTreeSet<Site>) -> Routes {
        let mut known = BTreeMap::new();
        let mut frontier: BTreeSet<(Cost, State, Option<State>)> = BTreeSet::new();
        for (&target, (axis, sign)) in
            targets.iter().flat_map(|target| directions().map(move |d| (target, d)))
        {
            let block = moved(target, axis, -sign);
            if passable.contains(&block) {
                frontier.insert(((0, 1), (block, axis, sign), None));
            }
        }
        while let Some((cost, state, next)) = frontier.pop_first() {
            if known.contains_key(&state) {
                continue;
            }
            known.insert(state, (cost, next));
            let (block, axis, sign) = state;
            for (from, towards) in directions().filter(|&direction| direction != (axis, -sign)) {
                let before = (moved(block, from, -towards), from, towards);
                if passable.contains(&before.0) && !known.contains_key(&before) {
                    let bends = cost.0 + u32::from((from, towards) != (axis, sign));
                    frontier.insert(((bends, cost.1 + 1), before, Some(state)));
                }
            }
        }
        Routes { known }
    }

    /// Returns what no route from a block costs less than: the best one may lead from it at once to an empty site, or through
    /// it again. `None` if there is none.
    pub(super) fn least_cost(&self, block: Site) -> Option<Cost> {
        let states = directions().map(|(axis, sign)| (block, axis, sign));
        states.filter_map(|state| self.known.get(&state).map(|&(cost, _)| cost)).min()
    }

    /// Returns the blocks of the best route from a block through at least one other, and the empty site at its end, with its
    /// cost; the block itself must not have been passable. `None` if there is none.
    pub(super) fn route(&self, block: Site) -> Option<(Cost, Vec<Site>)> {
        let towards = directions().flat_map(|(axis, sign)| {
            let next = moved(block, axis, sign);
            let onwards = directions().filter(move |&direction| direction != (axis, -sign));
            onwards.map(move |(other, step)| ((next, other, step), u32::from((other, step) != (axis, sign))))
        });
        let known = towards.filter_map(|(state, bend)| {
            let (bends, steps) = self.known.get(&state)?.0;
            Some(((bends + bend, steps + 1), state))
        });
        let (cost, first) = known.min()?;
        let mut route = vec![block];
        let mut at = Some(first);
        while let Some((site, axis, sign)) = at {
            route.push(site);
            at = self.known[&(site, axis, sign)].1;
            if at.is_none() {
                route.push(moved(site, axis, sign));
            }
        }
        Some((cost, route))
    }
}

/// Returns the six directions, each as an axis and a sign.
pub(super) fn directions() -> impl Iterator<Item = (usize, i64)> {
    (0..3).flat_map(|axis| [(axis, -1), (axis, 1)])
}

/// Returns true if blocks hang together over faces.
pub(super) fn connected(blocks: &BTreeSet<Site>) -> bool {
    blocks.first().is_none_or(|&first| component(blocks, first).len() == blocks.len())
}

/// Returns the blocks that hang together with one of them over faces.
pub(super) fn component(blocks: &BTreeSet<Site>, first: Site) -> BTreeSet<Site> {
    let mut reached = BTreeSet::from([first]);
    let mut open = vec![first];
    while let Some(block) = open.pop() {
        for (axis, sign) in directions() {
            let next = moved(block, axis, sign);
            if blocks.contains(&next) && reached.insert(next) {
                open.push(next);
            }
        }
    }
    reached
}
