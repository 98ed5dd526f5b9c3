//! Collisions between the clusters of a robot that has come apart, from sample to sample.
//!
//! The base of each cluster moves over the ground by itself, and nothing here bounds its motion between samples: what is
//! said is said of the samples.

use super::base_path::BasePath;
use super::blame::{Candidate, distinct, suspects};
use super::bodies::Bodies;
use super::clusters::Cluster;
use super::collision::Collision;
use super::placed_clusters::PlacedClusters;
use super::rollout::Rollout;
use crate::geometry::Pose;
use crate::interrupt;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, ExemptionKind, Status, Tracks};
use crate::robot::{JointOwner, Kinematics};
use crate::units::{Dimension, quantity};
use std::collections::BTreeMap;

/// Judges whether links of two clusters meet that are apart at the same time, at all samples of either: records
/// collisions, the least distance, and the number of samples. `rollout`: that of the whole plan; `paths`: those of the
/// clusters' bases, one for each. `ended`: the time from which a cluster no longer moves as planned (s) and the check
/// that says so; `None` if all do.
pub(super) fn judge(
    rollout: &Rollout,
    (clusters, paths): (&[Cluster], &[BasePath]),
    ended: Option<(f64, CheckKind)>,
    ledger: &mut Ledger,
) {
    let tracks = rollout.tracks;
    // An unsound shape is a failure of the cluster that has it.
    let Ok(bodies) = Bodies::of_plan(tracks) else { return };
    let split = clusters.iter().filter(|c| c.parent.is_some()).map(|c| c.from).fold(f64::INFINITY, f64::min);
    let mut times: Vec<f64> = paths
        .iter()
        .flat_map(|path| path.poses.iter().map(|pose| pose.0))
        .filter(|t| *t >= split && ended.is_none_or(|(end, _)| *t < end))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let pairs_of = clusters.iter().zip(paths).collect();
    let mut placed = PlacedClusters::new(tracks, pairs_of, rollout.tolerances);
    let numbers = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
    let mut links =
        PlacedLinks { tracks, bodies: &bodies, poses: vec![Pose::identity(); numbers.link_count()], numbers };
    let mut found: BTreeMap<(usize, usize), Collision> = BTreeMap::new();
    for &time in &times {
        interrupt::checkpoint();
        let existing = placed.place(time, &mut links.poses);
        for (i, &a) in existing.iter().enumerate() {
            for &b in &existing[i + 1..] {
                for pair in pairs(&clusters[a], &clusters[b]) {
                    links.observe(pair, time, &mut found, ledger);
                }
            }
        }
    }
    let joints: Vec<JointOwner> = tracks.robot.joints().collect();
    for collision in found.into_values() {
        let mut failure = collision.failure(&tracks.robot);
        let cluster_of = |module: usize| {
            clusters.iter().rposition(|c| c.from <= failure.time && c.modules.contains(&module))
        };
        let both = [collision.modules.0, collision.modules.1].map(cluster_of);
        let concerned = |s: &Candidate| both.contains(&cluster_of(tracks.robot.module_of(joints[s.joint])));
        let suspects = suspects(tracks, failure.time);
        let moving = suspects.iter().filter(|s| s.moving && concerned(s)).map(|s| s.cause);
        let mut blame = distinct(moving);
        if blame.is_empty() {
            let undone = tracks.events.iter().rfind(|event| event.time <= failure.time);
            blame.extend(undone.map(|event| event.cause));
        }
        failure.blame = blame;
        ledger.fail(failure);
    }
    ledger.verdict.samples += times.len();
    let status = match ended {
        Some((time, kind)) => Status::NotChecked(format!(
            "between parts, from {} on: {} fails",
            quantity(time, Dimension::TIME),
            kind.name()
        )),
        None => Status::Sampled(times.len()),
    };
    ledger.check(CheckKind::Collision, status);
}

/// Returns the pairs of a module of one cluster and one of another, by their indices in the plan's robot.
fn pairs<'c>(a: &'c Cluster, b: &'c Cluster) -> impl Iterator<Item = (usize, usize)> + 'c {
    a.modules.iter().flat_map(|&x| b.modules.iter().map(move |&y| (x, y)))
}

/// The links of the plan's robot where they are at a time.
struct PlacedLinks<'a> {
    tracks: &'a Tracks,
    bodies: &'a Bodies,
    /// The kinematics of the whole robot, which gives its links their numbers.
    numbers: Kinematics,
    /// The world poses of all links (`X_WL`), by their numbers, m.
    poses: Vec<Pose>,
}

impl PlacedLinks<'_> {
    /// Takes the distances of the links of two modules at a time (s): keeps the least in the verdict, and the deepest
    /// collision that no exemption excuses.
    fn observe(
        &self,
        (x, y): (usize, usize),
        time: f64,
        found: &mut BTreeMap<(usize, usize), Collision>,
        ledger: &mut Ledger,
    ) {
        let bodies = self.bodies;
        let origin = |module: usize| self.numbers.module_pose(module, &self.poses).translation.vector;
        let known = ledger.verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value);
        let enough = known.max(0.0);
        if (origin(x) - origin(y)).norm() - bodies.reach[x] - bodies.reach[y] >= enough {
            return;
        }
        let links = |module: usize| bodies.first_of_links(module).map(|body| bodies.bodies[body].link);
        let own = |module: usize, link: usize| (module, link - self.numbers.link(module, 0));
        for (a, b) in links(x).flat_map(|a| links(y).map(move |b| (own(x, a), own(y, b)))) {
            let distance = bodies.signed_distance(&self.numbers, (a, b), &self.poses, enough);
            if distance < known {
                let names = || [x, y].map(|module| self.tracks.robot.modules[module].name.clone()).into();
                keep_least(&mut ledger.verdict.clearance, distance, time, names);
            }
            let allowed = bodies.allowed_depth(x, y);
            let excuse = |kind: &ExemptionKind| match kind {
                ExemptionKind::Collision(modules) => {
                    modules.is_none_or(|pair| pair == (x, y) || pair == (y, x))
                }
                _ => false,
            };
            if distance >= -allowed || ledger.excuses(CheckKind::Collision, time, excuse) {
                continue;
            }
            let collision = found.entry((x, y)).or_insert(Collision {
                modules: (x, y),
                links: (a.1, b.1),
                time,
                depth: 0.0,
                deepest: time,
                allowed,
                exempt: false,
                bond: None,
            });
            if -distance > collision.depth {
                (collision.depth, collision.deepest) = (-distance, time);
            }
        }
    }
}
