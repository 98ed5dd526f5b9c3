//! Reachability analysis on a grid (Pham and Pham 2018, Algorithm 1): backward the controllable sets, forward the
//! greatest velocity.

use super::constraints::{HalfPlane, Interval};
use super::tolerances::TOLERANCES;

/// The greatest squared velocity of the path's parameter that is considered, in the parameter's unit squared per s². A
/// stretch that could go at half of it counts as one without a limit.
pub(super) const SQUARE_MAX: f64 = 1e12;

/// The reason why reachability analysis gives no velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Failing {
    /// The controllable set of a point is empty: from no velocity there the end is reached within the limits.
    Empty,
    /// The controllable set of a point has no bound.
    Unlimited,
}

/// Returns the greatest squared velocity of the path's parameter (its unit squared per s²) at each point of the grid,
/// from beginning to end (Pham and Pham 2018, Algorithm 1). `intervals`: the limits, by interval. `free`: for beginning
/// and end, true if any velocity is allowed there; then the acceleration of the parameter is zero in the interval
/// beside it. Otherwise the velocity is zero there.
///
/// # Errors
/// [`Failing::Empty`] if no velocity at some point leads to the end within the limits, [`Failing::Unlimited`] if
/// nothing limits it.
pub(super) fn squares(intervals: &[Interval], free: [bool; 2]) -> Result<Vec<f64>, Failing> {
    let count = intervals.len();
    // Backward: the controllable set of each point, an interval.
    let mut sets = vec![(0.0, 0.0); count + 1];
    sets[count].1 = if free[1] { SQUARE_MAX } else { 0.0 };
    for index in (0..count).rev() {
        let flat = (index == 0 && free[0]) || (index + 1 == count && free[1]);
        let planes = &intervals[index].planes;
        let range = match flat {
            true => chord(planes, (0.0, 0.0), (1.0, 1.0), sets[index + 1]),
            false => range(planes, sets[index + 1]),
        };
        sets[index] = range.ok_or(Failing::Empty)?;
        if sets[index].1 > SQUARE_MAX / 2.0 {
            return Err(Failing::Unlimited);
        }
    }
    // Forward: the greatest velocity from point to point.
    let first = if free[0] { sets[0].1 } else { 0.0 };
    if first < sets[0].0 {
        return Err(Failing::Empty);
    }
    let mut found = vec![first];
    for (index, interval) in intervals.iter().enumerate() {
        let x = found[index];
        let flat = (index == 0 && free[0]) || (index + 1 == count && free[1]);
        let next = sets[index + 1];
        let y = match flat {
            true => x,
            false => {
                // Rounding may leave nothing: then the nearest of what can be held.
                let reached = chord(&interval.planes, (x, 0.0), (0.0, 1.0), next);
                reached.map_or_else(|| x.clamp(next.0, next.1), |(_, y)| y)
            }
        };
        found.push(y);
    }
    Ok(found)
}

/// Returns the least and greatest `t` for which `(x, y) = origin + t direction` fulfils all inequalities, with x from 0
/// to [`SQUARE_MAX`] and y in a range; `None` if there is none. The direction has a length of about 1.
fn chord(
    planes: &[HalfPlane],
    origin: (f64, f64),
    direction: (f64, f64),
    y: (f64, f64),
) -> Option<(f64, f64)> {
    let bounds = [
        HalfPlane { a: -1.0, b: 0.0, c: 0.0 },
        HalfPlane { a: 1.0, b: 0.0, c: SQUARE_MAX },
        HalfPlane { a: 0.0, b: -1.0, c: -y.0 },
        HalfPlane { a: 0.0, b: 1.0, c: y.1 },
    ];
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for plane in bounds.iter().chain(planes) {
        let slope = plane.a * direction.0 + plane.b * direction.1;
        let left = plane.c - plane.a * origin.0 - plane.b * origin.1;
        if slope.abs() <= TOLERANCES.parallel {
            let scale = origin.0.abs().max(origin.1.abs()).max(plane.c.abs());
            if left < -TOLERANCES.slack * scale {
                return None;
            }
        } else if slope > 0.0 {
            high = high.min(left / slope);
        } else {
            low = low.max(left / slope);
        }
    }
    // A single point, up to rounding, is kept.
    let slack = TOLERANCES.slack * high.abs().max(low.abs());
    (low <= high + slack).then(|| (low.min(high), high))
}

/// Returns the least and greatest x, not negative, for which there is a y in a range such that all inequalities hold;
/// `None` if there is none. A linear program in two variables by incremental construction (Seidel 1991), in the order
/// of the inequalities.
fn range(planes: &[HalfPlane], y: (f64, f64)) -> Option<(f64, f64)> {
    let low = extreme(planes, y, -1.0)?;
    let high = extreme(planes, y, 1.0)?;
    Some((low.max(0.0).min(high), high))
}

/// Returns the greatest (`sign` 1) or least (-1) x from 0 to [`SQUARE_MAX`] for which there is a y in a range such that
/// all inequalities hold; `None` if there is none.
fn extreme(planes: &[HalfPlane], y: (f64, f64), sign: f64) -> Option<f64> {
    let mut at = (if sign > 0.0 { SQUARE_MAX } else { 0.0 }, y.0);
    for (index, plane) in planes.iter().enumerate() {
        let scale = (plane.a * at.0).abs().max((plane.b * at.1).abs()).max(plane.c.abs());
        if plane.a * at.0 + plane.b * at.1 <= plane.c + TOLERANCES.parallel * scale {
            continue;
        }
        // The optimum lies on the border of the inequality that is violated.
        let origin = (plane.a * plane.c, plane.b * plane.c);
        let direction = (-plane.b, plane.a);
        let (low, high) = chord(&planes[..index], origin, direction, y)?;
        let t = if direction.0 * sign >= 0.0 { high } else { low };
        at = (origin.0 + t * direction.0, origin.1 + t * direction.1);
    }
    Some(at.0)
}
