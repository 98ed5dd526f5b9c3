//! Merges that run at once: while one pair of ends comes together, others do whose loops share no joint
//! and no bond with its own, in the same turn.

use super::closing::{self, Manner};
use super::merging::{Attempt, Pair, Side};
use super::robot::Dock;
use super::state::{Joints, State};
use crate::planners::random::SplitMix64;

/// Pairs that come together in one turn, and where the joints are then.
pub struct Party {
    pub pairs: Vec<Pair>,
    pub joints: Joints,
}

/// Pairs that were tried in vain before no more are.
const VAIN_MAX: usize = 4;

/// From how far a posture of their own loops of further pairs set out.
const SIZE: f64 = 0.02;

impl Party {
    /// Further pairs come to one that comes together in one turn, in their order, `at_once` in all.
    /// `tried` counts them.
    pub fn grown(
        mut self,
        state: &State,
        pairs: &[Pair],
        at_once: usize,
        closing: &closing::Settings,
        rng: &mut SplitMix64,
        (tried, work): (&mut u64, &mut u64),
    ) -> Party {
        let scene = state.scene();
        let here = &state.robot.joints;
        let mut claims = Claims::new(state);
        self.pairs.iter().for_each(|pair| claims.take(state, pair));
        let mut vain = 0;
        for pair in pairs {
            if self.pairs.len() >= at_once || vain == VAIN_MAX {
                break;
            }
            if !claims.allow(state, pair) {
                continue;
            }
            *tried += 1;
            let attempt =
                Attempt { pair, manner: Manner::Leap, detour: false, size: SIZE, side: Side::Both, closing };
            let next = attempt.leap(&scene, &self.joints, rng, work);
            match next.filter(|next| scene.is_free(here, next, work)) {
                Some(next) => {
                    self.joints = next;
                    claims.take(state, pair);
                    self.pairs.push(*pair);
                    vain = 0;
                }
                None => vain += 1,
            }
        }
        self
    }
}

/// What pairs need for themselves.
struct Claims {
    /// By place: whether what joins it to its parent is in a loop.
    taken: Vec<bool>,
    /// Docks of pairs.
    docks: Vec<Dock>,
    /// Of each module, with chains that become one counted as one.
    chains: Vec<usize>,
}

impl Claims {
    fn new(state: &State) -> Claims {
        Claims { taken: vec![false; state.tree.shoes()], docks: Vec::new(), chains: state.chains() }
    }

    /// The places below the steps of the way between a pair's docks.
    fn edges(state: &State, pair: &Pair) -> Vec<usize> {
        let tree = &state.tree;
        let path = tree.path(tree.place[pair.a.shoe()], tree.place[pair.b.shoe()]);
        path.places.windows(2).map(|step| step[0].max(step[1])).collect()
    }

    /// Chains that are different keep a bond between them that can be let go, and loops without a
    /// common edge stay closed while the others' joints turn.
    fn allow(&self, state: &State, pair: &Pair) -> bool {
        self.chains[pair.a.module] != self.chains[pair.b.module]
            && [pair.a, pair.b].iter().all(|dock| !self.docks.contains(dock))
            && Claims::edges(state, pair).iter().all(|&edge| !self.taken[edge])
    }

    fn take(&mut self, state: &State, pair: &Pair) {
        Claims::edges(state, pair).iter().for_each(|&edge| self.taken[edge] = true);
        self.docks.extend([pair.a, pair.b]);
        let (kept, gone) = (self.chains[pair.a.module], self.chains[pair.b.module]);
        self.chains.iter_mut().filter(|chain| **chain == gone).for_each(|chain| *chain = kept);
    }
}
