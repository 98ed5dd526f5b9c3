//! What happens between the ends of a step, while every node goes straight on: a certificate, not
//! samples. Distances of struts change no faster than their ends move against each other, so from a
//! distance it is known for how long it lasts (conservative advancement).

use super::bound::Bound;
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
        let lack = truss.length.0 - shortest(truss.segment(x, strut), truss.segment(y, strut));
        (lack > 0.0).then_some((Bound::Shortest(strut), lack))
    });
    let apart = pairs.iter().filter_map(|&(i, j)| {
        let lack = closest(truss, x, y, (i, j), cushion)?;
        Some((Bound::Apart(i, j), lack))
    });
    lengths.chain(apart).collect()
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
