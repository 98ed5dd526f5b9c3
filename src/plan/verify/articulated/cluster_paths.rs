//! The paths of several clusters, for those who draw or measure them. Nothing is judged here.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::history::{base_at, settings_to_see};
use super::parted;
use super::placed_clusters::PlacedClusters;
use super::rollout::roll_out;
use super::rollout_input::Rollout;
use super::succession;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::{Body, DockingKind, Plan, Tracks, validation};
use crate::robot::{Assembly, ClusterPose, Kinematics, Misalignment, State};

/// The path of one cluster: modules that bonds connect, from the instant at which it comes to be by docking or undocking, or
/// the start, until it does not hold any more.
#[derive(Clone, Debug)]
pub struct ClusterPath {
    cluster: Cluster,
    path: BasePath,
}

/// The paths of all clusters of a plan.
#[derive(Clone, Debug)]
pub struct ClusterPaths<'a> {
    tracks: &'a Tracks,
    /// The clusters, each after those of whose modules it consists.
    pub clusters: Vec<ClusterPath>,
    tolerances: Tolerances,
}

/// Returns true if a valid plan has several clusters, robots that stand by themselves or parts that come off one, or one whose
/// bonds do not all mate perfectly.
pub fn comes_apart(plan: &Plan) -> bool {
    let Body::Tracks(tracks) = &plan.body else { return false };
    let undocks = tracks.events.iter().any(|event| event.kind == DockingKind::Undock);
    let apart = !tracks.start.clusters.is_empty() || !tracks.start.misalignments.is_empty();
    (undocks || apart)
        && validation::check(plan).is_ok()
        && parted::several(&Rollout::of(plan, tracks, &Tolerances::default())).is_some()
}

