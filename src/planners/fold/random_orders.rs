//! Random orders of folding, for comparison with a chosen one (Sec. 5.3.2, Fig. 6).

use super::layout::Layout;
use super::observer::Observer;
use super::progress_text;
use super::steps;
use super::tolerances::TOLERANCES;
use crate::optimize::random::SplitMix64;

/// The costs of random orders of folding, compared with a reference, in the unit of the compared quantity: N·m for
/// energies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The number of random orders that were compared.
    pub orders: u64,
    /// The number of orders that cost more than the reference by more than `TOLERANCES.tie` of it.
    pub worse: u64,
    /// The least cost, in the unit of the reference; infinite without orders.
    pub least: f64,
    /// The mean cost, in the unit of the reference; 0 without orders.
    pub mean: f64,
    /// The greatest cost, in the unit of the reference; minus infinity without orders.
    pub greatest: f64,
}

/// Compares the costs of `orders` random orders of a layout's faces with a reference cost. `takes` returns the cost of
/// an order, given as the steps that it was laid into by [`steps::of_order`], in the unit of `reference`. The same
/// `seed` gives the same orders. `observer` receives reports and may end the sampling.
pub fn sample(
    layout: &Layout,
    orders: u64,
    seed: u64,
    reference: f64,
    mut takes: impl FnMut(&[Vec<usize>]) -> f64,
    observer: &Observer,
) -> Sample {
    let mut rng = SplitMix64(seed);
    let mut order: Vec<usize> = layout.order[1..].to_vec();
    order.sort_unstable();
    let mut found = Sample { orders, worse: 0, least: f64::INFINITY, mean: 0.0, greatest: f64::NEG_INFINITY };
    for done in 0..orders {
        let least = (done > 0).then_some(found.least);
        crate::interrupt::checkpoint();
        observer.report(|| progress_text::counted(done, &orders, "orders", least));
        rng.shuffle(&mut order);
        let taken = takes(&steps::of_order(layout, &order));
        found.worse += u64::from(taken > reference * (1.0 + TOLERANCES.tie));
        found.least = found.least.min(taken);
        found.greatest = found.greatest.max(taken);
        found.mean += taken / orders as f64;
    }
    found
}
