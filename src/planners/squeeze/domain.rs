//! Sets of cells in closed form: arithmetic progressions of cell numbers with nested counters, on which
//! positions are affine.

/// The centre and the side lengths of a cell at an instant, in quarters of its full size, which is the grid of all
/// constructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CellState {
    /// The centre of the cell along x, y, z, in quarters of the full size.
    pub center: [i64; 3],
    /// The lengths of the sides along x, y, z, in quarters of the full size.
    pub size: [i64; 3],
}

/// The side of a cell at its full size, in quarters.
pub(super) const WHOLE: i64 = 4;

impl CellState {
    /// Returns the state of a cell of full size at the lattice site `place`: its lowest corner is at `place` times the
    /// full size.
    pub fn whole(place: [i64; 3]) -> CellState {
        CellState { center: place.map(|x| WHOLE * x + WHOLE / 2), size: [WHOLE; 3] }
    }
}

/// An arithmetic set of cells: those with the numbers `first + Σ stride·k`, for each counter `k` in 0..count.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Domain {
    /// The number of the first cell, from 0.
    pub first: u64,
    /// The counters as (count, stride of the cell's number), outermost first.
    pub counters: Vec<(u64, i64)>,
}

impl Domain {
    /// Returns the domain of these counters, each (count, stride of the cell's number), without those of count 1;
    /// `None` if a count is 0, so that it has no cell.
    pub fn new(first: u64, counters: &[(u64, i64)]) -> Option<Domain> {
        let counters: Vec<(u64, i64)> = counters.iter().copied().filter(|(count, _)| *count != 1).collect();
        counters.iter().all(|(count, _)| *count > 0).then_some(Domain { first, counters })
    }

    /// Returns the number of cells in the set.
    pub fn count(&self) -> u64 {
        self.counters.iter().map(|(count, _)| count).product()
    }
}

/// Splits the cells `lo..hi` into domains: blocks of cells whose numbers share all but their low bits, each split into
/// even and odd numbers. On each of them every function of the number is affine that is a sum of functions of single
/// bits.
pub(super) fn by_bits(lo: u64, hi: u64) -> Vec<Domain> {
    let mut domains = Vec::new();
    let mut at = lo;
    while at < hi {
        let aligned = if at == 0 { 63 } else { at.trailing_zeros() };
        let fits = 63 - (hi - at).leading_zeros();
        let bits = aligned.min(fits);
        domains.extend(free_bits(at, bits, 1));
        at += 1 << bits;
    }
    domains
}

/// Returns the cells `first + low + 2^bits·q`, for all `low` in `0..2^bits` and all `q` in `0..times`, as a domain with
/// `low` even and one with `low` odd; empty if `times` is 0.
pub(super) fn free_bits(first: u64, bits: u32, times: u64) -> Vec<Domain> {
    let counters: Vec<(u64, i64)> =
        std::iter::once((times, 1_i64 << bits)).chain((1..bits).rev().map(|bit| (2, 1_i64 << bit))).collect();
    let parities = if bits == 0 { 0..1 } else { 0..2 };
    parities.filter_map(|parity| Domain::new(first + parity, &counters)).collect()
}
