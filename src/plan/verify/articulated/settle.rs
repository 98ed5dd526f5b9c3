//! Settling: the attitude near a given one in which the centre of mass is lowest, by a proximal bundle method.
//!
//! Standing on level ground with its own "up" `u`, a robot's centre of mass is at the height
//! `H(u) = max u·(c - p)` over its points p. An attitude of rest is a local minimum of H. It is found by a
//! proximal bundle method: the points near the ground make planes under H, and the lowest point of those
//! planes, not too far away, is the next trial.

use super::alignment::rotation;
use super::tolerances::NUMERICS;
use super::tolerances::Tolerances;
use crate::geometry::Mat3;
use crate::geometry::Vec3;
use crate::geometry::ground_features::Feature;
use crate::plan::verify::support_polygon;

/// The greatest trial turn, rad (2°).
const STEP_MAX: f64 = 0.034_906_585_039_886_59;
/// The fraction of the predicted fall that a trial must show.
const ACCEPTED_PART: f64 = 0.1;
/// Weight of long turns at the beginning, rad²/m, for robots of up to a metre.
const REACH_START: f64 = 1e3;
/// The number of lowest points that a refused trial adds to the bundle.
const KEPT_POINTS: usize = 6;
/// The greatest number of points that the bundle holds.
const BUNDLE_MAX: usize = 60;
/// The greatest number of rounds of descent.
const ROUNDS_MAX: usize = 400;
/// The greatest number of changes of the basis.
const BASES_MAX: usize = 500;
/// The greatest number of shortenings of a step.
const SHORTENINGS_MAX: usize = 60;
/// The greatest number of times that the line of gravity is found anew on a slope: two or three suffice for what rests.
const SLOPE_ROUNDS_MAX: usize = 40;

/// The attitude at which settling ended.
#[derive(Clone, Debug)]
pub(super) struct SettledAttitude {
    /// The rotation from the attitude at which settling began to this one, in the world's axes.
    pub turn: Mat3,
    /// The height of the centre of mass above the lowest point of the robot, m.
    pub height: f64,
    /// The fall of the centre of mass on the way, m.
    pub fall: f64,
}

/// Returns the height of the centre of mass, the origin, above the lowest point of the features, m, along the unit
/// vector `up`; minus infinity without features.
pub(super) fn height(features: &[Feature], up: &Vec3) -> f64 {
    -features.iter().map(|feature| feature.lowest(up)).fold(f64::INFINITY, f64::min)
}

/// Returns the attitude near the present one at which a robot comes to rest, a local minimum of the height of its
/// centre of mass, by the proximal bundle method; after [`ROUNDS_MAX`] rounds the lowest found. `features`: with the
/// centre of mass at the origin and z upwards, m.
pub(super) fn settle(features: &[Feature], tolerances: &Tolerances) -> SettledAttitude {
    let reach = features.iter().map(Feature::reach).fold(0.0, f64::max);
    let mut turn = Mat3::identity();
    let start = height(features, &Vec3::z());
    let mut level = start;
    let mut bundle: Vec<Vec3> = Vec::new();
    let mut step = STEP_MAX;
    let mut rounds = 0;
    while rounds < ROUNDS_MAX {
        rounds += 1;
        let planes = planes(features, &bundle, &turn, level, 2.0 * reach * step);
        let (omega, bottom) = trial(&planes, step, reach);
        if level - bottom < tolerances.fall_min {
            match perturbed(features, &turn, level, tolerances) {
                Some((perturbed, lower)) => {
                    (turn, level) = (perturbed, lower);
                    continue;
                }
                None => break,
            }
        }
        let tried = rotation(omega) * turn;
        let up = tried.transpose() * Vec3::z();
        let lower = height(features, &up);
        if level - lower >= ACCEPTED_PART * (level - bottom) {
            (turn, level) = (tried, lower);
            step = STEP_MAX.min(2.0 * step);
        } else {
            keep_lowest(&mut bundle, features, &up, lower);
            step = step.min(omega.norm()) / 2.0;
        }
    }
    SettledAttitude { turn, height: level, fall: start - level }
}

