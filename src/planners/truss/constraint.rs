//! Inequality constraints g(x) >= 0 on the nodes of a truss, each with its value and gradient, a row of the
//! constraint Jacobian: lengths, distances between struts and from obstacles, heights, angles, sums of
//! lengths, rigidity.

use super::forces;
use super::rigidity;
use super::structure::Structure;
use crate::geometry::Vec3;
use crate::geometry::closest_points::{SegmentPair, end_segment, segment_segment};

/// One inequality constraint g(x) >= 0 on the positions x of the nodes. The numbers are indices in
/// [`Structure::struts`], from 0, unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Constraint {
    /// The lower length limit of a strut: it is not shorter than its range.
    LengthMin(usize),
    /// The upper length limit of a strut: it is not longer than its range.
    LengthMax(usize),
    /// The clearance between two struts, the lower index first.
    Clearance(usize, usize),
    /// The clearance of an end (0 or 1, second number) of a strut (first) from another strut (last). It stands beside
    /// `Clearance` where two struts are nearly parallel, so that their closest points jump from end to end and the
    /// distance is not smooth.
    EndClearance(usize, usize, usize),
    /// The height of a node (its index in the positions), which is not below the ground.
    NodeHeight(usize),
    /// The height of a sample point of a strut (first), which is not too far below uneven ground; the second number,
    /// 0 to [`SAMPLES`], counts the sample points from the strut's first node on.
    StrutHeight(usize, usize),
    /// The clearance of an end (0 or 1, last) of a strut (first), which stays on its side of the plane that separates
    /// the strut from a convex part of an obstacle (second, an index in
    /// [`Surroundings::parts`](super::surroundings::Surroundings::parts)).
    ObstacleClearance(usize, usize, usize),
    /// The angle between two struts that share a node, the lower index first, which is at least the limit.
    Angle(usize, usize),
    /// The lower limit of the sum of the lengths of a loop (an index in
    /// [`Limits::loops`](super::structure::Limits::loops)).
    LoopMin(usize),
    /// The upper limit of the sum of the lengths of a loop (an index in
    /// [`Limits::loops`](super::structure::Limits::loops)).
    LoopMax(usize),
    /// The lower limit of a singular value of the rigidity matrix: of the mode i for (i, i), counted from the least;
    /// of two modes together, (i, j) for the sum of their vectors if i < j and for the difference if i > j.
    Rigidity(usize, usize),
    /// The upper limit of the forces of struts, as they are distributed so that the greatest is least.
    Force,
}

/// The number of equal pieces into which the sample points of [`Constraint::StrutHeight`] divide a strut.
pub const SAMPLES: usize = 64;

impl Constraint {
    /// Returns g(x), m, with the nodes at `x`, m; not negative where the constraint holds. Angles (rad) and singular
    /// values are multiplied by the unit length [`Structure::unit`]. `Rigidity` costs an eigenvalue decomposition.
    /// `Clearance` of struts that are nearly parallel may be too great by the error of [`segment_segment`]. Panics if
    /// an index is none of the truss.
    pub fn value(self, truss: &Structure, x: &[Vec3]) -> f64 {
        match self {
            Constraint::LengthMin(strut) => truss.length(x, strut) - truss.lengths[strut].0,
            Constraint::LengthMax(strut) => truss.lengths[strut].1 - truss.length(x, strut),
            Constraint::Clearance(..) | Constraint::EndClearance(..) => {
                self.closest_points(truss, x).distance - truss.clearance
            }
            Constraint::NodeHeight(node) => truss.surroundings.height(x[node]),
            Constraint::StrutHeight(strut, sample) => {
                let (a, b) = truss.segment(x, strut);
                let height = truss.surroundings.height(a + (b - a) * (sample as f64 / SAMPLES as f64));
                height + truss.surroundings.sink_depth - truss.tolerances.ground_margin * truss.unit
            }
            Constraint::ObstacleClearance(strut, part, end) => {
                let ends = truss.segment(x, strut);
                let nearest = truss.surroundings.signed_distance(ends, part, f64::MAX);
                let ahead = [ends.0, ends.1].map(|end| end.dot(&nearest.normal));
                nearest.distance + ahead[0].max(ahead[1]) - ahead[end] - truss.clearance
            }
            Constraint::Angle(i, j) => {
                let (u, v) = arms(truss, x, i, j);
                (angle(u, v) - truss.limits.angle) * truss.unit
            }
            Constraint::LoopMin(index) => truss.loop_length(x, index) - truss.loop_ranges[index].0,
            Constraint::LoopMax(index) => truss.loop_ranges[index].1 - truss.loop_length(x, index),
            Constraint::Rigidity(i, j) => {
                let modes = rigidity::weakest(truss, x, i.max(j) + 1);
                rigidity::joined(&modes, i, j).spare(truss)
            }
            Constraint::Force => forces::spare(truss, &forces::levelled(truss, x)),
        }
    }

