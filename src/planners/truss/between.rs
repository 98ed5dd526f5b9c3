//! What happens between the ends of a step, while every node goes straight on: a certificate, not
//! samples. Distances of struts change no faster than their ends move against each other, so from a
//! distance it is known for how long it lasts (conservative advancement).

use super::bound::{self, Bound};
use super::segment;
use super::structure::Structure;
use crate::geometry::Vec3;

/// What falls short between x and y, with by how much (m): lengths, and distances of the pairs. A
/// distance may be less than `truss.clearance` by `cushion`, never by more; that the certificate holds
/// without end it is asked for half the cushion where it is looked at.
pub fn shortfalls(
    truss: &Structure,
    x: &[Vec3],
    y: &[Vec3],
    pairs: &[(usize, usize)],
    cushion: f64,
) -> Vec<(Bound, f64)> {
    let lengths = (0..truss.struts.len()).filter_map(|strut| {
        let lack = truss.lengths[strut].0 - shortest(truss.segment(x, strut), truss.segment(y, strut));
        (lack > 0.0).then_some((Bound::Shortest(strut), lack))
    });
    let apart = pairs.iter().filter_map(|&(i, j)| {
        let lack = closest(truss, x, y, (i, j), cushion)?;
        Some((Bound::Apart(i, j), lack))
    });
    let angles = truss.corners.iter().filter_map(|&(i, j)| {
        let lack = narrowest(truss, x, y, (i, j), cushion / truss.unit)?;
        Some((Bound::Angle(i, j), lack))
    });
    let sums = (0..truss.limits.loops.len()).filter_map(|index| {
        let lack = truss.limits.loops[index].range.0 - least_sum(truss, x, y, index);
        (lack > 0.0).then_some((Bound::Least(index), lack))
    });
    lengths.chain(apart).chain(angles).chain(sums).collect()
}

/// By how much (in units) two struts that share a node come too near in angle, if they do. The direction of
/// an arm turns no faster than its end goes, over its least length.
fn narrowest(truss: &Structure, x: &[Vec3], y: &[Vec3], (i, j): (usize, usize), cushion: f64) -> Option<f64> {
    let (node, p, q) = truss.corner(i, j);
    let arm = |end: usize| (x[end] - x[node], y[end] - y[node]);
    let (u, v) = (arm(p), arm(q));
    let turns = |(from, to): (Vec3, Vec3)| {
        (to - from).norm() / shortest((from, Vec3::zeros()), (to, Vec3::zeros())).max(f64::MIN_POSITIVE)
    };
    let speed = turns(u) + turns(v);
    let mut t = 0.0;
    while t < 1.0 {
        let at = |(from, to): (Vec3, Vec3)| from + (to - from) * t;
        let spare = bound::angle(at(u), at(v)) - truss.limits.angle;
        if spare < -cushion / 2.0 {
            return Some(-spare * truss.unit);
        }
        t += (spare + cushion) / speed.max(f64::MIN_POSITIVE);
    }
    None
}

/// What a sum of lengths is at least: it is convex, so it stays above its slopes at both ends.
fn least_sum(truss: &Structure, x: &[Vec3], y: &[Vec3], index: usize) -> f64 {
    let slope = |z: &[Vec3], strut: usize| {
        let (a, b) = truss.struts[strut];
        (z[a] - z[b]).normalize().dot(&((y[a] - y[b]) - (x[a] - x[b])))
    };
    let slopes =
        |z: &[Vec3]| truss.limits.loops[index].struts.iter().map(|&strut| slope(z, strut)).sum::<f64>();
    let (from, to) = (truss.around(x, index), truss.around(y, index));
    let (falls, rises) = (slopes(x), slopes(y));
    // Where the two lines meet.
    if falls >= 0.0 || rises <= 0.0 {
        return from.min(to);
    }
    let t = ((to - rises - from) / (falls - rises)).clamp(0.0, 1.0);
    from + falls * t
}

/// The least length of a strut on the way.
fn shortest((a, b): (Vec3, Vec3), (c, d): (Vec3, Vec3)) -> f64 {
    let (from, change) = (a - b, (c - d) - (a - b));
    let t = -from.dot(&change) / change.norm_squared().max(f64::MIN_POSITIVE);
    (from + change * t.clamp(0.0, 1.0)).norm()
}

/// By how much two struts come too close, if they do. Seen along the direction in which they are nearest,
/// each end passes each end of the other evenly: until one would be too near, the struts are not.
fn closest(truss: &Structure, x: &[Vec3], y: &[Vec3], (i, j): (usize, usize), cushion: f64) -> Option<f64> {
    let ((a, b), (c, d)) = (truss.struts[i], truss.struts[j]);
    let moved = |node: usize| y[node] - x[node];
    let mut t = 0.0;
    while t < 1.0 {
        let at = |node: usize| x[node] + moved(node) * t;
        let nearest = segment::nearest((at(a), at(b)), (at(c), at(d)));
        if nearest.distance < truss.clearance - cushion / 2.0 {
            return Some(truss.clearance - nearest.distance);
        }
        let along = |v: Vec3| v.dot(&nearest.normal);
        let lasts = |(p, q): (usize, usize)| {
            let (apart, speed) = (along(at(p) - at(q)).max(nearest.distance), along(moved(p) - moved(q)));
            (apart - truss.clearance + cushion) / (-speed).max(f64::MIN_POSITIVE)
        };
        t += [(a, c), (a, d), (b, c), (b, d)].map(lasts).into_iter().fold(f64::INFINITY, f64::min);
    }
    None
}
