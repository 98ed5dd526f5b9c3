//! The poses of all links of several clusters, at any time of their plan.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::Tracks;
use crate::robot::{Assembly, Kinematics};

/// The clusters of a plan with the paths of their bases, from which the poses of all links follow.
pub(super) struct PlacedClusters<'a> {
    tracks: &'a Tracks,
    clusters: Vec<(&'a Cluster, &'a BasePath)>,
    tolerances: &'a Tolerances,
    /// The plan's robot with the misalignments of the bonds of each cluster; `None` for a cluster without any.
    misaligned: Vec<Option<Assembly>>,
    /// The kinematics of the plan's robot from the base of each cluster, with the bonds for which it was compiled; `None`
    /// before the first time.
    kinematics: Vec<Option<(Vec<bool>, Kinematics)>>,
}

impl<'a> PlacedClusters<'a> {
    /// Returns clusters of a plan's body with the paths of their bases.
    pub(super) fn new(
        tracks: &'a Tracks,
        clusters: Vec<(&'a Cluster, &'a BasePath)>,
        tolerances: &'a Tolerances,
    ) -> PlacedClusters<'a> {
        let kinematics = clusters.iter().map(|_| None).collect();
        let misaligned = |(cluster, _): &(&Cluster, &BasePath)| {
            let misalignments = cluster.misalignments();
            (!misalignments.is_empty()).then(|| Assembly { misalignments, ..tracks.robot.clone() })
        };
        let misaligned = clusters.iter().map(misaligned).collect();
        PlacedClusters { tracks, clusters, tolerances, misaligned, kinematics }
    }

    /// Writes the world poses of the links of all clusters that exist at a time (s), `X_WL` in m, by their numbers in the
    /// plan's robot ([`Kinematics::link`]), and returns these clusters, as indices. Panics if there are fewer poses than
    /// links, and for a cluster whose path has no samples.
    pub(super) fn place(&mut self, time: f64, poses: &mut [Pose]) -> Vec<usize> {
        let state = self.tracks.state(time);
        let existing: Vec<usize> =
            (0..self.clusters.len()).filter(|index| self.clusters[*index].0.exists(time)).collect();
        existing.iter().for_each(|index| self.place_one(*index, time, (&state.joints, &state.bonds), poses));
        existing
    }

    /// Writes the world poses of the links of one cluster, given by its index, at a time (s) with joints at these positions
    /// (rad or m) and bonds that hold, both of the plan's robot; see [`place`](Self::place).
    pub(super) fn place_one(
        &mut self,
        index: usize,
        time: f64,
        (joints, bonds): (&[f64], &[bool]),
        poses: &mut [Pose],
    ) {
        let (cluster, path) = self.clusters[index];
        let robot = self.misaligned[index].as_ref().unwrap_or(&self.tracks.robot);
        let known = &mut self.kinematics[index];
        let same = known.take().filter(|(of, _)| of == bonds);
        let compile = || (bonds.to_vec(), Kinematics::new(robot, bonds, cluster.base()));
        let (_, kinematics) = known.insert(same.unwrap_or_else(compile));
        kinematics.link_poses(joints, &path.at(time, self.tolerances), poses);
    }
}
