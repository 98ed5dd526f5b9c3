//! Static joint torques of a robot of which one shoe is held fast: the product of the transposed Jacobian with the
//! weights, for each joint bears all that is distal to it, at rest. Forces in N, torques in N times the pitch.

use super::tree::{JointRef, Tree};
use crate::geometry::{RigidTransform, Vec3};

/// A gravity model: the shoe by which the robot is held, its weights, and the torque limits of its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct GravityModel {
    /// The number of the shoe that is held fixed: twice the index of its module, plus one for shoe B.
    pub held: usize,
    /// The index of the module near which loops stay closed: they are opened far from it.
    pub root: usize,
    /// The unit vector of gravity in the frame of the shoe that is held.
    pub down: Vec3,
    /// The weight of each shoe at its centre, N; at index `2 * module`, plus one for shoe B.
    pub shoes: Vec<f64>,
    /// The torque limits of alpha, beta and gamma of each module, by module, N times the pitch; infinite if none is
    /// stated.
    pub limits: Vec<[f64; 3]>,
}

/// The load of a joint as a fraction of its torque limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLoad {
    /// The index of the module, from 0.
    pub module: usize,
    /// The joint of the module, 0 to 2: [`ALPHA`](super::robot::ALPHA), [`BETA`](super::robot::BETA) or
    /// [`GAMMA`](super::robot::GAMMA).
    pub joint: usize,
    /// The absolute torque divided by the torque limit; 0 without a limit. Above 1 the joint is overloaded.
    pub ratio: f64,
}

impl JointLoad {
    pub(super) const NONE: JointLoad = JointLoad { module: 0, joint: 0, ratio: 0.0 };

    /// Returns the greater of two loads; of equal ones `self`.
    pub fn greater(self, other: JointLoad) -> JointLoad {
        if other.ratio > self.ratio { other } else { self }
    }
}

impl GravityModel {
    /// Returns the greatest load of a joint under gravity, that of joint 0 of module 0 with ratio 0 if no joint bears
    /// anything. `poses`: of the shoes, in the tree's order ([`Tree::shoe`]), in pitches. Bonds that close loops are
    /// taken to carry nothing.
    pub fn greatest(&self, tree: &Tree, poses: &[RigidTransform]) -> JointLoad {
        self.loads(tree, poses).into_iter().fold(JointLoad::NONE, JointLoad::greater)
    }

    /// Returns the loads of all joints under gravity, in the order of [`Tree::all_joints`]. `poses`: of the shoes, in
    /// the tree's order ([`Tree::shoe`]), in pitches. Bonds that close loops are taken to carry nothing.
    pub fn loads(&self, tree: &Tree, poses: &[RigidTransform]) -> Vec<JointLoad> {
        let down = poses[tree.index[self.held]].rotation * self.down;
        let weights: Vec<f64> = tree.shoe.iter().map(|&shoe| self.shoes[shoe]).collect();
        self.loads_of(tree, poses, down, &weights)
    }

    /// Returns the loads of all joints under forces along the unit vector `down` at the centres of shoes (N, in the tree's
    /// order), which the shoe that is held balances; in the order of [`Tree::all_joints`]. The torque of a joint is
    /// `axis · ((m - w · point) × down)`, with the sum w and the first moment m of the forces on all shoes that the
    /// joint carries. Both are differences of prefix sums, for subtrees are ranges of indices.
    pub(super) fn loads_of(
        &self,
        tree: &Tree,
        poses: &[RigidTransform],
        down: Vec3,
        forces: &[f64],
    ) -> Vec<JointLoad> {
        let held = tree.index[self.held];
        let (mut weight, mut moment) = (vec![0.0], vec![Vec3::zeros()]);
        for (index, (pose, own)) in poses.iter().zip(forces).enumerate() {
            weight.push(weight[index] + own);
            moment.push(moment[index] + pose.translation * *own);
        }
        let load = |joint: JointRef| {
            let (start, end) = (joint.child, tree.end[joint.child]);
            let (mut w, mut m) = (weight[end] - weight[start], moment[end] - moment[start]);
            if tree.is_in_subtree(held, start) {
                // The subtree is held, and carries the rest.
                (w, m) = (weight[poses.len()] - w, moment[poses.len()] - m);
            }
            let (axis, point) = tree.axis(joint, poses);
            let torque = axis.dot(&(m - point * w).cross(&down));
            let ratio = torque.abs() / self.limits[joint.module][joint.joint];
            JointLoad { module: joint.module, joint: joint.joint, ratio }
        };
        tree.all_joints().into_iter().map(load).collect()
    }
}
