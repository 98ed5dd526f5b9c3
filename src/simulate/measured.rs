//! Poses of links at the moments of a motion that was measured.
#![allow(non_snake_case)]

use super::{Moment, Simulation};
use crate::geometry::Pose;
use crate::plan::{LastingTrees, Tracks};
use crate::robot::Kinematics;

/// The links of a robot that was simulated: its trees without the bonds that broke.
#[derive(Clone, Debug)]
pub struct MeasuredLinks {
    trees: Vec<Kinematics>,
}

impl MeasuredLinks {
    /// Returns the links of a plan's robot as a simulation of that plan moved them.
    pub fn new(tracks: &Tracks, simulation: &Simulation) -> MeasuredLinks {
        let start = &tracks.start;
        MeasuredLinks {
            trees: LastingTrees::new(tracks, &start.base, &start.clusters, &simulation.apart).trees,
        }
    }

    /// Returns the world pose of each link at a moment, `X_WL` in m, by its number ([`Kinematics::link`]).
    pub fn poses(&self, moment: &Moment) -> Vec<Pose> {
        let mut poses = vec![Pose::identity(); self.trees[0].link_count()];
        let roots = std::iter::once(&moment.base).chain(&moment.roots);
        for (tree, X_WR) in self.trees.iter().zip(roots) {
            tree.link_poses(&moment.joints, X_WR, &mut poses);
        }
        poses
    }

    /// Returns the kinematics, which number the links of the whole robot.
    pub fn kinematics(&self) -> &Kinematics {
        &self.trees[0]
    }
}
