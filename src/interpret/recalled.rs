//! Behaviours that were called before with the same arguments, so that each is made once.
//!
//! A behaviour that is composed of calls of smaller ones, ten times each, level by level, would otherwise be
//! made of ten times as many actions at each level; so they share theirs.

use std::collections::HashMap;

/// Most calls of one behaviour of one robot that are remembered.
const CALLS_MAX: usize = 64;

/// Most evaluation steps that all that is remembered took: a bound on its size.
const STEPS_MAX: u64 = 2_000_000;

/// The behaviours `B` that calls `C` gave, by object and behaviour.
#[derive(Clone)]
pub struct Recalled<C, B> {
    by_place: HashMap<Place, Vec<(C, B)>>,
    steps: u64,
}

/// The address of an object, which its calls keep alive, and the index of its behaviour.
pub type Place = (usize, usize);

impl<C, B> Default for Recalled<C, B> {
    fn default() -> Recalled<C, B> {
        Recalled { by_place: HashMap::new(), steps: 0 }
    }
}

impl<C, B: Clone> Recalled<C, B> {
    /// Returns the behaviour that a call gave before.
    pub fn find(&self, place: Place, is_same: impl Fn(&C) -> bool) -> Option<B> {
        let known = self.by_place.get(&place)?;
        known.iter().find(|(call, _)| is_same(call)).map(|(_, behavior)| behavior.clone())
    }

    /// Remembers the behaviour that a call gave in so many evaluation steps.
    pub fn keep(&mut self, place: Place, call: C, behavior: B, steps: u64) {
        self.steps += steps;
        if self.steps > STEPS_MAX {
            *self = Recalled { steps, ..Recalled::default() };
        }
        let known = self.by_place.entry(place).or_default();
        if known.len() < CALLS_MAX {
            known.push((call, behavior));
        }
    }
}
