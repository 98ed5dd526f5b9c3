//! Ranks of cells in the column at the end of the last fold, in closed form.
//!
//! With all bits folded, a cell's row is a number of as many bits; where the count is no power of two, some
//! rows are empty, and a cell's index is the number of cells in rows below its own.

use super::domain::{Domain, by_bits};
use std::collections::{BTreeMap, HashMap};

/// Returns (domains, index) of the column at the end of `folds` folds of a row of `count` cells: the index (from 0)
/// that a cell has in the column, as a function of the cell's number, and the domains on each of which this function
/// is affine. `folds` must be at least 1, and `count` at most `2^folds` and more than half of it.
pub(super) fn of(count: u64, folds: u32) -> (Vec<Domain>, impl Fn(u64) -> i64) {
    let mut places = vec![0_i64; count as usize];
    let rows = (0..1 << folds).map(|row| cell_of(row, folds)).filter(|&cell| cell < count);
    rows.enumerate().for_each(|(place, cell)| places[cell as usize] = place as i64);
    let lone = (1 << folds) - count;
    let domains = parts(&places, folds, lone);
    (domains, move |i| places[i as usize])
}

/// Returns the cell that `folds` folds bring to a row: the inverse of `fold::row`.
fn cell_of(row: u64, folds: u32) -> u64 {
    let first = row & 1;
    let differing = (row.reverse_bits() >> (u64::BITS - folds)) << 1;
    let all = ((1 << folds) - 1) << 1;
    (if first == 1 { differing ^ all } else { differing }) | first
}

/// A run of cells from bits.
struct Run {
    first: u64,
    bits: Bits,
}

/// The stride and difference of indices of each bit, innermost first.
type Bits = Vec<(u64, i64)>;

/// Returns domains on which the indices in the column are affine.
fn parts(places: &[i64], folds: u32, lone: u64) -> Vec<Domain> {
    let half = 1 << (folds - 1);
    // The ends of the column are counted in multiples of this: on the bits below, indices are affine.
    let even = (places.len() as u64).trailing_zeros() as usize;
    let mut domains = Vec::new();
    for (lo, hi) in [(0, lone), (lone, half), (half, places.len() as u64)] {
        let mut runs: [Vec<Run>; 2] = [vec![], vec![]];
        for block in by_bits(lo, hi) {
            let bits: Vec<u64> = block.counters.iter().rev().map(|(_, stride)| *stride as u64).collect();
            runs[(block.first & 1) as usize].extend(merged(
                places,
                block.first,
                &bits,
                even.saturating_sub(1),
            ));
        }
        for run in runs.into_iter().flat_map(|runs| paired(runs, places)) {
            let counters: Vec<(u64, i64)> =
                run.bits.iter().rev().map(|(stride, _)| (2, *stride as i64)).collect();
            domains.extend(Domain::new(run.first, &counters));
        }
    }
    domains
}

/// Returns runs of the cells `first + Σ bits`, bits in rising order: the runs of the two halves by the
/// highest bit, merged where they differ by a constant. On the lowest `free` bits indices are affine.
fn merged(places: &[i64], first: u64, bits: &[u64], free: usize) -> Vec<Run> {
    let difference = |first: u64, bit: u64| places[(first + bit) as usize] - places[first as usize];
    let Some((&bit, lower)) = bits.split_last().filter(|_| bits.len() > free) else {
        return vec![Run { first, bits: bits.iter().map(|&bit| (bit, difference(first, bit))).collect() }];
    };
    let low = merged(places, first, lower, free);
    let high = merged(places, first + bit, lower, free);
    let mut taken = vec![false; high.len()];
    let mut joined = Vec::with_capacity(low.len());
    if let ([one], [other]) = (&low[..], &high[..]) {
        // The usual case, without a table.
        taken[0] = one.first + bit == other.first && one.bits == other.bits;
        joined.extend(low);
        if taken[0] {
            let run = &mut joined[0];
            run.bits.push((bit, difference(run.first, bit)));
        }
    } else {
        let mut by_shape: HashMap<(u64, &Bits), usize> = HashMap::with_capacity(high.len());
        for (index, run) in high.iter().enumerate() {
            by_shape.insert((run.first - bit, &run.bits), index);
        }
        for mut run in low {
            if let Some(&index) = by_shape.get(&(run.first, &run.bits)) {
                taken[index] = true;
                run.bits.push((bit, difference(run.first, bit)));
            }
            joined.push(run);
        }
    }
    joined.extend(high.into_iter().zip(taken).filter(|(_, taken)| !taken).map(|(run, _)| run));
    joined
}

/// Pairs runs of the same form as long as there are any: two of a form are always affine images of each other.
fn paired(mut runs: Vec<Run>, places: &[i64]) -> Vec<Run> {
    loop {
        let before = runs.len();
        let mut by_form: BTreeMap<Bits, Vec<u64>> = BTreeMap::new();
        for run in runs {
            by_form.entry(run.bits).or_default().push(run.first);
        }
        runs = Vec::with_capacity(before);
        for (bits, mut firsts) in by_form {
            firsts.sort_unstable();
            for pair in firsts.chunks(2) {
                let mut bits = bits.clone();
                if let [a, b] = pair {
                    bits.push((b - a, places[*b as usize] - places[*a as usize]));
                }
                runs.push(Run { first: pair[0], bits });
            }
        }
        if runs.len() == before {
            return runs;
        }
    }
}
