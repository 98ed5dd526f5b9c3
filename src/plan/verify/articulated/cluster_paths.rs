//! The paths of the clusters of a robot that comes apart, for those who draw or measure it. Nothing is judged here.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::parted;
use super::rollout::{Rollout, roll_out};
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::{Body, DockingKind, Plan, Tracks, validation};
use crate::robot::Kinematics;

/// The path of one cluster: a part of the robot that bonds connect, from the instant at which it comes off another, or
/// the start, until it comes apart itself.
#[derive(Clone, Debug)]
pub struct ClusterPath {
    /// The modules of the cluster, by their indices in the plan's robot, ascending.
    pub modules: Vec<usize>,
    /// The module whose body's pose is followed, by its index in the plan's robot.
    pub base: usize,
    /// The time from which the cluster exists, s from the start of the plan.
    pub from: f64,
    /// The time up to which the cluster exists, s from the start of the plan.
    to: f64,
    path: BasePath,
}

/// The paths of all clusters of a plan.
#[derive(Clone, Debug)]
pub struct ClusterPaths<'a> {
    tracks: &'a Tracks,
    /// The clusters, each after the one of which it was a part.
    pub clusters: Vec<ClusterPath>,
    tolerances: Tolerances,
}

impl<'a> ClusterPaths<'a> {
    /// Returns the paths of the clusters of an articulated robot's plan up to a time (s), by the judge's rollout; `None`
    /// for a robot that stays one, for plans of other families, and for plans that are not valid.
    pub fn of(plan: &'a Plan, until: f64) -> Option<ClusterPaths<'a>> {
        let Body::Tracks(tracks) = &plan.body else { return None };
        if tracks.events.iter().all(|event| event.kind == DockingKind::Dock) {
            return None;
        }
        validation::check(plan).ok()?;
        let tolerances = Tolerances::default();
        let rollout = Rollout::of(plan, tracks, &tolerances);
        let (clusters, _) = parted::clusters(&rollout)?;
        let mut paths: Vec<BasePath> = Vec::new();
        for cluster in &clusters {
            let known = cluster.parent.map(|parent| (&clusters[parent], &paths[parent]));
            let entry = match known {
                Some((_, path)) if path.poses.last().is_none_or(|(time, _)| *time < cluster.from) => None,
                known => known.map(|(before, path)| parted::entry(&rollout, cluster, before, path)),
            };
            let mut path = BasePath::default();
            if cluster.from <= until && entry.is_some() == cluster.parent.is_some() {
                let own = Rollout {
                    tracks: &cluster.tracks,
                    exemptions: &cluster.exemptions,
                    begin: entry.as_ref(),
                    ..rollout
                };
                roll_out(own, None, until.min(cluster.to), &mut |sample, _| {
                    path.poses.push((sample.time, sample.stance.base_pose(sample.model)));
                    true
                });
            }
            paths.push(path);
        }
        let cluster = |(cluster, path): (Cluster, BasePath)| ClusterPath {
            base: parted::base_of(&cluster),
            from: cluster.from,
            to: cluster.to,
            modules: cluster.modules,
            path,
        };
        let clusters = clusters.into_iter().zip(paths).map(cluster);
        let clusters = clusters.filter(|cluster| !cluster.poses().is_empty()).collect();
        Some(ClusterPaths { tracks, clusters, tolerances })
    }

    /// Writes the world poses of all links of the plan's robot at a time (s), `X_WL` in m, by their numbers
    /// ([`Kinematics::link`]). Panics if there are fewer of them than links.
    pub fn place(&self, time: f64, poses: &mut [Pose]) {
        let state = self.tracks.state(time);
        for cluster in self.clusters.iter().filter(|cluster| cluster.exists(time, self.tracks.duration)) {
            let kinematics = Kinematics::new(&self.tracks.robot, &state.bonds, cluster.base);
            let base = cluster.path.at(time, &self.tolerances);
            kinematics.link_poses(&state.joints, &base, poses);
        }
    }
}

impl ClusterPath {
    /// Returns the world pose of the base's body (`X_WB`, m) at samples of the judge, as (time in s, pose), in order of
    /// time.
    pub fn poses(&self) -> &[(f64, Pose)] {
        &self.path.poses
    }

    /// Returns true if the cluster exists just after a time (s), or at the end of the plan, at `end` (s).
    pub fn exists(&self, time: f64, end: f64) -> bool {
        self.from <= time && (time < self.to || self.to == end)
    }
}
