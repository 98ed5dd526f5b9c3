//! What must not fall below zero: lengths, distances between struts and from obstacles, heights, angles,
//! sums of lengths, rigidity. Each has a value and a gradient over the nodes.

use super::segment::{self, Witness};
use super::stiffness;
use super::structure::Structure;
use crate::geometry::Vec3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bound {
    /// Of a strut.
    Shortest(usize),
    Longest(usize),
    /// Two struts, the lower first.
    Apart(usize, usize),
    /// An end (0 or 1) of a strut and another strut: beside `Apart` where two are nearly parallel, so
    /// that their nearest points jump from end to end.
    EndApart(usize, usize, usize),
    /// A node above the ground.
    Above(usize),
    /// A point of a strut above uneven ground, by its number of [`POINTS`].
    Over(usize, usize),
    /// An end (0 or 1, last) of a strut on its side of the plane between it and a part of an obstacle.
    Clear(usize, usize, usize),
    /// Two struts that share a node, the lower first: the angle between them, in units.
    Angle(usize, usize),
    /// The sum of a loop's lengths.
    Least(usize),
    Most(usize),
    /// Singular values of the rigidity matrix, counted from the least, in units: one and itself, or two,
    /// the lower first for the sum of their vectors and last for the difference.
    Rigid(usize, usize),
}

/// Points of a strut that are looked at, evenly along it, are its ends and one less than this between.
pub const POINTS: usize = 64;
/// What planners leave of how far struts may be below the ground that nodes stand on, in units.
pub const DIP: f64 = 1e-4;

impl Bound {
    /// Metres; not below zero.
    pub fn value(self, truss: &Structure, x: &[Vec3]) -> f64 {
        match self {
            Bound::Shortest(strut) => truss.length(x, strut) - truss.lengths[strut].0,
            Bound::Longest(strut) => truss.lengths[strut].1 - truss.length(x, strut),
            Bound::Apart(..) | Bound::EndApart(..) => self.witness(truss, x).distance - truss.clearance,
            Bound::Above(node) => truss.around.above(x[node]),
            Bound::Over(strut, point) => {
                let (a, b) = truss.segment(x, strut);
                let height = truss.around.above(a + (b - a) * (point as f64 / POINTS as f64));
                height + truss.around.sink - DIP * truss.unit
            }
            Bound::Clear(strut, part, end) => {
                let ends = truss.segment(x, strut);
                let nearest = truss.around.nearness(ends, part, f64::MAX);
                let ahead = [ends.0, ends.1].map(|end| end.dot(&nearest.normal));
                nearest.distance + ahead[0].max(ahead[1]) - ahead[end] - truss.clearance
            }
            Bound::Angle(i, j) => {
                let (u, v) = arms(truss, x, i, j);
                (angle(u, v) - truss.limits.angle) * truss.unit
            }
            Bound::Least(index) => truss.around(x, index) - truss.limits.loops[index].range.0,
            Bound::Most(index) => truss.limits.loops[index].range.1 - truss.around(x, index),
            Bound::Rigid(i, j) => {
                let modes = stiffness::weakest(truss, x, i.max(j) + 1);
                stiffness::joined(&modes, i, j).spare(truss)
            }
        }
    }

    /// By node.
    pub fn gradient(self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
        match self {
            Bound::Shortest(strut) | Bound::Longest(strut) => {
                let (a, b) = truss.struts[strut];
                let sign = if matches!(self, Bound::Shortest(_)) { 1.0 } else { -1.0 };
                let along = (x[a] - x[b]).normalize() * sign;
                vec![(a, along), (b, -along)]
            }
            Bound::Apart(i, j) | Bound::EndApart(i, _, j) => {
                let Witness { normal, along: (s, t), .. } = self.witness(truss, x);
                let ((a, b), (c, d)) = (truss.struts[i], truss.struts[j]);
                vec![(a, normal * (1.0 - s)), (b, normal * s), (c, -normal * (1.0 - t)), (d, -normal * t)]
            }
            Bound::Above(node) => vec![(node, truss.around.upward(x[node]))],
            Bound::Over(strut, point) => {
                let ((a, b), (p, q)) = (truss.struts[strut], truss.segment(x, strut));
                let part = point as f64 / POINTS as f64;
                let up = truss.around.upward(p + (q - p) * part);
                vec![(a, up * (1.0 - part)), (b, up * part)]
            }
            Bound::Clear(strut, part, end) => {
                let (a, b) = truss.struts[strut];
                let nearest = truss.around.nearness(truss.segment(x, strut), part, f64::MAX);
                vec![([a, b][end], -nearest.normal)]
            }
            Bound::Angle(i, j) => {
                let (node, p, q) = truss.corner(i, j);
                let (u, v) = arms(truss, x, i, j);
                let (a, b) = (u.normalize(), v.normalize());
                let (cosine, sine) = (a.dot(&b), a.cross(&b).norm().max(f64::EPSILON));
                let at_p = (a * cosine - b) * (truss.unit / (u.norm() * sine));
                let at_q = (b * cosine - a) * (truss.unit / (v.norm() * sine));
                vec![(p, at_p), (q, at_q), (node, -at_p - at_q)]
            }
            Bound::Least(index) | Bound::Most(index) => {
                let sign = if matches!(self, Bound::Least(_)) { 1.0 } else { -1.0 };
                let ends = |&strut: &usize| {
                    let (a, b) = truss.struts[strut];
                    let along = (x[a] - x[b]).normalize() * sign;
                    [(a, along), (b, -along)]
                };
                truss.limits.loops[index].struts.iter().flat_map(ends).collect()
            }
            Bound::Rigid(i, j) => {
                let modes = stiffness::weakest(truss, x, i.max(j) + 1);
                stiffness::joined(&modes, i, j).gradient(truss, x)
            }
        }
    }

    fn witness(self, truss: &Structure, x: &[Vec3]) -> Witness {
        match self {
            Bound::Apart(i, j) => segment::nearest(truss.segment(x, i), truss.segment(x, j)),
            Bound::EndApart(i, end, j) => {
                segment::nearest_to_end(truss.segment(x, i), end, truss.segment(x, j))
            }
            _ => unreachable!("only distances have witnesses"),
        }
    }
}

/// From the node that two struts share to their others.
fn arms(truss: &Structure, x: &[Vec3], i: usize, j: usize) -> (Vec3, Vec3) {
    let (node, p, q) = truss.corner(i, j);
    (x[p] - x[node], x[q] - x[node])
}

/// Between two directions, rad.
pub fn angle(u: Vec3, v: Vec3) -> f64 {
    libm::atan2(u.cross(&v).norm(), u.dot(&v))
}
