//! Ways to the snake that were found: for a library of n shapes n of them make all n² reconfigurations.

use crate::planners::tosnake::{Collisions, Found, Robot, Weight};
use std::rc::Rc;

/// Ways that are kept.
const KEPT_MAX: usize = 100;

/// What a way depends on, and nothing else does it.
#[derive(Clone, PartialEq)]
pub struct Sought {
    pub robot: Robot,
    pub seed: u64,
    pub budget: u64,
    pub collisions: Collisions,
    pub weight: Option<Weight>,
}

/// The last ways; copies share them.
#[derive(Clone, Default)]
pub struct Unwindings(Vec<(Rc<Sought>, Rc<Found>)>);

impl Unwindings {
    pub fn get(&self, sought: &Sought) -> Option<Rc<Found>> {
        self.0.iter().find(|(known, _)| **known == *sought).map(|(_, found)| found.clone())
    }

    pub fn keep(&mut self, sought: Sought, found: Rc<Found>) {
        if self.0.len() >= KEPT_MAX {
            self.0.remove(0);
        }
        self.0.push((Rc::new(sought), found));
    }
}