/// Returns the attitude near the present one at which a robot comes to rest on a slope, where friction holds what touches
/// it: the line of gravity through its centre of mass then meets the ground within what supports it. `lean`: the shift of
/// that line for each metre that it comes nearer to the ground; others as for [`settle`].
///
/// Seen from the ground, the weight acts as if it were that of a point as high as the centre of mass, straight above the
/// place where the line of gravity meets the ground: the robot settles as on level ground with that point in the place of
/// the centre of mass, which is found anew until nothing turns. A robot that rolls on after [`SLOPE_ROUNDS_MAX`] rounds,
/// such as a ball, has no attitude of rest: it keeps its own, from which it falls.
pub(super) fn settle_on_slope(
    features: &[Feature],
    lean: [f64; 2],
    tolerances: &Tolerances,
) -> SettledAttitude {
    if lean == [0.0, 0.0] {
        return settle(features, tolerances);
    }
    let mut turned = features.to_vec();
    let mut found = SettledAttitude { turn: Mat3::identity(), height: 0.0, fall: 0.0 };
    for _ in 0..SLOPE_ROUNDS_MAX {
        let level = height(&turned, &Vec3::z());
        let foot = Vec3::new(lean[0] * level, lean[1] * level, 0.0);
        let shifted: Vec<Feature> = turned.iter().map(|f| f.placed(&Mat3::identity(), &-foot)).collect();
        let rest = settle(&shifted, tolerances);
        found.turn = rest.turn * found.turn;
        found.fall += rest.fall;
        turned = turned.iter().map(|f| f.placed(&rest.turn, &Vec3::zeros())).collect();
        if (rest.turn - Mat3::identity()).amax() < NUMERICS.slope_turn {
            found.height = height(&turned, &Vec3::z());
            return found;
        }
    }
    SettledAttitude { turn: Mat3::identity(), height: height(features, &Vec3::z()), fall: found.fall }
}

/// A point near the ground as a plane under H: `a + b·ω` for a small turn ω = (x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
struct SupportPlane {
    /// The height of the centre of mass over the point, m.
    a: f64,
    /// The change of that height with the turn about x and y, m/rad.
    b: [f64; 2],
}

impl SupportPlane {
    /// Returns the plane of a point at `p` from the centre of mass, m, with z up.
    fn of(p: &Vec3) -> SupportPlane {
        SupportPlane { a: -p.z, b: [-p.y, p.x] }
    }

    /// Returns the height of the plane at a small turn (rad), m.
    fn at(&self, omega: &[f64; 2]) -> f64 {
        self.a + self.b[0] * omega[0] + self.b[1] * omega[1]
    }
}

/// Returns the planes of the features whose lowest points are at most `gap_max` (m) above the ground, so that a turn of
/// the present step could bring them down to it, and of the bundle. `level`: the height of the centre of mass, m.
fn planes(features: &[Feature], bundle: &[Vec3], turn: &Mat3, level: f64, gap_max: f64) -> Vec<SupportPlane> {
    let up = turn.transpose() * Vec3::z();
    let mut planes = Vec::new();
    let (mut plane, mut points) = (None, Vec::new());
    for feature in features.iter().filter(|feature| feature.lowest(&up) + level <= gap_max) {
        points.clear();
        feature.points_below(&up, f64::INFINITY, &mut plane, &mut points);
        planes.extend(points.iter().map(|(_, p)| SupportPlane::of(&(turn * p))));
    }
    planes.extend(bundle.iter().map(|p| SupportPlane::of(&(turn * p))));
    planes
}

/// Returns the rotation vector of the turn to try, not longer than `step` (rad), and the height of the highest plane
/// there, m. `reach`: the greatest distance of a point from the centre of mass, m.
fn trial(planes: &[SupportPlane], step: f64, reach: f64) -> (Vec3, f64) {
    let mut tau = REACH_START / reach.max(1.0) / reach.max(1.0);
    let mut basis = lowest_bundle(planes, tau);
    for _ in 0..SHORTENINGS_MAX {
        let n = libm::hypot(basis.omega[0], basis.omega[1]);
        if n <= step {
            break;
        }
        tau *= 0.95 * step / n;
        basis = lowest_bundle(planes, tau);
    }
    (Vec3::new(basis.omega[0], basis.omega[1], 0.0), basis.t)
}

/// A solution of `min t + |ω|²/2τ` with t above a few planes.
#[derive(Clone, Debug)]
struct Basis {
    /// The planes, one to three.
    planes: Vec<SupportPlane>,
    /// The turn ω about x and y, rad.
    omega: [f64; 2],
    /// The height t, m.
    t: f64,
    /// The value that is minimised, m.
    value: f64,
}

/// Solves `min t + |ω|²/2τ` with t above all planes: at most three of them decide.
fn lowest_bundle(planes: &[SupportPlane], tau: f64) -> Basis {
    let highest = planes.iter().copied().reduce(|h, p| if p.a > h.a { p } else { h });
    let first = highest.unwrap_or(SupportPlane { a: 0.0, b: [0.0; 2] });
    let mut basis = solved(&[first], tau).expect("one plane is always a basis");
    for _ in 0..BASES_MAX {
        let highest = planes.iter().map(|p| p.at(&basis.omega)).fold(f64::NEG_INFINITY, f64::max);
        if highest <= basis.t + NUMERICS.plane_violation {
            break;
        }
        let Some(worst) = planes.iter().copied().find(|p| p.at(&basis.omega) == highest) else { break };
        match exchanged(&basis, worst, tau).filter(|next| next.value > basis.value) {
            Some(next) => basis = next,
            None => break,
        }
    }
    basis
}