    /// Returns the gradient of [`value`](Constraint::value) as (index of a node, derivative by its position), without
    /// unit, for each node that it depends on; gradients of a node that is named twice add up. `truss`: the truss
    /// with its limits; `x`: the positions of the nodes, m.
    pub fn gradient(self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
        match self {
            // d|a - b| is the unit vector along the strut: a row of the rigidity matrix.
            Constraint::LengthMin(strut) | Constraint::LengthMax(strut) => {
                let (a, b) = truss.struts[strut];
                let sign = if matches!(self, Constraint::LengthMin(_)) { 1.0 } else { -1.0 };
                let along = (x[a] - x[b]).normalize() * sign;
                vec![(a, along), (b, -along)]
            }
            // The closest points move with the ends of their struts by their parameters.
            Constraint::Clearance(i, j) | Constraint::EndClearance(i, _, j) => {
                let SegmentPair { normal, along: (s, t), .. } = self.closest_points(truss, x);
                let ((a, b), (c, d)) = (truss.struts[i], truss.struts[j]);
                vec![(a, normal * (1.0 - s)), (b, normal * s), (c, -normal * (1.0 - t)), (d, -normal * t)]
            }
            Constraint::NodeHeight(node) => vec![(node, truss.surroundings.height_gradient(x[node]))],
            Constraint::StrutHeight(strut, sample) => {
                let ((a, b), (p, q)) = (truss.struts[strut], truss.segment(x, strut));
                let part = sample as f64 / SAMPLES as f64;
                let up = truss.surroundings.height_gradient(p + (q - p) * part);
                vec![(a, up * (1.0 - part)), (b, up * part)]
            }
            Constraint::ObstacleClearance(strut, part, end) => {
                let (a, b) = truss.struts[strut];
                let nearest = truss.surroundings.signed_distance(truss.segment(x, strut), part, f64::MAX);
                vec![([a, b][end], -nearest.normal)]
            }
            Constraint::Angle(i, j) => {
                let (node, p, q) = truss.corner(i, j);
                let (u, v) = arms(truss, x, i, j);
                let (a, b) = (u.normalize(), v.normalize());
                let (cosine, sine) = (a.dot(&b), a.cross(&b).norm().max(f64::EPSILON));
                let at_p = (a * cosine - b) * (truss.unit / (u.norm() * sine));
                let at_q = (b * cosine - a) * (truss.unit / (v.norm() * sine));
                vec![(p, at_p), (q, at_q), (node, -at_p - at_q)]
            }
            Constraint::LoopMin(index) | Constraint::LoopMax(index) => {
                let sign = if matches!(self, Constraint::LoopMin(_)) { 1.0 } else { -1.0 };
                let ends = |&strut: &usize| {
                    let (a, b) = truss.struts[strut];
                    let along = (x[a] - x[b]).normalize() * sign;
                    [(a, along), (b, -along)]
                };
                truss.limits.loops[index].iter().flat_map(ends).collect()
            }
            Constraint::Rigidity(i, j) => {
                let modes = rigidity::weakest(truss, x, i.max(j) + 1);
                rigidity::joined(&modes, i, j).gradient(truss, x)
            }
            Constraint::Force => forces::levelled(truss, x)
                .map_or_else(|_| Vec::new(), |found| forces::gradient(truss, x, &found)),
        }
    }

    /// Returns the closest points of the two struts of a distance constraint.
    fn closest_points(self, truss: &Structure, x: &[Vec3]) -> SegmentPair {
        match self {
            Constraint::Clearance(i, j) => segment_segment(truss.segment(x, i), truss.segment(x, j)),
            Constraint::EndClearance(i, end, j) => end_segment(truss.segment(x, i), end, truss.segment(x, j)),
            _ => unreachable!("only distances have closest points"),
        }
    }
}

/// Returns the vectors from the node that two struts share to their other ends, m.
fn arms(truss: &Structure, x: &[Vec3], i: usize, j: usize) -> (Vec3, Vec3) {
    let (node, p, q) = truss.corner(i, j);
    (x[p] - x[node], x[q] - x[node])
}

/// Returns the angle between two vectors, rad, in [0, π].
pub(super) fn angle(u: Vec3, v: Vec3) -> f64 {
    libm::atan2(u.cross(&v).norm(), u.dot(&v))
}
