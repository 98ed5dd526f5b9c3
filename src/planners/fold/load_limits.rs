//! What the ground and the motors let pass, in samples: a quick look like that for
//! [meetings](super::sweep_collision), under gravity. It is mild where it can't know: what touches the ground
//! somewhere but at its own hinge counts as carried by it.

use super::kinematics::poses_at;
use super::layout::Layout;
use super::simulation::quintic;
use super::target::Target;
use crate::geometry::{Pose, Vec3};

/// States of each step that are looked at.
const SAMPLES: usize = 12;

/// Touches nearer than this part of a side to the line of a hinge are at it.
const TOL_LINE: f64 = 0.05;

/// What pulls, and what the hinges hold. The root lies on the ground with its outside down.
#[derive(Clone, Debug)]
pub struct LoadLimits {
    /// By face, N.
    pub weights: Vec<f64>,
    /// N·m; infinite where no limit is stated.
    pub torque: f64,
    /// Corners that are so far under the root's level are in the ground, m.
    pub depth: f64,
    /// Corners that are not so far over it touch the ground, m.
    pub touch: f64,
}

/// What stands against a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// A face is so far below the ground, m.
    Ground { face: usize, depth: f64 },
    /// The hinge of a face holds this much, N·m.
    Overload { face: usize, torque: f64 },
}

impl LoadLimits {
    /// What stands against a step first. `folded`: the hinges that have folded before.
    pub fn obstacle(
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
            self.wrong(target, layout, &poses)
        })
    }

    /// What is wrong with a state.
    fn wrong(&self, target: &Target, layout: &Layout, poses: &[Pose]) -> Option<Violation> {
        crate::interrupt::checkpoint();
        let up = -target.normal(layout.root);
        let level = up.dot(&target.centroid(layout.root));
        let place = |face: usize, p: Vec3| poses[face].transform_point(&p.into()).coords;
        let height = |p: &Vec3| up.dot(p) - level;
        let faces = 0..poses.len();
        let corners: Vec<[Vec3; 3]> =
            faces.clone().map(|face| target.corners(face).map(|p| place(face, p))).collect();
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
                    height(p) < self.touch && (away - axis * axis.dot(&away)).norm() > TOL_LINE * side
                });
            }
            if !rests && torque.abs() > self.torque {
                return Some(Violation::Overload { face, torque: torque.abs() });
            }
        }
        None
    }
}
