//! Ground contact and static hinge torques under gravity, sampled over a step like
//! [collisions](super::sweep_collision). The check is permissive: what touches the ground somewhere but at its own
//! hinge counts as carried by the ground.

use super::kinematics::poses_at;
use super::layout::Layout;
use super::simulation::quintic;
use super::target::Target;
use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Vec3};

/// The number of states of each step that are sampled.
const SAMPLES: usize = 12;

/// The weights of the faces, and the limits of hinge torque and ground penetration, for the statics of a folding. The
/// root lies on the ground with its outside down.
#[derive(Clone, Debug)]
pub struct LoadLimits {
    /// The weight of each face, in the order of [`Target::faces`], N.
    pub weights: Vec<f64>,
    /// The torque that a hinge holds, N·m; infinite where no limit is stated.
    pub torque: f64,
    /// The depth below the root's plane beyond which a corner is in the ground, m.
    pub depth: f64,
    /// The height over the root's plane below which a corner touches the ground, m.
    pub touch: f64,
}

/// A violation of a limit of [`LoadLimits`] by a posture, with the face at which it occurs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// A face that reaches below the ground.
    Ground {
        /// The index of the face in [`Target::faces`].
        face: usize,
        /// The depth of the face's lowest corner below the root's plane, m.
        depth: f64,
    },
    /// A hinge that is overloaded, named by the face that it carries.
    Overload {
        /// The index of the face in [`Target::faces`].
        face: usize,
        /// The absolute torque that the hinge would have to hold, N·m.
        torque: f64,
    },
}

impl LoadLimits {
    /// Returns the first violation of a limit in the samples of a step; `None` if they show none. `folded`: for each
    /// face, in the order of [`Target::faces`], true if its hinge has folded before; `moving`: the faces whose hinges
    /// fold from level in the step. `target` and `layout`: the surface and how it is unfolded.
    pub fn violation(
        &self,
        target: &Target,
        layout: &Layout,
        folded: &[bool],
        moving: &[usize],
    ) -> Option<Violation> {
        let full = |face: usize| layout.hinge[face].map_or(0.0, |hinge| target.hinges[hinge].angle);
        (1..=SAMPLES).find_map(|sample| {
            let part = quintic(sample as f64 / SAMPLES as f64, 1.0).angle;
            let poses = poses_at(target, layout, |face| match folded[face] {
                true => full(face),
                false if moving.contains(&face) => full(face) * part,
                false => 0.0,
            });
            self.violation_at(target, layout, &poses)
        })
    }

    /// Returns a violation in one state, given by the displacements of the faces in the order of [`Target::faces`]: of
    /// the ground, else of the first hinge that neither holds the torque of gravity nor carries a face that rests on
    /// the ground; `None` if there is none. `target` and `layout`: the surface and how it is unfolded.
    pub(super) fn violation_at(&self, target: &Target, layout: &Layout, poses: &[Pose]) -> Option<Violation> {
        crate::interrupt::checkpoint();
        let up = -target.normal(layout.root);
        let level = up.dot(&target.centroid(layout.root));
        let place = |face: usize, p: Vec3| poses[face].transform_point(&p.into()).coords;
        let height = |p: &Vec3| up.dot(p) - level;
        let faces = 0..poses.len();
        let corners: Vec<Vec<Vec3>> = faces
            .clone()
            .map(|face| target.corners(face).iter().map(|p| place(face, *p)).collect())
            .collect();
        for face in faces.clone() {
            let lowest = corners[face].iter().map(height).fold(f64::INFINITY, f64::min);
            if lowest < -self.depth {
                return Some(Violation::Ground { face, depth: -lowest });
            }
        }
        for &face in layout.order[1..].iter() {
            let hinge = &target.hinges[layout.hinge[face].expect("only the root has none")];
            let parent = &poses[layout.parent[face]];
            let (point, axis) =
                (parent.transform_point(&hinge.point.into()).coords, parent.rotation * hinge.axis);
            let side = (corners[face][1] - corners[face][0]).norm();
            let mut torque = 0.0;
            let mut rests = false;
            for below in faces.clone().filter(|below| layout.is_above(face, *below)) {
                let middle = place(below, target.centroid(below));
                torque += axis.dot(&(middle - point).cross(&(-up * self.weights[below])));
                rests |= corners[below].iter().any(|p| {
                    let away = p - point;
                    height(p) < self.touch
                        && (away - axis * axis.dot(&away)).norm() > TOLERANCES.hinge_line * side
                });
            }
            if !rests && torque.abs() > self.torque {
                return Some(Violation::Overload { face, torque: torque.abs() });
            }
        }
        None
    }
}