/// Returns the state at a time (s) of a plan that has several clusters at some time: where they are then, as the rollout of the
/// judge has brought them there, with the errors that bonds of a scene docked with. `None` for one robot that stays one, for plans of
/// other families and plans that are not valid, and where the rollout did not get there.
pub fn standing(plan: &Plan, time: f64) -> Option<State> {
    let tracks = plan.body.tracks()?;
    let paths = ClusterPaths::of(plan, time)?;
    let kinematics = Kinematics::new(&tracks.robot, &tracks.start.bonds, tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let holds = |cluster: &&ClusterPath| cluster.modules().binary_search(&tracks.robot.base).is_ok();
    paths.clusters.iter().filter(|cluster| cluster.exists(time)).find(holds)?;
    paths.place(time, &mut poses);
    let base = kinematics.module_pose(tracks.robot.base, &poses);
    let there = paths.clusters.iter().filter(|cluster| cluster.exists(time));
    let others = there.filter(|cluster| cluster.modules().binary_search(&tracks.robot.base).is_err());
    let pose = |cluster: &ClusterPath| ClusterPose {
        reference: cluster.base(),
        pose: cluster.path.at(time, &paths.tolerances),
    };
    let mut further: Vec<ClusterPose> = others.map(pose).collect();
    further.sort_by_key(|cluster| cluster.reference);
    // A robot that comes apart and docks again is drawn with perfect bonds, and begins so.
    let scene = !tracks.start.clusters.is_empty() || !tracks.start.misalignments.is_empty();
    let holding = paths.clusters.iter().filter(|cluster| scene && cluster.exists(time));
    let errors = holding.flat_map(|cluster| cluster.cluster.misalignments());
    let mut misalignments: Vec<Misalignment> =
        errors.map(|(bond, pose)| Misalignment { bond, pose }).collect();
    misalignments.sort_by_key(|error| error.bond);
    Some(State { base, clusters: further, misalignments, ..tracks.state(time) })
}

/// Returns the world poses of the base and of the references of further clusters at the start of a plan, m, as the judge
/// settles them; as the plan states them where it does not. `tracks`: the plan's.
pub fn start_poses(plan: &Plan, tracks: &Tracks) -> (Pose, Vec<ClusterPose>) {
    let base = base_at(plan, 0.0).unwrap_or(tracks.start.base);
    let mut clusters = tracks.start.clusters.clone();
    if let Some(paths) = ClusterPaths::of(plan, 0.0).filter(|_| !clusters.is_empty()) {
        for cluster in &mut clusters {
            let settled = paths.clusters.iter().find(|path| path.base() == cluster.reference);
            cluster.pose = settled.map_or(cluster.pose, |path| path.poses()[0].1);
        }
    }
    (base, clusters)
}

/// Returns the path of a robot's base over its rollout, until a time (s) or the end of its tracks.
pub(super) fn roll_out_path(rollout: Rollout, until: f64) -> BasePath {
    let mut path = BasePath::default();
    roll_out(rollout, None, until.min(rollout.tracks.duration), &mut |sample, _| {
        path.poses.push((sample.time, sample.stance.base_pose(sample.model)));
        true
    });
    path
}

impl<'a> ClusterPaths<'a> {
    /// Returns the paths of the clusters of an articulated robot's plan up to a time (s), by the judge's rollout; `None`
    /// for one robot that stays one, for plans of other families, and for plans that are not valid.
    pub fn of(plan: &'a Plan, until: f64) -> Option<ClusterPaths<'a>> {
        let Body::Tracks(tracks) = &plan.body else { return None };
        if !comes_apart(plan) {
            return None;
        }
        let tolerances = Tolerances::default();
        let mut rollout = Rollout::of(plan, tracks, &tolerances);
        let settings = settings_to_see(&rollout);
        rollout.settings = &settings;
        let mut clusters = parted::clusters(&rollout)?;
        let paths = succession::follow(&rollout, &mut clusters, until, &mut |begun| {
            roll_out_path(begun.rollout(&rollout), until)
        });
        let followed = clusters.into_iter().zip(paths).filter(|(_, path)| !path.poses.is_empty());
        let clusters = followed.map(|(cluster, path)| ClusterPath { cluster, path }).collect();
        Some(ClusterPaths { tracks, clusters, tolerances })
    }

    /// Writes the world poses of all links of the plan's robot at a time (s), `X_WL` in m, by their numbers
    /// ([`Kinematics::link`](crate::robot::Kinematics::link)). Panics if there are fewer of them than links.
    pub fn place(&self, time: f64, poses: &mut [Pose]) {
        let clusters = self.clusters.iter().map(|known| (&known.cluster, &known.path)).collect();
        PlacedClusters::new(self.tracks, clusters, &self.tolerances).place(time, poses);
    }
}

impl ClusterPath {
    /// Returns the modules of the cluster, by their indices in the plan's robot, ascending.
    pub fn modules(&self) -> &[usize] {
        &self.cluster.modules
    }

    /// Returns the module whose body's pose is followed, by its index in the plan's robot.
    pub fn base(&self) -> usize {
        self.cluster.base()
    }

    /// Returns the kinematics of the plan's robot from the base of the cluster with the errors that its bonds docked with.
    /// `bonds`: for every bond of that robot, by its index, true if it holds.
    pub fn kinematics(&self, robot: &Assembly, bonds: &[bool]) -> Kinematics {
        let misalignments = self.cluster.misalignments();
        match misalignments.is_empty() {
            true => Kinematics::new(robot, bonds, self.base()),
            false => Kinematics::new(&Assembly { misalignments, ..robot.clone() }, bonds, self.base()),
        }
    }

    /// Returns the world pose of the base's body (`X_WB`, m) at samples of the judge, as (time in s, pose), in order of
    /// time.
    pub fn poses(&self) -> &[(f64, Pose)] {
        &self.path.poses
    }

    /// Returns true if the cluster is there just after a time (s), or at the end of the plan.
    pub fn exists(&self, time: f64) -> bool {
        self.cluster.exists(time)
    }
}
