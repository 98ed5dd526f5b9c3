//! Bounding balls of clusters and obstacles, and bounds on how far clusters move between samples: pairs that are far apart
//! need no look at their links.

use super::base_path::BasePath;
use super::bodies::Bodies;
use super::clusters::Cluster;
use crate::geometry::{Pose, Solid, Vec3};
use crate::plan::Tracks;
use crate::robot::{Kinematics, Motion};

/// The balls around clusters and obstacles at a sample. Clusters have their numbers, obstacles come after them.
pub(super) struct ClusterBalls<'a> {
    clusters: &'a [Cluster],
    paths: &'a [BasePath],
    /// The levers of the joints of each cluster, by which a unit of their motion moves its points at most.
    levers: Vec<Vec<f64>>,
    /// The modules of the obstacles, one for each, by their indices in the robot.
    obstacles: Vec<[usize; 1]>,
    /// The centre and the radius of each ball, m; those of clusters that are not there mean nothing.
    balls: Vec<(Vec3, f64)>,
    /// A bound on how far any point of a cluster gets from where it is at the sample until the samples before and after, m.
    motions: Vec<f64>,
}

impl<'a> ClusterBalls<'a> {
    /// Returns the balls before the first sample. `tracks`: those of the plan, whose last modules are the obstacles.
    pub(super) fn new(
        tracks: &Tracks,
        clusters: &'a [Cluster],
        paths: &'a [BasePath],
        bodies: &Bodies,
    ) -> ClusterBalls<'a> {
        let reach = |cluster: &Cluster| {
            cluster.modules.iter().map(|module| bodies.reach[*module]).collect::<Vec<_>>()
        };
        let levers = clusters.iter().map(|cluster| levers(cluster, &reach(cluster))).collect();
        let first = tracks.robot.modules.len() - tracks.obstacles.len();
        let obstacles: Vec<[usize; 1]> = (first..tracks.robot.modules.len()).map(|module| [module]).collect();
        let mut balls = vec![(Vec3::zeros(), 0.0); clusters.len()];
        // Unsound shapes have been refused.
        let ball = |solid: Solid| (solid.centre, solid.radius);
        let of_shapes = tracks
            .obstacles
            .iter()
            .map(|one| Solid::new(&one.shapes).map_or_else(|_| (Vec3::zeros(), 0.0), ball));
        balls.extend(of_shapes);
        let motions = vec![0.0; balls.len()];
        ClusterBalls { clusters, paths, levers, obstacles, balls, motions }
    }

    /// Returns the numbers of the obstacles.
    pub(super) fn obstacles(&self) -> Vec<usize> {
        (self.clusters.len()..self.balls.len()).collect()
    }

    /// Returns the modules of a cluster or an obstacle, by their indices in the robot.
    pub(super) fn modules(&self, number: usize) -> &[usize] {
        match self.clusters.get(number) {
            Some(cluster) => &cluster.modules,
            None => &self.obstacles[number - self.clusters.len()],
        }
    }

    /// Computes the balls of clusters, given by their numbers, at a sample (s), from the poses of all links, by their
    /// numbers.
    pub(super) fn place(
        &mut self,
        existing: &[usize],
        time: f64,
        bodies: &Bodies,
        numbers: &Kinematics,
        poses: &[Pose],
    ) {
        for &index in existing {
            let cluster = &self.clusters[index];
            let origin = |module: usize| numbers.module_pose(module, poses).translation.vector;
            let centre = origin(cluster.base());
            let reach = |&module: &usize| (origin(module) - centre).norm() + bodies.reach[module];
            let radius = cluster.modules.iter().map(reach).fold(0.0, f64::max);
            self.balls[index] = (centre, radius);
            self.motions[index] = motion(cluster, &self.paths[index], time, (radius, &self.levers[index]));
        }
    }

    /// Returns a lower bound on the distance of two clusters or obstacles, m.
    pub(super) fn distance(&self, a: usize, b: usize) -> f64 {
        let ((p, r), (q, s)) = (self.balls[a], self.balls[b]);
        (p - q).norm() - r - s
    }

    /// Returns the bound on the motion of a cluster between samples, m; 0 for an obstacle.
    pub(super) fn motion(&self, number: usize) -> f64 {
        self.motions[number]
    }
}

/// Returns a bound on how far any point of a cluster within `radius` (m) of its base gets from where it is at a time (s) until
/// the samples before and after: by twice the motion of its base between samples, and by that of its joints, each with its
/// lever (m).
fn motion(cluster: &Cluster, path: &BasePath, time: f64, (radius, levers): (f64, &[f64])) -> f64 {
    let before = path.poses.partition_point(|(at, _)| *at < time).saturating_sub(1);
    let after = path.poses.partition_point(|(at, _)| *at <= time).min(path.poses.len() - 1);
    let around = &path.poses[before..=after.max(before)];
    let base: f64 = around
        .windows(2)
        .map(|ends| {
            let turn = ends[0].1.rotation.angle_to(&ends[1].1.rotation);
            (ends[0].1.translation.vector - ends[1].1.translation.vector).norm() + turn * radius
        })
        .sum();
    let span = (around[0].0, around[around.len() - 1].0);
    let tracks = &cluster.tracks;
    let joints: f64 = tracks
        .tracks
        .iter()
        .map(|track| {
            let joint = track.joint.0 as usize;
            let start = tracks.start.joints[joint];
            let at = track.position(start, time);
            let (low, high) = track.bounds(start, span.0, span.1);
            (high - at).max(at - low) * levers[joint]
        })
        .sum();
    2.0 * base + joints
}

/// Returns for each joint of a cluster an upper bound on the motion of any point of it, seen from its base, for a unit of the
/// joint's motion: m for one radian, no unit for a slide.
fn levers(cluster: &Cluster, reach: &[f64]) -> Vec<f64> {
    let robot = &cluster.tracks.robot;
    let all: f64 = 2.0 * reach.iter().sum::<f64>();
    let mut levers = vec![0.0_f64; robot.joints().count()];
    let kinematics = Kinematics::new(robot, &cluster.tracks.start.bonds, robot.base);
    // The farthest point beyond each link, by chains of modules.
    let mut beyond: Vec<f64> =
        (0..kinematics.link_count()).map(|link| 2.0 * reach[kinematics.module_of(link)]).collect();
    for step in kinematics.steps.iter().rev() {
        let [module, parent] = [step.link, step.parent].map(|link| kinematics.module_of(link));
        let own = if module == parent { 0.0 } else { 2.0 * reach[parent] };
        beyond[step.parent] = beyond[step.parent].max(own + beyond[step.link]);
        // With loops that open and close on the way the tree changes.
        let lever = if cluster.tracks.events.is_empty() { beyond[step.link] } else { all };
        let slides = matches!(step.motion, Motion::Along(_));
        for (joint, factor) in step.terms() {
            levers[*joint] += factor.abs() * if slides { 1.0 } else { lever };
        }
    }
    levers
}
