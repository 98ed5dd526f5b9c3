//! The column at the end of the last fold: how many cells are below each, in closed form.
//!
//! With all bits folded, a cell's row is a number of as many bits; where the count is no power of two,
//! some rows are empty, and a cell's place is the number of cells in rows below its own.

use super::domain::Domain;
use super::fold::row;
use std::collections::HashMap;

/// Places in the column, and domains on which they (and all that is affine in bits) are affine.
pub fn of(count: u64, folds: u32) -> (Vec<Domain>, impl Fn(u64) -> i64) {
    let mut order: Vec<u64> = (0..count).collect();
    order.sort_by_key(|&i| row(i, folds));
    let mut places = vec![0_i64; count as usize];
    order.iter().enumerate().for_each(|(place, &i)| places[i as usize] = place as i64);
    let lone = (1 << folds) - count;
    let domains = parts(&places, folds, lone);
    (domains, move |i| places[i as usize])
}

/// A run of cells from bits: relative to the first, how far the second of each bit is in place.
struct Run {
    first: u64,
    /// Stride and difference of places, innermost first.
    bits: Vec<(u64, i64)>,
}

fn parts(places: &[i64], folds: u32, lone: u64) -> Vec<Domain> {
    let half = 1 << (folds - 1);
    let mut domains = Vec::new();
    for (lo, hi) in [(0, lone), (lone, half), (half, places.len() as u64)] {
        for block in super::domain::by_bits(lo, hi) {
            let bits: Vec<u64> = block.counters.iter().rev().map(|(_, stride)| *stride as u64).collect();
            for run in merged(places, block.first, &bits) {
                let counters: Vec<(u64, i64)> =
                    run.bits.iter().rev().map(|(stride, _)| (2, *stride as i64)).collect();
                domains.extend(Domain::new(run.first, &counters));
            }
        }
    }
    domains
}

/// Runs of the cells `first + Σ bits`, bits in rising order: those of the halves without the highest
/// bit, joined where they differ by a constant.
fn merged(places: &[i64], first: u64, bits: &[u64]) -> Vec<Run> {
    let Some((&bit, lower)) = bits.split_last() else { return vec![Run { first, bits: vec![] }] };
    let low = merged(places, first, lower);
    let high = merged(places, first + bit, lower);
    let mut by_shape: HashMap<(u64, &[(u64, i64)]), usize> = HashMap::new();
    for (index, run) in high.iter().enumerate() {
        by_shape.insert((run.first - bit, &run.bits), index);
    }
    let mut taken = vec![false; high.len()];
    let mut joined = Vec::with_capacity(low.len());
    for mut run in low {
        if let Some(&index) = by_shape.get(&(run.first, run.bits.as_slice())) {
            taken[index] = true;
            let difference = places[(run.first + bit) as usize] - places[run.first as usize];
            run.bits.push((bit, difference));
        }
        joined.push(run);
    }
    drop(by_shape);
    joined.extend(high.into_iter().zip(taken).filter(|(_, taken)| !taken).map(|(run, _)| run));
    joined
}
