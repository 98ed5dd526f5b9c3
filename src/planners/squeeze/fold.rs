//! Fold: the paper's sequence (Lemmas 2 to 5), mended, for any number of cells.
//!
//! Each fold halves all rows: they are squeezed, pairs of neighbours become boxes, in every box one
//! cell goes down and one up, both widen, and the rows spread out. The cell that goes up alternates from box to
//! box and from row to row, so that neighbouring boxes stay in contact over faces.
//!
//! In bits: before fold `k` cell `i` is at `i >> k` of its row; it goes up in the fold if bits 0 and `k + 1`
//! of `i` differ. So its row, written in bits, is `(i0 ^ i1) (i0 ^ i2) .. (i0 ^ ik)`, and all positions are
//! affine in the bits of cells of one parity. The partner of an odd last cell is missing, and nothing else
//! changes: until the last fold no row is empty. In the last fold rows of one cell stay one row, and cells
//! are counted.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE, by_bits, free_bits};
use super::motion::{Builder, Motion, PlanLimits};
use super::ranks;

const HALF: i64 = WHOLE / 2;
const QUARTER: i64 = WHOLE / 4;

/// Returns the motion from a row of `count` cells along x, at least one, with cell `i` (from 0) at lattice site (i,
/// 0, 0), to a column along y, by [Reif and Slee](super)'s folds (Lemmas 2 to 5). Cells must be able to shrink to
/// half their size. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn fold(limits: PlanLimits, count: u64) -> Result<Motion, Refusal> {
    let folds = u64::BITS - (count - 1).leading_zeros();
    let mut builder = Builder::new(limits, count, &parts(count, 0), |i| whole(i, 0))?;
    for k in 0..folds {
        // Rows of one cell, in the last fold: theirs are the cells before this one.
        let lone = if k + 1 == folds { (1 << folds) - count } else { 0 };
        let domains = if lone > 0 { lone_parts(count, folds, lone) } else { parts(count, k) };
        builder.stage("x-squeeze", HALF, &domains, move |i| squeezed(i, k))?;
        builder.stage("widen-lone", QUARTER, &domains, move |i| widened(i, k, lone))?;
        builder.stage("swap-contract", HALF, &domains, move |i| contracted(i, k, lone))?;
        builder.stage("swap-expand", HALF, &domains, move |i| stacked(i, k, lone))?;
        if lone > 0 {
            let (domains, rank) = ranks::of(count, folds);
            builder.stage("y-expand", HALF, &domains, move |i| CellState::whole([0, rank(i), 0]))?;
        } else {
            builder.stage("y-expand", HALF, &domains, move |i| whole(i, k + 1))?;
        }
    }
    Ok(builder.motion())
}

/// Returns the index, from 0, of the row in which cell `i` is before fold `k` (from 0).
pub(super) fn row(i: u64, k: u32) -> u64 {
    let differing = if i & 1 == 1 { !i } else { i };
    // Bit 1 is the first, and the highest.
    if k == 0 { 0 } else { (differing >> 1).reverse_bits() >> (u64::BITS - k) }
}

/// Returns the state of a cell before fold `k`, which is that after the one before.
fn whole(i: u64, k: u32) -> CellState {
    CellState::whole([(i >> k) as i64, row(i, k) as i64, 0])
}

/// Returns the state in which rows are squeezed to half their length.
fn squeezed(i: u64, k: u32) -> CellState {
    let mut state = whole(i, k);
    state.center[0] = HALF * (i >> k) as i64 + QUARTER;
    state.size[0] = HALF;
    state
}

/// Returns the state in which the cells of rows of one cell have their full size again.
fn widened(i: u64, k: u32, lone: u64) -> CellState {
    if i < lone { whole(i, k) } else { squeezed(i, k) }
}

/// Returns the state in which of each box one cell is in the upper half and the other in the lower.
fn contracted(i: u64, k: u32, lone: u64) -> CellState {
    let mut state = widened(i, k, lone);
    if i >= lone {
        let up = (i ^ (i >> (k + 1))) & 1 == 1;
        state.center[1] += if up { QUARTER } else { -QUARTER };
        state.size[1] = HALF;
    }
    state
}

/// Returns the state in which both cells of a box have its whole width.
fn stacked(i: u64, k: u32, lone: u64) -> CellState {
    let mut state = contracted(i, k, lone);
    state.center[0] = WHOLE * (i >> (k + 1)) as i64 + HALF;
    state.size[0] = WHOLE;
    state
}

/// Returns domains on which all states in fold `k` are affine.
fn parts(count: u64, k: u32) -> Vec<Domain> {
    let bits = k + 2;
    let times = count >> bits;
    let mut domains = if times > 0 { free_bits(0, bits, times) } else { vec![] };
    domains.extend(by_bits(times << bits, count));
    domains
}

/// Returns the same in the last fold, in which rows of one cell differ from those of two.
fn lone_parts(count: u64, folds: u32, lone: u64) -> Vec<Domain> {
    let half = 1 << (folds - 1);
    [(0, lone), (lone, half), (half, count)].into_iter().flat_map(|(lo, hi)| by_bits(lo, hi)).collect()
}
