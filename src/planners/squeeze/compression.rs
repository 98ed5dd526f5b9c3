//! The squeeze problem of the paper (Lemmas 1 and 2): all cells of a shape shrink along axes, and the whole shape with
//! them, in one stage at the end of a motion. Backwards it is the expansion.

use super::Refusal;
use super::motion::{Motion, PlanLimits, Transition, distance_bound, least_time};
use super::shape::Shape;
use crate::plan::{Ratio, Run};

/// Appends to a motion that ends in a shape the stage in which all cells shrink to the sides `sides` along x, y, z, in
/// parts of their size, each from above 0 to 1, and are drawn together about the centre of mass so that contacts last. A
/// row of n cells takes √(2 (1 - s) (n - 1)) units of time to the side s, unless the speed limit binds (Lemma 2 of [Reif and
/// Slee](super) for s = 1/2). Without a change the motion stays as it is. No cell may stand fast, which is not checked.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn compressed(
    mut motion: Motion,
    limits: PlanLimits,
    shape: &Shape,
    sides: [Ratio; 3],
) -> Result<Motion, Refusal> {
    if sides == [Ratio::ONE; 3] {
        return Ok(motion);
    }
    let (time_squared, law) = stage_time(limits, shape, sides).ok_or(Refusal::TooLarge)?;
    let last = motion.configurations.last().and_then(Option::as_ref).expect("the last is stated always");
    let end: Vec<Run> =
        last.iter().map(|run| scaled(run, sides)).collect::<Option<_>>().ok_or(Refusal::TooLarge)?;
    let balanced = is_balanced(shape, sides);
    motion.transitions.push(Transition { name: "squeeze", time_squared, law, balanced, moves: None });
    motion.configurations.push(Some(end));
    Ok(motion)
}

/// Returns the square of the least time of the stage with its time law; `None` if a number does not fit.
fn stage_time(limits: PlanLimits, shape: &Shape, sides: [Ratio; 3]) -> Option<(Ratio, crate::plan::Law)> {
    let count = i128::from(shape.count());
    // All displacements in parts of `whole` cells: a cell at x about the centre of mass goes (1 - s) x.
    let denominator = sides.iter().try_fold(1_i128, |all, side| all.checked_mul(side.1.into()))?;
    let whole = denominator.checked_mul(count)?;
    let mut farthest = [0; 3];
    let mut shrinkage = Ratio::ZERO;
    for (axis, side) in sides.into_iter().enumerate() {
        let sum: i128 = shape.positions.iter().map(|p| i128::from(p[axis])).sum();
        let from_centre = |p: &[i64; 3]| (i128::from(p[axis]) * count - sum).abs();
        let reach = shape.positions.iter().map(from_centre).max().unwrap_or(0);
        let lost = i128::from(side.1 - side.0) * (denominator / i128::from(side.1));
        farthest[axis] = reach.checked_mul(lost)?;
        let part = Ratio::new((side.1 - side.0).into(), side.1.into())?;
        if part.order(shrinkage).is_gt() {
            shrinkage = part;
        }
    }
    // Two cells in contact part by at most as much as a cell shrinks.
    least_time(&limits, distance_bound(farthest, whole, limits.euclidean)?, shrinkage)
}

/// Returns cells that are drawn together about the centre of mass, and shrink; `None` if a number does not fit.
fn scaled(run: &Run, sides: [Ratio; 3]) -> Option<Run> {
    let along = |values: [Ratio; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| values[axis].times(sides[axis]));
        Some([x?, y?, z?])
    };
    let mut scaled = run.clone();
    scaled.center = along(run.center)?;
    scaled.size = along(run.size)?;
    for counter in &mut scaled.counters {
        counter.step = along(counter.step)?;
    }
    Some(scaled)
}

/// Returns true if the angular momentum stays zero: for each two axes the shape shrinks alike along both, or the
/// product of inertia of the two is zero.
fn is_balanced(shape: &Shape, sides: [Ratio; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(a, b)| {
        let along = |axis: usize| shape.positions.iter().map(move |p| i128::from(p[axis]));
        let products: i128 = along(a).zip(along(b)).map(|(x, y)| x * y).sum();
        let (first, second): (i128, i128) = (along(a).sum(), along(b).sum());
        sides[a].order(sides[b]).is_eq() || products * i128::from(shape.count()) == first * second
    })
}
