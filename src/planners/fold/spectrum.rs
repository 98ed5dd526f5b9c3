//! The spectrum of energies: the energies that occur, with their multiplicities.

use super::tolerances::TOLERANCES;
use std::collections::BTreeMap;

/// The greatest number of bins; further energies are counted together.
const DIFFERENT_MAX: usize = 4_000_000;

/// A histogram of layout energies in narrow bins, from which levels with their multiplicities are read.
#[derive(Clone, Debug)]
pub struct Spectrum {
    unit: f64,
    counts: BTreeMap<u64, u64>,
    /// The number of energies that were not counted because they would have needed more than `DIFFERENT_MAX` bins.
    pub uncounted: u64,
}

impl Spectrum {
    /// Returns an empty histogram. `unit`: a positive energy of the order of magnitude of those that will be counted; a
    /// bin is the fraction `TOLERANCES.energy_grain` of it wide.
    pub fn new(unit: f64) -> Spectrum {
        Spectrum { unit, counts: BTreeMap::new(), uncounted: 0 }
    }

    /// Counts an energy, in the same unit of measurement as `unit`; a negative one counts as 0. One that would need
    /// more than `DIFFERENT_MAX` bins is counted in [`uncounted`](Spectrum::uncounted) only.
    pub fn add(&mut self, energy: f64) {
        let key = (energy / (self.unit * TOLERANCES.energy_grain)).round() as u64;
        if let Some(count) = self.counts.get_mut(&key) {
            *count += 1;
        } else if self.counts.len() < DIFFERENT_MAX {
            self.counts.insert(key, 1);
        } else {
            self.uncounted += 1;
        }
    }

    /// Returns (energy, multiplicity) of each level, ascending by energy, in the unit of measurement of `unit`.
    /// Energies that are at most `TOLERANCES.tie` times `unit` above the one before are one level with it, at the
    /// least of them.
    pub fn levels(&self) -> Vec<(f64, u64)> {
        let apart = (TOLERANCES.tie / TOLERANCES.energy_grain) as u64;
        let mut levels: Vec<(f64, u64)> = Vec::new();
        let mut last = None;
        for (&key, &count) in &self.counts {
            match levels.last_mut() {
                Some(level) if last.is_some_and(|l| key - l <= apart) => level.1 += count,
                _ => levels.push((key as f64 * self.unit * TOLERANCES.energy_grain, count)),
            }
            last = Some(key);
        }
        levels
    }
}
