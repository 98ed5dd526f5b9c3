//! Energies that occur, and how often.

use std::collections::BTreeMap;

/// Energies nearer than this, as part of the unit, are one.
const TOL_EQUAL: f64 = 1e-9;

/// Fineness of the first sorting, as part of the unit.
const GRAIN: f64 = 1e-11;

/// More different energies are not told apart; their sum of counts is still kept.
const DIFFERENT_MAX: usize = 4_000_000;

/// Counts of energies, held as steps of a small part of a unit.
#[derive(Clone, Debug)]
pub struct Spectrum {
    unit: f64,
    counts: BTreeMap<u64, u64>,
    /// Energies not told apart.
    pub uncounted: u64,
}

impl Spectrum {
    /// `unit`: a positive energy of the order of those that will come.
    pub fn new(unit: f64) -> Spectrum {
        Spectrum { unit, counts: BTreeMap::new(), uncounted: 0 }
    }

    pub fn add(&mut self, energy: f64) {
        let key = (energy / (self.unit * GRAIN)).round() as u64;
        if let Some(count) = self.counts.get_mut(&key) {
            *count += 1;
        } else if self.counts.len() < DIFFERENT_MAX {
            self.counts.insert(key, 1);
        } else {
            self.uncounted += 1;
        }
    }

    /// Energies with how often each occurs, in order.
    pub fn levels(&self) -> Vec<(f64, u64)> {
        let apart = (TOL_EQUAL / GRAIN) as u64;
        let mut levels: Vec<(f64, u64)> = Vec::new();
        let mut last = None;
        for (&key, &count) in &self.counts {
            match levels.last_mut() {
                Some(level) if last.is_some_and(|l| key - l <= apart) => level.1 += count,
                _ => levels.push((key as f64 * self.unit * GRAIN, count)),
            }
            last = Some(key);
        }
        levels
    }
}
