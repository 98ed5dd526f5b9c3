//! Behaviours that were called before with the same arguments, so that each is made once.
//!
//! A behaviour that is composed of calls of smaller ones, ten times each, level by level, would otherwise be
//! made of ten times as many actions at each level; so they share theirs.

use std::collections::HashMap;

/// The greatest number of calls of one behaviour of one object that are remembered.
const CALLS_MAX: usize = 64;

/// The greatest number of evaluation steps that the remembered calls may have taken, as a bound on their size.
const STEPS_MAX: u64 = 2_000_000;

/// The behaviours `B` that calls `C` gave, by the key of the call. They are dropped, all but the newest, once they
/// took more than `STEPS_MAX` evaluation steps.
#[derive(Clone)]
pub struct Recalled<C, B> {
    by_key: HashMap<CallKey, Vec<(C, B)>>,
    /// The evaluation steps of all calls offered since the last were forgotten, also of those not remembered.
    steps: u64,
}

/// The key of a call: the address of the object, which the kept call keeps alive, and the index of its behaviour in
/// the declaration.
pub type CallKey = (usize, usize);

impl<C, B> Default for Recalled<C, B> {
    fn default() -> Recalled<C, B> {
        Recalled { by_key: HashMap::new(), steps: 0 }
    }
}

impl<C, B: Clone> Recalled<C, B> {
    /// Returns the behaviour that a call with this key gave before, of those that `is_same` accepts the first;
    /// `None` if there is none.
    pub fn find(&self, key: CallKey, is_same: impl Fn(&C) -> bool) -> Option<B> {
        let known = self.by_key.get(&key)?;
        known.iter().find(|(call, _)| is_same(call)).map(|(_, behavior)| behavior.clone())
    }

    /// Remembers the behaviour that a call gave in `steps` evaluation steps; of one key the first `CALLS_MAX` calls.
    /// If those offered, the ones beyond that number included, would then have taken more than `STEPS_MAX` steps
    /// together, all earlier ones are forgotten first. `behavior`: the result of the call.
    pub fn keep(&mut self, key: CallKey, call: C, behavior: B, steps: u64) {
        self.steps += steps;
        if self.steps > STEPS_MAX {
            *self = Recalled { steps, ..Recalled::default() };
        }
        let known = self.by_key.entry(key).or_default();
        if known.len() < CALLS_MAX {
            known.push((call, behavior));
        }
    }
}
