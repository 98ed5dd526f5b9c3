//! Concurrent merges: while one pair of ends comes together, so do others in the same step whose loops
//! share no joint and no bond with its own.

use super::inverse_kinematics::IkMode;
use super::inverse_kinematics::MovingSide;
use super::merging::{Attempt, Pair};
use super::robot::Dock;
use super::settings::Settings;
use super::state::{Joints, State};
use crate::optimize::random::SplitMix64;

/// Pairs of docks that come together in one step, and the joint positions at its end.
pub(super) struct ConcurrentMerges {
    /// The pairs that come together, in the order in which they were added.
    pub(super) pairs: Vec<Pair>,
    /// The positions of all joints at the end of the step, by module, rad.
    pub(super) joints: Joints,
}

/// The number of failed attempts in a row after which no more pairs are tried.
const FAILURES_MAX: usize = 4;

/// Spread of the random start of further pairs, as a fraction of the joints' ranges: they are wanted only
/// where they come together from close to where they are.
const START_SPREAD: f64 = 0.02;

impl ConcurrentMerges {
    /// Adds further pairs, tried in the order of `pairs`, that share no joint, bond or chain with those there, until
    /// there are [`Settings::concurrent_merges_max`] or `FAILURES_MAX` attempts in a row failed. `tried` counts
    /// attempts, `work` counts forward kinematics; `rng` gives random starts.
    pub(super) fn extended(
        mut self,
        state: &State,
        pairs: &[Pair],
        settings: &Settings,
        rng: &mut SplitMix64,
        (tried, work): (&mut u64, &mut u64),
    ) -> ConcurrentMerges {
        let scene = state.scene();
        let here = &state.robot.joints;
        // Edges, docks and chains of the pairs so far are reserved.
        let mut reservations = Reservations::new(state);
        self.pairs.iter().for_each(|pair| reservations.reserve(state, pair));
        let mut failures = 0;
        for pair in pairs {
            if self.pairs.len() >= settings.concurrent_merges_max || failures == FAILURES_MAX {
                break;
            }
            if !reservations.allow(state, pair) {
                continue;
            }
            *tried += 1;
            let attempt = Attempt {
                pair,
                mode: IkMode::Endpoint,
                detour: false,
                spread: START_SPREAD,
                side: MovingSide::Both,
                settings: &settings.inverse_kinematics,
            };
            // The joints of all pairs so far move on together with those of this one.
            let next = attempt.closed_posture(&scene, &self.joints, rng, work);
            match next.filter(|next| scene.is_free(here, next, work)) {
                Some(next) => {
                    self.joints = next;
                    reservations.reserve(state, pair);
                    self.pairs.push(*pair);
                    failures = 0;
                }
                None => failures += 1,
            }
        }
        self
    }
}

/// The edges, docks and chains that pairs need for themselves.
struct Reservations {
    /// True, by index of the tree, if the edge to the parent is in a loop.
    edges: Vec<bool>,
    /// The docks of pairs.
    docks: Vec<Dock>,
    /// The number of each module's chain; chains that become one have equal numbers.
    chains: Vec<usize>,
}

impl Reservations {
    fn new(state: &State) -> Reservations {
        Reservations { edges: vec![false; state.tree.shoes()], docks: Vec::new(), chains: state.chains() }
    }

    /// Returns the edges of the path between a pair's docks, each by its lower index.
    fn edges(state: &State, pair: &Pair) -> Vec<usize> {
        let tree = &state.tree;
        let path = tree.path(tree.index[pair.a.shoe()], tree.index[pair.b.shoe()]);
        path.indices.windows(2).map(|step| step[0].max(step[1])).collect()
    }

    /// Returns true if a pair is independent of those before: chains that are different keep a bond between
    /// them that can be replaced, and loops without a common edge stay closed while others' joints turn.
    fn allow(&self, state: &State, pair: &Pair) -> bool {
        self.chains[pair.a.module] != self.chains[pair.b.module]
            && [pair.a, pair.b].iter().all(|dock| !self.docks.contains(dock))
            && Reservations::edges(state, pair).iter().all(|&edge| !self.edges[edge])
    }

    /// Reserves the edges, docks and chains of a pair.
    fn reserve(&mut self, state: &State, pair: &Pair) {
        Reservations::edges(state, pair).iter().for_each(|&edge| self.edges[edge] = true);
        self.docks.extend([pair.a, pair.b]);
        let (kept, gone) = (self.chains[pair.a.module], self.chains[pair.b.module]);
        self.chains.iter_mut().filter(|chain| **chain == gone).for_each(|chain| *chain = kept);
    }
}
