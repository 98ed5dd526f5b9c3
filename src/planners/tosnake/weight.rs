//! What the joints have to hold where one shoe is held fast: the weight of all that hangs on them, at
//! rest. Forces in N, torques in N times the pitch.

use super::tree::Tree;
use crate::geometry::{RigidTransform, Vec3};

/// How a robot is held, what it weighs, and what its joints can hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Weight {
    /// The shoe that is held fast.
    pub held: usize,
    /// The module near which loops stay closed: they are opened far from it.
    pub root: usize,
    /// The direction of gravity in that shoe's frame, of length 1.
    pub down: Vec3,
    /// By shoe: the weight at its centre, N.
    pub shoes: Vec<f64>,
    /// By module, of alpha, beta and gamma; infinite where no limit is stated.
    pub limits: Vec<[f64; 3]>,
}

/// What a joint has to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    pub module: usize,
    pub joint: usize,
    /// By its limit; without limits 0.
    pub ratio: f64,
}

impl Load {
    const NONE: Load = Load { module: 0, joint: 0, ratio: 0.0 };

    pub fn greater(self, other: Load) -> Load {
        if other.ratio > self.ratio { other } else { self }
    }
}

impl Weight {
    /// The load that is greatest by its limit. Bonds that close loops are taken to carry nothing.
    pub fn greatest(&self, tree: &Tree, poses: &[RigidTransform]) -> Load {
        self.loads(tree, poses).into_iter().fold(Load::NONE, Load::greater)
    }

    /// Of all joints.
    pub fn loads(&self, tree: &Tree, poses: &[RigidTransform]) -> Vec<Load> {
        let held = tree.place[self.held];
        let down = poses[held].rotation * self.down;
        // Weights, and weights times places, of all before each place.
        let (mut weight, mut moment) = (vec![0.0], vec![Vec3::zeros()]);
        for (place, pose) in poses.iter().enumerate() {
            let own = self.shoes[tree.shoe[place]];
            weight.push(weight[place] + own);
            moment.push(moment[place] + pose.translation * own);
        }
        let load = |joint: super::tree::JointRef| {
            let (start, end) = (joint.place, tree.end[joint.place]);
            let (mut w, mut m) = (weight[end] - weight[start], moment[end] - moment[start]);
            if tree.hangs_on(held, start) {
                // What hangs on the joint holds the rest.
                (w, m) = (weight[poses.len()] - w, moment[poses.len()] - m);
            }
            let (axis, point) = tree.axis(joint, poses);
            let torque = axis.dot(&(m - point * w).cross(&down));
            let ratio = torque.abs() / self.limits[joint.module][joint.joint];
            Load { module: joint.module, joint: joint.joint, ratio }
        };
        tree.all_joints().into_iter().map(load).collect()
    }
}
