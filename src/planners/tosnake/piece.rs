//! The pieces of a way along the tree: modules with their joints, and shoes that hold each other.

use super::robot::{ALPHA, BETA, GAMMA, across};
use super::tree::Tree;
use crate::geometry::RigidTransform;

#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// From a shoe to the one that it holds.
    Mate(RigidTransform),
    /// Across a module, with its tilt that comes first on the way and the other one.
    Module { module: usize, near: usize, far: usize },
}

impl Piece {
    /// The pieces from each place to the next.
    pub fn along(tree: &Tree, poses: &[RigidTransform], places: &[usize]) -> Vec<Piece> {
        let piece = |step: &[usize]| {
            let (from, to) = (tree.shoe[step[0]], tree.shoe[step[1]]);
            if from / 2 == to / 2 {
                let [near, far] = if from.is_multiple_of(2) { [ALPHA, BETA] } else { [BETA, ALPHA] };
                Piece::Module { module: from / 2, near, far }
            } else {
                Piece::Mate(poses[step[0]].inverse().then(&poses[step[1]]))
            }
        };
        places.windows(2).map(piece).collect()
    }

    /// From its one end to the other.
    pub fn pose(&self, joints: &[[f64; 3]]) -> RigidTransform {
        match *self {
            Piece::Mate(mated) => mated,
            Piece::Module { module, near, far } => {
                let q = &joints[module];
                across(q[near], q[far], q[GAMMA])
            }
        }
    }
}
