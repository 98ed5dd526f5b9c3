//! Segments of a kinematic chain: modules with their joints, and docked pairs of shoes.

use super::robot::{ALPHA, BETA, GAMMA, across};
use super::tree::Tree;
use crate::geometry::RigidTransform;

/// A segment of a kinematic chain, from one shoe to the next: across a module or across a bond.
#[derive(Clone, Copy, Debug)]
pub(super) enum Segment {
    /// The step from a shoe to the one docked to it, at a constant pose.
    Mate(RigidTransform),
    /// The step across a module, from one of its shoes to the other.
    Module {
        /// The index of the module.
        module: usize,
        /// The joint of the tilt of the shoe that comes first on the chain, ALPHA or BETA.
        near: usize,
        /// The joint of the tilt of the other shoe, ALPHA or BETA.
        far: usize,
    },
}

impl Segment {
    /// Returns the segments between successive shoes of a chain, one less than there are shoes. `indices`: those of the
    /// shoes in the tree's order. `poses`: of the shoes, in the tree's order, in pitches.
    pub(super) fn along(tree: &Tree, poses: &[RigidTransform], indices: &[usize]) -> Vec<Segment> {
        let segment = |step: &[usize]| {
            let (from, to) = (tree.shoe[step[0]], tree.shoe[step[1]]);
            if from / 2 == to / 2 {
                let [near, far] = if from.is_multiple_of(2) { [ALPHA, BETA] } else { [BETA, ALPHA] };
                Segment::Module { module: from / 2, near, far }
            } else {
                Segment::Mate(poses[step[0]].inverse().then(&poses[step[1]]))
            }
        };
        indices.windows(2).map(segment).collect()
    }

    /// Returns the pose of the segment's last shoe in the frame of its first, in pitches; `joints`: rad, by module.
    pub(super) fn pose(&self, joints: &[[f64; 3]]) -> RigidTransform {
        match *self {
            Segment::Mate(pose) => pose,
            Segment::Module { module, near, far } => {
                let q = &joints[module];
                across(q[near], q[far], q[GAMMA])
            }
        }
    }
}
