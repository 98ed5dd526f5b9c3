//! Step sequences that were found before: for a library of n shapes, n searches make all n²
//! reconfigurations.

use super::gravity::GravityModel;
use super::robot::Robot;
use super::search::StepSequence;
use super::settings::Collisions;
use std::rc::Rc;

/// Greatest number of stored sequences; beyond it the oldest goes.
const STORED_MAX: usize = 100;

/// Everything that a step sequence depends on.
#[derive(Clone, PartialEq)]
pub(crate) struct SearchKey {
    pub(crate) robot: Robot,
    pub(crate) seed: u64,
    pub(crate) budget: u64,
    pub(crate) collisions: Collisions,
    pub(crate) gravity: Option<GravityModel>,
}

/// The step sequences of the last searches. Clones share the sequences, not the list.
#[derive(Clone, Default)]
pub struct SearchCache(Vec<(Rc<SearchKey>, Rc<StepSequence>)>);

impl SearchCache {
    pub(crate) fn get(&self, key: &SearchKey) -> Option<Rc<StepSequence>> {
        self.0.iter().find(|(known, _)| **known == *key).map(|(_, found)| found.clone())
    }

    pub(crate) fn insert(&mut self, key: SearchKey, found: Rc<StepSequence>) {
        if self.0.len() >= STORED_MAX {
            self.0.remove(0);
        }
        self.0.push((Rc::new(key), found));
    }
}
