//! Orders of folding at random, for comparison with a chosen one (Sec. 5.3.2, Fig. 6).

use super::layout::Layout;
use super::progress_text;
use super::steps;
use crate::interrupt;
use crate::planners::random::SplitMix64;

/// Random orders are worse where they take more by this part.
const TOL_EQUAL: f64 = 1e-9;

/// What random orders take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub orders: u64,
    /// How many of them take more than what they are compared with.
    pub worse: u64,
    pub least: f64,
    pub mean: f64,
    pub greatest: f64,
}

/// Compares `orders` random orders, each laid into steps, with something that takes `reference`.
pub fn sample(
    layout: &Layout,
    orders: u64,
    seed: u64,
    reference: f64,
    mut takes: impl FnMut(&[Vec<usize>]) -> f64,
) -> Sample {
    let mut rng = SplitMix64(seed);
    let mut order: Vec<usize> = layout.order[1..].to_vec();
    order.sort_unstable();
    let mut found = Sample { orders, worse: 0, least: f64::INFINITY, mean: 0.0, greatest: f64::NEG_INFINITY };
    for done in 0..orders {
        let least = (done > 0).then_some(found.least);
        interrupt::progress_checkpoint(|| progress_text::counted(done, &orders, "orders", least));
        rng.shuffle(&mut order);
        let taken = takes(&steps::of_order(layout, &order));
        found.worse += u64::from(taken > reference * (1.0 + TOL_EQUAL));
        found.least = found.least.min(taken);
        found.greatest = found.greatest.max(taken);
        found.mean += taken / orders as f64;
    }
    found
}
