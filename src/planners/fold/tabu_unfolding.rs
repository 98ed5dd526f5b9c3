//! Tabu search for layouts that lie flat, from layouts that overlap: exchanges of one hinge for another that
//! separate overlapping faces, and then those that cost less and keep the pattern flat. Nothing is proved.
//!
//! One of the hinges between two faces that overlap is given up, and the two parts of the sheet are joined
//! elsewhere. Of some such exchanges that is made which leaves the fewest overlaps, then costs the least;
//! also where that is more than before, or the search would stay in the first local minimum. A hinge given up a
//! short while ago does not come back (a tabu list, as "Tabu Unfolder" by Zawallich and Pajarola has it).

use super::edge_exchange;
use super::layout::Layout;
use super::pattern::Pattern;
use super::target::Target;
use super::weights::Weights;
use crate::optimize::random::SplitMix64;

/// Exchanges that are sampled before the best is made.
const EXCHANGES_SAMPLED: usize = 24;

/// The number of exchanges for which a hinge that was given up stays tabu.
const TABU: usize = 12;

/// Pairs of faces that are tested in the time of one step.
const PAIRS: usize = 64;

/// Exchanges per face after which the search ends.
const MOVES: usize = 24;

/// The number of steps that the search for a first layout that lies flat gets even where the budget is spent: under a
/// second.
const FIRST_STEPS: u64 = 10_000_000;

/// Searches any layout that lies flat, from `layout`, by [`without_overlaps`] with a number of steps that does not depend
/// on the budget of the call, so that a call whose budget ends has an answer nevertheless.
pub(super) fn first_flat(target: &Target, weights: &Weights, layout: Layout, seed: u64) -> Option<Layout> {
    let mut steps = FIRST_STEPS;
    without_overlaps(target, weights, layout, seed, &mut steps)
}

/// Searches a layout that lies flat from one whose pattern may overlap, by random exchanges of hinges with a tabu list
/// ("Tabu Unfolder", Zawallich and Pajarola), and then lowers its energy. `steps` counts down as the search works;
/// `seed` fixes its random numbers. `None` if the steps are used up, or none was found in a number of rounds
/// proportional to the faces.
pub(super) fn without_overlaps(
    target: &Target,
    weights: &Weights,
    layout: Layout,
    seed: u64,
    steps: &mut u64,
) -> Option<Layout> {
    let n = target.faces.len();
    let mut parting = TabuExchange::new(target, seed);
    let mut now = layout;
    for round in 1..=MOVES * n {
        crate::interrupt::checkpoint();
        let overlaps = Pattern::of(target, &now).overlaps();
        let Some([a, b]) = parting.one_of(&overlaps) else {
            let flat = |layout: &Layout| Pattern::of(target, layout).overlaps().is_empty();
            return Some(edge_exchange::improved_where(target, weights, now, steps, &flat));
        };
        let between = edge_exchange::path(&now, a, b);
        let mut best: Option<((usize, f64), Layout, usize)> = None;
        for _ in 0..EXCHANGES_SAMPLED {
            *steps = steps.checked_sub((n * n / PAIRS + n) as u64)?;
            let Some((next, dropped)) = parting.exchange(&now, &between, round) else { continue };
            let worth = (Pattern::of(target, &next).overlaps().len(), next.energy(weights));
            if best.as_ref().is_none_or(|(least, ..)| worth < *least) {
                best = Some((worth, next, dropped));
            }
        }
        if let Some((_, next, dropped)) = best {
            parting.give_up(dropped, round);
            now = next;
        }
    }
    None
}

/// Random exchanges of hinges between two faces that overlap or collide, with a tabu list.
pub(super) struct TabuExchange<'t> {
    target: &'t Target,
    rng: SplitMix64,
    /// The round in which each hinge may come back.
    out_until: Vec<usize>,
}

impl<'t> TabuExchange<'t> {
    /// Returns exchanges for a target with an empty tabu list; `seed` fixes their random numbers.
    pub(super) fn new(target: &'t Target, seed: u64) -> TabuExchange<'t> {
        TabuExchange { target, rng: SplitMix64(seed), out_until: vec![0; target.hinges.len()] }
    }

    /// Returns one of the pairs of faces, drawn uniformly at random; `None` if there are none.
    pub(super) fn one_of(&mut self, pairs: &[[usize; 2]]) -> Option<[usize; 2]> {
        pairs.get(self.rng.below(pairs.len().max(1))).copied()
    }

    /// Drops one of the hinges `between` (indices in [`Target::hinges`], at least one), chosen at random, and joins the
    /// two parts of the layout across another hinge that is not tabu in `round`. Returns the new layout and the index
    /// of the dropped hinge; `None` if no such hinge joins them. Panics if `between` is empty.
    pub(super) fn exchange(
        &mut self,
        now: &Layout,
        between: &[usize],
        round: usize,
    ) -> Option<(Layout, usize)> {
        let dropped = between[self.rng.below(between.len())];
        let mut ways = joining(self.target, now, dropped);
        ways.retain(|hinge| *hinge != dropped && self.out_until[*hinge] < round);
        if ways.is_empty() {
            return None;
        }
        let added = ways[self.rng.below(ways.len())];
        Some((now.exchanged(self.target, dropped, added), dropped))
    }

    /// Makes a hinge (an index in [`Target::hinges`]) tabu up to and including round `round +` [`TABU`].
    pub(super) fn give_up(&mut self, hinge: usize, round: usize) {
        self.out_until[hinge] = round + TABU;
    }
}

/// Returns the hinges between the two parts into which a layout falls without one of its own.
fn joining(target: &Target, layout: &Layout, without: usize) -> Vec<usize> {
    let mut below = vec![false; layout.parent.len()];
    for &face in &layout.order[1..] {
        below[face] = layout.hinge[face] == Some(without) || below[layout.parent[face]];
    }
    let joins = |hinge: &usize| {
        let [a, b] = target.hinges[*hinge].faces;
        below[a] != below[b]
    };
    (0..target.hinges.len()).filter(joins).collect()
}
