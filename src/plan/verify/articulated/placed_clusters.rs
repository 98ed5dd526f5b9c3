//! The poses of all links of a robot that has come apart, at any time of its plan.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::Tracks;
use crate::robot::Kinematics;

/// The clusters of a plan with the paths of their bases, from which the poses of all links follow.
pub(super) struct PlacedClusters<'a> {
    tracks: &'a Tracks,
    clusters: Vec<(&'a Cluster, &'a BasePath)>,
    tolerances: &'a Tolerances,
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
        PlacedClusters { tracks, clusters, tolerances, kinematics }
    }

    /// Writes the world poses of the links of all clusters that exist at a time (s), `X_WL` in m, by their numbers in the
    /// plan's robot ([`Kinematics::link`]), and returns these clusters, as indices. Panics if there are fewer poses than
    /// links, and for a cluster whose path has no samples.
    pub(super) fn place(&mut self, time: f64, poses: &mut [Pose]) -> Vec<usize> {
        let state = self.tracks.state(time);
        let mut placed = Vec::new();
        for (index, (cluster, path)) in self.clusters.iter().enumerate() {
            if !cluster.exists(time, self.tracks.duration) {
                continue;
            }
            let known = &mut self.kinematics[index];
            let same = known.take().filter(|(bonds, _)| *bonds == state.bonds);
            let compile =
                || (state.bonds.clone(), Kinematics::new(&self.tracks.robot, &state.bonds, cluster.base()));
            let (_, kinematics) = known.insert(same.unwrap_or_else(compile));
            kinematics.link_poses(&state.joints, &path.at(time, self.tolerances), poses);
            placed.push(index);
        }
        placed
    }
}
