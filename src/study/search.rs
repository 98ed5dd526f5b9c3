//! The search for the best point of a study, by CMA-ES in the unit cube of its axes.

use super::{Coordinate, Design, Domain, Sampler};
use crate::optimize::CmaEs;
use crate::optimize::random::SplitMix64;

/// The initial standard deviation, as a part of each axis.
const SIGMA_START: f64 = 0.3;
/// The least standard deviation on an axis of values, as a part of the width of one value: the neighbours of a value
/// are then drawn again and again.
const VALUE_SIGMA: f64 = 0.3;
/// The factor by which the population grows when a search has converged and another one begins (Auger and Hansen,
/// "A restart CMA evolution strategy with increasing population size", CEC 2005).
const POPULATION_GROWTH: usize = 2;

/// The direction in which a search seeks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// The greatest value.
    Greatest,
    /// The least value.
    Least,
}

/// A search through the axes of a design: it gives the points of one generation after the other, and is told their
/// values. The same design and values give the same points.
#[derive(Clone, Debug)]
pub struct Search {
    axes: Vec<Domain>,
    goal: Goal,
    /// The number of points that may still be asked for.
    left: u64,
    strategy: CmaEs,
    /// The number of strategies that were begun.
    begun: u64,
    seed: u64,
    /// The points of the present generation, in the unbounded coordinates of the strategy.
    asked: Vec<Vec<f64>>,
}

impl Search {
    /// Returns a search at its beginning; `None` if the design is no search, or has no axes.
    pub fn new(design: &Design, goal: Goal) -> Option<Search> {
        let Sampler::Search(budget) = design.sampler else { return None };
        if design.axes.is_empty() {
            return None;
        }
        let strategy = strategy(&design.axes, vec![0.5; design.axes.len()], seed(design.seed, 0), None);
        Some(Search {
            axes: design.axes.clone(),
            goal,
            left: budget,
            strategy,
            begun: 1,
            seed: design.seed,
            asked: Vec::new(),
        })
    }

    /// Returns the points of the next generation, in order; none once the budget is spent. The last generation may be
    /// cut short.
    pub fn ask(&mut self) -> Vec<Vec<Coordinate>> {
        self.asked = self.strategy.ask();
        let count = self.asked.len().min(usize::try_from(self.left).unwrap_or(usize::MAX));
        self.left -= count as u64;
        let at = |x: &Vec<f64>| self.axes.iter().zip(x).map(|(axis, x)| axis.at(folded(*x))).collect();
        self.asked.iter().take(count).map(at).collect()
    }

    /// Takes the values of the points that [`ask`](Self::ask) gave, in order; `None` for a point without a value, which
    /// counts as the worst. A generation that was cut short ends the search.
    pub fn tell(&mut self, values: &[Option<f64>]) {
        if values.len() < self.asked.len() {
            return;
        }
        let value = |value: &Option<f64>| match (value, self.goal) {
            (None, _) => f64::INFINITY,
            (Some(x), Goal::Least) => *x,
            (Some(x), Goal::Greatest) => -x,
        };
        let values: Vec<f64> = values.iter().map(value).collect();
        self.strategy.tell(&self.asked, &values);
        if self.strategy.is_done() {
            let mut random = SplitMix64(seed(self.seed, self.begun));
            let start = self.axes.iter().map(|_| random.next_f64()).collect();
            let population = self.strategy.population() * POPULATION_GROWTH;
            self.strategy = strategy(&self.axes, start, random.next_u64(), Some(population));
            self.begun += 1;
        }
    }
}

/// Returns a strategy in the unit cube of the axes.
fn strategy(axes: &[Domain], start: Vec<f64>, seed: u64, population: Option<usize>) -> CmaEs {
    let least: Vec<f64> = axes
        .iter()
        .map(|axis| match axis {
            Domain::Values(count) => VALUE_SIGMA / (*count).max(1) as f64,
            Domain::Range(..) => 0.0,
        })
        .collect();
    CmaEs::new(start, SIGMA_START, &least, seed, population)
}

/// Returns the seed of the strategy of this number.
fn seed(seed: u64, number: u64) -> u64 {
    SplitMix64(SplitMix64(seed).next_u64() ^ number).next_u64()
}

/// Returns a coordinate of the whole line folded into [0, 1]: reflected at both ends, so that a bound is no barrier.
fn folded(x: f64) -> f64 {
    let turn = (x / 2.0 - (x / 2.0).floor()) * 2.0;
    if turn > 1.0 { 2.0 - turn } else { turn }
}