/// Returns the best basis among the new plane and up to two of the old; `None` if none is valid.
fn exchanged(basis: &Basis, plane: SupportPlane, tau: f64) -> Option<Basis> {
    let old = &basis.planes;
    let mut best: Option<Basis> = None;
    for subset in 0..1u32 << old.len() {
        if subset.count_ones() > 2 {
            continue;
        }
        let mut chosen = vec![plane];
        chosen.extend(old.iter().enumerate().filter(|(i, _)| subset & (1 << i) != 0).map(|(_, p)| *p));
        let all = old.iter().chain([&plane]);
        let Some(next) = solved(&chosen, tau) else { continue };
        let valid = all.clone().all(|p| p.at(&next.omega) <= next.t + NUMERICS.plane_violation);
        if valid && best.as_ref().is_none_or(|b| next.value > b.value) {
            best = Some(next);
        }
    }
    best
}

/// Solves `τ B Bᵀ λ + t = a`, `Σλ = 1` for up to three planes, in closed form; `None` if a multiplier is negative or the
/// planes are dependent.
fn solved(planes: &[SupportPlane], tau: f64) -> Option<Basis> {
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let less = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let multipliers = match *planes {
        [_] => [1.0, 0.0, 0.0],
        [p, q] => {
            let d = less(p.b, q.b);
            let first = ((p.a - q.a) / tau - dot(q.b, d)) / dot(d, d);
            [first, 1.0 - first, 0.0]
        }
        [p, q, r] => {
            // All three planes meet at one turn, which is -τ times the mean of `b` weighed by the multipliers.
            let (d, e) = (less(q.b, p.b), less(r.b, p.b));
            let cross = d[0] * e[1] - d[1] * e[0];
            let meet = [
                (e[1] * (p.a - q.a) - d[1] * (p.a - r.a)) / cross,
                (d[0] * (p.a - r.a) - e[0] * (p.a - q.a)) / cross,
            ];
            let mean = less([-meet[0] / tau, -meet[1] / tau], p.b);
            let second = (mean[0] * e[1] - mean[1] * e[0]) / cross;
            let third = (d[0] * mean[1] - d[1] * mean[0]) / cross;
            [1.0 - second - third, second, third]
        }
        _ => return None,
    };
    if multipliers.iter().any(|value| !value.is_finite() || *value < -NUMERICS.multiplier) {
        return None;
    }
    let mut omega = [0.0; 2];
    for (multiplier, plane) in multipliers.iter().zip(planes) {
        omega[0] -= tau * multiplier * plane.b[0];
        omega[1] -= tau * multiplier * plane.b[1];
    }
    let t = planes[0].at(&omega);
    let value = t + dot(omega, omega) / (2.0 * tau);
    Some(Basis { planes: planes.to_vec(), omega, t, value })
}

/// Adds the lowest points of a refused trial, as points of the robot where it began.
fn keep_lowest(bundle: &mut Vec<Vec3>, features: &[Feature], up: &Vec3, level: f64) {
    let mut low: Vec<(f64, usize)> =
        features.iter().enumerate().map(|(i, feature)| (feature.lowest(up) + level, i)).collect();
    let kept = KEPT_POINTS.min(low.len());
    if kept < low.len() {
        low.select_nth_unstable_by(kept, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
    low.truncate(kept);
    bundle.extend(low.iter().map(|&(_, i)| features[i].point(0, up)));
    let excess = bundle.len().saturating_sub(BUNDLE_MAX);
    bundle.drain(..excess);
}

/// Returns the first of eight small turns that lets the centre of mass fall, with its height: it leaves an unstable
/// balance, on one point or one edge exactly under the centre of mass. `None` if there is none, and for a robot that
/// stands: it must not be perturbed, as it could be pushed over its edge.
fn perturbed(features: &[Feature], turn: &Mat3, level: f64, tolerances: &Tolerances) -> Option<(Mat3, f64)> {
    let up = turn.transpose() * Vec3::z();
    let mut support = Vec::new();
    for feature in features.iter().filter(|f| f.lowest(&up) + level < tolerances.gap_standing) {
        let points = (0..feature.points()).map(|k| turn * feature.point(k, &up));
        let low = points.filter(|p| p.z + level < tolerances.gap_standing);
        support.extend(low.map(|p| [p.x, p.y]));
    }
    let stands =
        support_polygon::margin(&support, [0.0, 0.0]).is_some_and(|m| m.distance > tolerances.inside_min);
    if stands {
        return None;
    }
    (0..8u8).find_map(|k| {
        let (s, c) = libm::sincos(std::f64::consts::FRAC_PI_4 * f64::from(k));
        let tried = rotation(Vec3::new(c, s, 0.0) * tolerances.perturbation) * turn;
        let lower = height(features, &(tried.transpose() * Vec3::z()));
        (level - lower > tolerances.perturbation_fall).then_some((tried, lower))
    })
}
