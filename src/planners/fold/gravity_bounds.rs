//! Lower bounds on energy and peak torque under gravity, with the leaves folded first, from the torque of gravity
//! about every hinge for every face that it carries.
//!
//! All above a hinge is level when it folds, and the faces that it carries have their final form: one rigid body that
//! turns about an axis at rest. Its torque is `J q̈ + G(q)`. Over the step the mean of `J q̈` is 0, for the
//! hinge begins and ends at rest; so the mean of |torque| is no less than |mean of G|, and the peak is no
//! less than |G| at either end, where q̈ is 0. G is a sum over the faces that are carried, and what a face
//! adds depends on the hinge, on its upper side, and on the face alone: with the outside of the upper face p
//! down, x the face's centroid in the target and o a point of the hinge,
//!
//! ```text
//! G_j(q) = -m_j g N_p · (ê × R(ê, q - φ) (x_j - o))
//! ```
//!
//! which is a sine of q; the quintic law is odd about the middle of the step, so the mean of G is its value
//! at φ/2 times the mean of cos(φ (s - 1/2)). A sum over the hinges of a layout is then a sum over faces of
//! what their own paths cost, some of it negative: no walk of as many arcs as there are faces costs less
//! than the cheapest.
//!
//! Over the step a face gains `2 sin(φ/2) G_j(φ/2)`, and what it gains along its path is its height over the
//! root, whatever the path: so for hinges of one angle all paths cost the same, and the bound is near.

use super::kinematics::about;
use super::simulation::quintic;
use super::target::Target;
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;

/// The number of points of a step over which a cosine is averaged, by the midpoints; the sum is exact to far
/// below the tolerance, for the law is smooth and flat at both ends.
const PLACES: usize = 256;

/// The torques of gravity about every hinge, for either face above and every face carried, N·m, from which lower bounds
/// on energy and peak torque follow.
pub(super) struct GravityBounds {
    faces: usize,
    arcs: Vec<Arc>,
}

/// A hinge with one of its faces above.
struct Arc {
    above: usize,
    below: usize,
    /// The sign of its angle: in this direction a folding hinge turns.
    sense: f64,
    /// The mean torque over the step, by face.
    mean: Vec<f64>,
    /// The torques at its beginning and its end, by face.
    ends: [Vec<f64>; 2],
}

impl GravityBounds {
    /// Computes the torques of gravity about the hinges of a target. `masses`: by face in the order of
    /// [`Target::faces`], kg; `gravity`: the gravitational acceleration, m/s², at least 0.
    pub(super) fn new(target: &Target, masses: &[f64], gravity: f64) -> GravityBounds {
        let mut arcs = Vec::with_capacity(2 * target.hinges.len());
        for hinge in &target.hinges {
            crate::interrupt::checkpoint();
            let cosine = mean_cosine(hinge.angle);
            for above in hinge.faces {
                let (axis, down) = (hinge.axis_from(above), target.normal(above));
                let at = |angle: f64| -> Vec<f64> {
                    let turn = about(&hinge.point, axis, angle - hinge.angle);
                    let torque = |(face, mass): (usize, &f64)| {
                        let arm: Vec3 =
                            turn.transform_point(&target.centroid(face).into()).coords - hinge.point;
                        -mass * gravity * down.dot(&axis.cross(&arm))
                    };
                    masses.iter().enumerate().map(torque).collect()
                };
                let mean = at(hinge.angle / 2.0).into_iter().map(|torque| torque * cosine).collect();
                let ends = [at(0.0), at(hinge.angle)];
                let sense = if hinge.angle < 0.0 { -1.0 } else { 1.0 };
                arcs.push(Arc { above, below: hinge.other(above), sense, mean, ends });
            }
        }
        GravityBounds { faces: masses.len(), arcs }
    }

    /// Returns for each root, in the order of [`Target::faces`], a lower bound on the sum over all hinges of the
    /// absolute mean torque of gravity while they fold, N·m. It is the greater of two sums of cheapest walks
    /// (Bellman-Ford): of torques signed in the direction of folding, and signed about the hinges' axes.
    pub(super) fn energies(&self) -> Vec<f64> {
        let both = [self.sums(|arc| arc.sense), self.sums(|_| 1.0)];
        let greater = |root: usize| both.iter().map(|sums| sums[root]).fold(0.0, f64::max);
        (0..self.faces).map(|root| greater(root) * (1.0 - TOLERANCES.gravity_bound)).collect()
    }

    /// Returns the costs of the cheapest walks to all faces, by root, with the torques' signs as given
    /// (Bellman-Ford algorithm).
    fn sums(&self, sign: impl Fn(&Arc) -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.faces];
        for face in 0..self.faces {
            crate::interrupt::checkpoint();
            // The cost of the cheapest walk from each face.
            let mut cost = vec![f64::INFINITY; self.faces];
            cost[face] = 0.0;
            for _ in 1..self.faces {
                let before = cost.clone();
                for arc in &self.arcs {
                    cost[arc.above] = cost[arc.above].min(before[arc.below] + sign(arc) * arc.mean[face]);
                }
                if cost == before {
                    break;
                }
            }
            sums.iter_mut().zip(&cost).for_each(|(sum, cost)| *sum += cost);
        }
        sums
    }

    /// Returns a lower bound on the peak torque of gravity and motion in layouts with the root `root` (an index in
    /// [`Target::faces`]), N·m: the hinges of the root carry all other faces among them, so the greatest of their
    /// torques is at least the mean over all hinges there.
    pub(super) fn peak(&self, root: usize) -> f64 {
        let around: Vec<&Arc> = self.arcs.iter().filter(|arc| arc.above == root).collect();
        let mut greatest: f64 = 0.0;
        for (end, turning) in [(0, true), (0, false), (1, true), (1, false)] {
            let of = |arc: &&Arc, face: usize| if turning { arc.sense } else { 1.0 } * arc.ends[end][face];
            let least = |face: usize| around.iter().map(|arc| of(arc, face)).fold(f64::INFINITY, f64::min);
            let others = (0..self.faces).filter(|face| *face != root);
            greatest = greatest.max(others.map(least).sum::<f64>() / around.len().max(1) as f64);
        }
        greatest * (1.0 - TOLERANCES.gravity_bound)
    }
}

/// Returns the mean over a step of cos(φ (s - 1/2)).
fn mean_cosine(angle: f64) -> f64 {
    let place = |i: usize| (i as f64 + 0.5) / PLACES as f64;
    let cosine = |i: usize| libm::cos(angle * (quintic(place(i), 1.0).angle - 0.5));
    (0..PLACES).map(cosine).sum::<f64>() / PLACES as f64
}
