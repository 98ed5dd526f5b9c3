//! Folds of boxes: Lemma 4 of the paper in any plane, one after another. Each halves one side and
//! doubles another, so the sides change by powers of two.

use super::Refusal;
use super::domain::{CellState, WHOLE};
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};

const HALF: i64 = WHOLE / 2;
const QUARTER: i64 = WHOLE / 4;

/// Returns the motion from a box with the sides `from` along x, y, z, in cells, to one with the sides `to`, by folds
/// of boxes (Lemma 4 of [Reif and Slee](super)); `None` unless they have as many cells and each pair of sides differs
/// by a power of two. Cells are numbered from 0, along x first, then y, then z. They must be able to shrink to half
/// their size, and sides be positive; neither is checked, and a side of 0 panics. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn halve(limits: PlanLimits, from: [u64; 3], to: [u64; 3]) -> Option<Result<Motion, Refusal>> {
    let folds = folds(from, to)?;
    let mut positions: Vec<[i64; 3]> = Vec::new();
    for z in 0..from[2] {
        for y in 0..from[1] {
            positions.extend((0..from[0]).map(|x| [x as i64, y as i64, z as i64]));
        }
    }
    let mut motion = Listed::new(positions.iter().map(|place| CellState::whole(*place)).collect());
    for (a, b) in folds {
        fold(&mut motion, &mut positions, a, b);
    }
    let numbers: Vec<u64> = (0..positions.len() as u64).collect();
    Some(motion.into_motion(limits, &numbers))
}

/// Returns the sides halved and doubled in each fold, the longest and the shortest first; `None` unless folds lead from
/// the one box to the other.
fn folds(from: [u64; 3], to: [u64; 3]) -> Option<Vec<(usize, usize)>> {
    let (mut sides, mut folds) = (from, Vec::new());
    let powers = (0..3).all(|k| {
        let (low, high) = (from[k].min(to[k]), from[k].max(to[k]));
        high % low == 0 && (high / low).is_power_of_two()
    });
    if !powers || from.iter().product::<u64>() != to.iter().product::<u64>() {
        return None;
    }
    while sides != to {
        let a = (0..3).filter(|&k| sides[k] > to[k]).max_by_key(|&k| sides[k])?;
        let b = (0..3).filter(|&k| sides[k] < to[k]).min_by_key(|&k| sides[k])?;
        sides[a] /= 2;
        sides[b] *= 2;
        folds.push((a, b));
    }
    Some(folds)
}

/// Appends a fold that halves side `a` and doubles side `b` (Lemma 4); the third side stays.
fn fold(motion: &mut Listed, positions: &mut [[i64; 3]], a: usize, b: usize) {
    // Neighbouring boxes swap in opposite senses, so that they stay in contact over faces.
    let up = |place: [i64; 3]| (place[a] + (place[a] >> 1) + place[b]) & 1;
    let names = |names: [&'static str; 3], axis: usize| names[axis];
    let at: Vec<[i64; 3]> = positions.to_vec();
    motion.stage(names(["x-squeeze", "y-squeeze", "z-squeeze"], a), |i, state| {
        state.center[a] = HALF * at[i][a] + QUARTER;
        state.size[a] = HALF;
    });
    motion.stage("swap-contract", |i, state| {
        state.center[b] += if up(at[i]) == 1 { QUARTER } else { -QUARTER };
        state.size[b] = HALF;
    });
    motion.stage("swap-expand", |i, state| {
        state.center[a] = WHOLE * (at[i][a] >> 1) + HALF;
        state.size[a] = WHOLE;
    });
    for place in positions.iter_mut() {
        let high = up(*place);
        place[a] >>= 1;
        place[b] = 2 * place[b] + high;
    }
    motion.stage(names(["x-expand", "y-expand", "z-expand"], b), |i, state| {
        state.center[b] = WHOLE * positions[i][b] + HALF;
        state.size[b] = WHOLE;
    });
}
