//! Conservative advancement between the ends of a step, while every node moves linearly: a certificate, not
//! samples. The distance between two struts changes no faster than their ends move against each other, so a
//! distance guarantees the constraint for some time; from there on it is computed again (Mirtich; Zhang et
//! al., "Continuous collision detection by conservative advancement").

use super::broad_phase::NearPair;
use super::constraint::{self, Constraint};
use super::structure::Structure;
use crate::geometry::Vec3;
use crate::geometry::closest_points::segment_segment;
use crate::geometry::moving_lines::lines_stay_apart;

/// Returns the constraints on lengths, angles, loops and the given pairs of struts that are violated
/// somewhere while the nodes move from x to y, both in m, as (constraint, shortfall in m). A distance may fall short
/// of `truss.clearance` by `margin`, m, and by the error of [`segment_segment`] of struts that are nearly parallel,
/// never by more; where it is computed, half the margin is asked for, so that advancement ends.
pub(super) fn violations(
    truss: &Structure,
    x: &[Vec3],
    y: &[Vec3],
    pairs: &[NearPair],
    margin: f64,
) -> Vec<(Constraint, f64)> {
    let lengths = (0..truss.struts.len()).filter_map(|strut| {
        let lack = truss.lengths[strut].0 - shortest(truss.segment(x, strut), truss.segment(y, strut));
        (lack > 0.0).then_some((Constraint::LengthMin(strut), lack))
    });
    let clearances = pairs.iter().filter_map(|pair| {
        let lack = clearance_shortfall(truss, x, y, pair, margin)?;
        let (i, j) = pair.struts;
        Some((Constraint::Clearance(i, j), lack))
    });
    let angles = truss.corners.iter().filter_map(|&(i, j)| {
        let lack = angle_shortfall(truss, x, y, (i, j), margin / truss.unit)?;
        Some((Constraint::Angle(i, j), lack))
    });
    let loops = (0..truss.limits.loops.len()).filter_map(|index| {
        let lack = truss.loop_ranges[index].0 - loop_length_lower_bound(truss, x, y, index);
        (lack > 0.0).then_some((Constraint::LoopMin(index), lack))
    });
    lengths.chain(clearances).chain(angles).chain(loops).collect()
}

/// Returns the shortfall of the angle of two struts that share a node, times the unit, m; `None` if there is none;
/// `margin`: rad. The direction of an arm turns no faster than the speed of its end over its least length.
fn angle_shortfall(
    truss: &Structure,
    x: &[Vec3],
    y: &[Vec3],
    (i, j): (usize, usize),
    margin: f64,
) -> Option<f64> {
    let (node, p, q) = truss.corner(i, j);
    let arm = |end: usize| (x[end] - x[node], y[end] - y[node]);
    let (u, v) = (arm(p), arm(q));
    let turn_rate = |(from, to): (Vec3, Vec3)| {
        (to - from).norm() / shortest((from, Vec3::zeros()), (to, Vec3::zeros())).max(f64::MIN_POSITIVE)
    };
    let rate = turn_rate(u) + turn_rate(v);
    let mut t = 0.0;
    while t < 1.0 {
        let at = |(from, to): (Vec3, Vec3)| from + (to - from) * t;
        let spare = constraint::angle(at(u), at(v)) - truss.limits.angle;
        if spare < -margin / 2.0 {
            return Some(-spare * truss.unit);
        }
        t += (spare + margin) / rate.max(f64::MIN_POSITIVE);
    }
    None
}

/// Returns a lower bound on the sum of a loop's lengths between x and y, m: the sum is convex in time, so it
/// stays above its tangents at both ends.
fn loop_length_lower_bound(truss: &Structure, x: &[Vec3], y: &[Vec3], index: usize) -> f64 {
    let slope = |z: &[Vec3], strut: usize| {
        let (a, b) = truss.struts[strut];
        (z[a] - z[b]).normalize().dot(&((y[a] - y[b]) - (x[a] - x[b])))
    };
    let slopes = |z: &[Vec3]| truss.limits.loops[index].iter().map(|&strut| slope(z, strut)).sum::<f64>();
    let (from, to) = (truss.loop_length(x, index), truss.loop_length(y, index));
    let (falls, rises) = (slopes(x), slopes(y));
    if falls >= 0.0 || rises <= 0.0 {
        return from.min(to);
    }
    // The least of the bound is where the two tangents meet.
    let t = ((to - rises - from) / (falls - rises)).clamp(0.0, 1.0);
    from + falls * t
}

/// Returns the least length of a strut, m, while its ends move linearly: its square is a convex quadratic
/// in time.
fn shortest((a, b): (Vec3, Vec3), (c, d): (Vec3, Vec3)) -> f64 {
    let (from, change) = (a - b, (c - d) - (a - b));
    let t = -from.dot(&change) / change.norm_squared().max(f64::MIN_POSITIVE);
    (from + change * t.clamp(0.0, 1.0)).norm()
}

/// Returns the shortfall of the distance of two struts, m; `None` if there is none. Projected on the direction in
/// which they are nearest, each end approaches each end of the other at a constant rate: until the first of
/// them uses up the distance, the struts keep it. Struts that cross turn against that direction, and use it up soon: what their lines
/// keep is looked at first, which tells of the whole motion.
fn clearance_shortfall(
    truss: &Structure,
    x: &[Vec3],
    y: &[Vec3],
    &NearPair { struts: (i, j), start, .. }: &NearPair,
    margin: f64,
) -> Option<f64> {
    let ((a, b), (c, d)) = (truss.struts[i], truss.struts[j]);
    let moved = |node: usize| y[node] - x[node];
    let [p, q] = [i, j].map(|strut| (truss.segment(x, strut), truss.segment(y, strut)));
    if lines_stay_apart(p, q, truss.clearance - margin / 2.0) {
        return None;
    }
    let (mut t, mut nearest) = (0.0, start);
    loop {
        let at = |node: usize| x[node] + moved(node) * t;
        let (distance, normal) = nearest;
        if distance < truss.clearance - margin / 2.0 {
            return Some(truss.clearance - distance);
        }
        let along = |v: Vec3| v.dot(&normal);
        let safe_time = |(p, q): (usize, usize)| {
            let (apart, speed) = (along(at(p) - at(q)).max(distance), along(moved(p) - moved(q)));
            (apart - truss.clearance + margin) / (-speed).max(f64::MIN_POSITIVE)
        };
        t += [(a, c), (a, d), (b, c), (b, d)].map(safe_time).into_iter().fold(f64::INFINITY, f64::min);
        if t >= 1.0 {
            return None;
        }
        let at = |node: usize| x[node] + moved(node) * t;
        let found = segment_segment((at(a), at(b)), (at(c), at(d)));
        nearest = (found.distance, found.normal);
    }
}
