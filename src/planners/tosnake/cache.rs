//! Step sequences that were found before: for a library of n shapes, n searches make all n²
//! reconfigurations.

use super::gravity::GravityModel;
use super::robot::Robot;
use super::search::StepSequence;
use super::settings::Settings;
use std::rc::Rc;

/// Greatest number of stored sequences; beyond it the oldest goes.
const STORED_MAX: usize = 100;

/// The robot, settings and gravity model that determine a step sequence; two searches with equal keys find the same.
#[derive(Clone, PartialEq)]
pub(crate) struct SearchKey {
    robot: Robot,
    settings: Settings,
    gravity: Option<GravityModel>,
}

impl SearchKey {
    /// Returns the key of a search. The number of threads is not part of it, for the steps do not depend on that.
    pub(crate) fn new(robot: Robot, settings: &Settings, gravity: Option<GravityModel>) -> SearchKey {
        SearchKey { robot, settings: Settings { threads: 1, ..*settings }, gravity }
    }
}

/// A cache of the step sequences of the last searches that found one, at most `STORED_MAX`. Clones share the
/// sequences, not the list.
#[derive(Clone, Default)]
pub struct SearchCache(Vec<(Rc<SearchKey>, Rc<StepSequence>)>);

impl SearchCache {
    /// Returns the step sequence of a key; `None` if it is not stored.
    pub(crate) fn get(&self, key: &SearchKey) -> Option<Rc<StepSequence>> {
        self.0.iter().find(|(known, _)| **known == *key).map(|(_, found)| found.clone())
    }

    /// Stores a step sequence; beyond [`STORED_MAX`] the oldest is dropped.
    pub(crate) fn insert(&mut self, key: SearchKey, found: Rc<StepSequence>) {
        if self.0.len() >= STORED_MAX {
            self.0.remove(0);
        }
        self.0.push((Rc::new(key), found));
    }
}
