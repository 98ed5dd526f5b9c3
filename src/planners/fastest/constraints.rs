//! The limits of a stretch on a grid, as linear inequalities in squared velocities of the parameter s of its path.
//!
//! With `x = ṡ²` at the beginning of an interval of the grid, `y` at its end and constant acceleration `s̈ = (y - x) /
//! 2Δ` between them, each limit is linear in x and y at each point of the interval.

use super::path::Stretch;
use super::tolerances::TOLERANCES;
use super::torque::{AtRest, PathPoint, Torques};
use crate::plan::polynomial::{derivative, value};
use crate::robot::Drive;

/// The points of an interval at which its limits are imposed, as parts of it.
const POINTS: [f64; 3] = [0.0, 0.5, 1.0];

/// The linear inequality `a x + b y <= c`, with `a² + b² = 1`, on the squared velocities x and y at the beginning and
/// the end of an interval of the grid. They are velocities of the path's parameter, so x, y and `c` are in its unit
/// squared per s²; `a` and `b` have no unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HalfPlane {
    /// The factor of the squared velocity at the beginning, without unit.
    pub(super) a: f64,
    /// The factor of the squared velocity at the end, without unit.
    pub(super) b: f64,
    /// The bound, in the unit of the parameter squared, per s².
    pub(super) c: f64,
}

impl HalfPlane {
    /// Returns the inequality `a x + b y <= c`, scaled so that `a² + b² = 1`; `None` if a and b are both 0.
    pub(super) fn new(a: f64, b: f64, c: f64) -> Option<HalfPlane> {
        let size = libm::hypot(a, b);
        (size > 0.0).then(|| HalfPlane { a: a / size, b: b / size, c: c / size })
    }
}

/// The limits of speed, acceleration and torque in one interval of the grid, as inequalities.
pub(super) struct Interval {
    /// The inequalities on the squared velocities at both ends of the interval.
    pub(super) planes: Vec<HalfPlane>,
    /// The torque at rest, at one of the points, that is the greatest part of what may be used of its limit; `None`
    /// where torques do not count.
    pub(super) at_rest: Option<AtRest>,
}

/// Returns positions and derivatives of all joints at a point of an interval of the grid: the fraction `part`, 0 to 1,
/// of the way from the parameter `from` to `to` (rad, m or s, as [`Stretch::path`] says). No piece of the path may end
/// inside the interval.
pub(super) fn point(stretch: &Stretch, from: f64, to: f64, part: f64) -> PathPoint {
    let joints = stretch.start.len();
    let mut point = PathPoint { q: stretch.start.clone(), d: vec![0.0; joints], dd: vec![0.0; joints] };
    let length = to - from;
    for track in &stretch.path {
        let joint = track.joint.0 as usize;
        point.q[joint] = track.position(point.q[joint], from);
        let next = track.segments.partition_point(|s| s.end <= from);
        if let Some(piece) = track.segments.get(next).and_then(|s| s.between(from, to)) {
            let rates = derivative(&piece.control);
            point.q[joint] = value(&piece.control, part);
            point.d[joint] = value(&rates, part) / length;
            point.dd[joint] = value(&derivative(&rates), part) / (length * length);
        }
    }
    point
}

/// Returns the limits in the interval of a grid between two parameters (rad, m or s, as [`Stretch::path`] says),
/// imposed at its beginning, middle and end. `usable`: the fraction, 0 to 1, of each limit of acceleration and of
/// squared speed that may be used; `torques` has its own reserve, and is `None` where torques do not count.
pub(super) fn interval(
    stretch: &Stretch,
    drives: &[Drive],
    torques: Option<&Torques>,
    (from, to): (f64, f64),
    usable: f64,
) -> Interval {
    let mut planes = Vec::new();
    let mut at_rest: Option<AtRest> = None;
    for part in POINTS {
        let point = point(stretch, from, to, part);
        let mut add = |a: f64, b: f64, bound: f64| planes.extend(plane(a, b, bound, part, to - from));
        for drive in drives {
            let sum = |of: &[f64]| drive.terms.iter().map(|&(j, f)| f * of[j]).sum::<f64>();
            let (d, dd) = (small(sum(&point.d)), small(sum(&point.dd)));
            if let Some(limit) = drive.limits.speed {
                add(0.0, d * d, limit * limit * usable);
            }
            if let Some(limit) = drive.limits.acceleration {
                add(d, dd, limit * usable);
                add(-d, -dd, limit * usable);
            }
        }
        if let Some(torques) = torques {
            let rows = torques.rows(&point);
            for row in &rows {
                add(row.a, row.b, left(row.limit, row.c));
                add(-row.a, -row.b, left(row.limit, -row.c));
            }
            at_rest = at_rest.into_iter().chain(AtRest::of(&rows)).reduce(AtRest::greater);
        }
    }
    Interval { planes, at_rest }
}

/// Returns the part of a limit that a torque at rest leaves, N·m or N; negative if it is over the limit, but 0 if by no
/// more than the part `TOLERANCES.torque`.
fn left(limit: f64, at_rest: f64) -> f64 {
    let left = limit - at_rest;
    if left < 0.0 && left >= -TOLERANCES.torque * limit { 0.0 } else { left }
}

/// Returns a derivative, or 0 if it is rounding.
fn small(derivative: f64) -> f64 {
    if derivative.abs() < TOLERANCES.derivative { 0.0 } else { derivative }
}

/// Returns the inequality `a s̈ + b ṡ² <= bound` at a part, from 0 to 1, of an interval of a length, in x and y.
fn plane(a: f64, b: f64, bound: f64, part: f64, length: f64) -> Option<HalfPlane> {
    let per = a / (2.0 * length);
    HalfPlane::new(b * (1.0 - part) - per, b * part + per, bound)
}
