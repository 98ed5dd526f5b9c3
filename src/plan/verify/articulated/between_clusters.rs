//! Collisions between the clusters of a robot that has come apart, from sample to sample.
//!
//! The base of each cluster moves over the ground by itself, and nothing here bounds its motion between samples: what is
//! said is said of the samples.

use super::base_path::BasePath;
use super::blame::{BLAMED_MAX, suspects};
use super::bodies::Bodies;
use super::clusters::Cluster;
use super::collision::Collision;
use super::rollout::Rollout;
use crate::geometry::Pose;
use crate::interrupt;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CauseId, CheckKind, ExemptionKind, Status, Tracks};
use crate::robot::{JointId, JointOwner, Kinematics};
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
    let mut placed = PlacedClusters::new(rollout, clusters, paths);
    let mut found: BTreeMap<(usize, usize), Collision> = BTreeMap::new();
    for &time in &times {
        interrupt::checkpoint();
        let alive = placed.place(time);
        for (i, &a) in alive.iter().enumerate() {
            for &b in &alive[i + 1..] {
                for (x, y) in pairs(&clusters[a], &clusters[b]) {
                    observe(&bodies, &placed, (x, y), time, &mut found, ledger);
                }
            }
        }
    }
    let joints: Vec<JointOwner> = tracks.robot.joints().collect();
    for collision in found.into_values() {
        let mut failure = collision.failure(&tracks.robot);
        let of = |module: usize| {
            clusters.iter().rposition(|c| c.from <= failure.time && c.modules.contains(&module))
        };
        let both = [of(collision.modules.0), of(collision.modules.1)];
        let moves = |joint: usize| match joints[joint] {
            JointOwner::Module { module, .. } => both.contains(&of(module)),
            JointOwner::Bond(bond) => both.contains(&of(tracks.robot.bonds[bond].a.module)),
        };
        let moving = suspects(tracks, failure.time).into_iter().filter(|s| {
            let track = tracks.track(JointId(s.joint as u32));
            let until = track.and_then(|track| track.segments.iter().find(|g| g.start == s.start));
            moves(s.joint) && until.is_some_and(|segment| segment.end >= failure.time)
        });
        let mut blame: Vec<CauseId> = Vec::new();
        for suspect in moving {
            if !blame.contains(&suspect.cause) && blame.len() < BLAMED_MAX {
                blame.push(suspect.cause);
            }
        }
        failure.blame = blame;
        if failure.blame.is_empty() {
            let undone = tracks.events.iter().rfind(|event| event.time <= failure.time);
            failure.blame.extend(undone.map(|event| event.cause));
        }
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

/// Takes the distances of the links of two modules at a time (s): keeps the least in the verdict, and the deepest
/// collision that no exemption excuses.
fn observe(
    bodies: &Bodies,
    placed: &PlacedClusters,
    (x, y): (usize, usize),
    time: f64,
    found: &mut BTreeMap<(usize, usize), Collision>,
    ledger: &mut Ledger,
) {
    let (poses, numbers) = (&placed.poses, &placed.numbers);
    let origin = |module: usize| poses[numbers.link(module, 0)].translation.vector;
    let known = ledger.verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value);
    let deepest = found.get(&(x, y)).map_or(0.0, |collision| -collision.depth);
    let enough = known.max(deepest);
    if (origin(x) - origin(y)).norm() - bodies.reach[x] - bodies.reach[y] >= enough.max(0.0) {
        return;
    }
    for a in bodies.first_of_links(x).map(|body| bodies.bodies[body].link) {
        for b in bodies.first_of_links(y).map(|body| bodies.bodies[body].link) {
            let mut distance = bodies.distance(a, b, poses, enough.max(0.0));
            let links = (a - numbers.link(x, 0), b - numbers.link(y, 0));
            if bodies.may_enclose(x) || bodies.may_enclose(y) {
                let X_AB = poses[a].inverse() * poses[b];
                let enclosed = bodies.enclosed_depth((x, links.0), (y, links.1), &X_AB);
                distance = if enclosed > 0.0 { distance.min(-enclosed) } else { distance };
            }
            if distance < known {
                let names =
                    || [x, y].map(|module| placed.rollout.tracks.robot.modules[module].name.clone()).into();
                keep_least(&mut ledger.verdict.clearance, distance, time, names);
            }
            let allowed = bodies.allowed_depth(x, y);
            let excuse = |kind: &ExemptionKind| match kind {
                ExemptionKind::Collision(None) => true,
                ExemptionKind::Collision(Some(pair)) => [(x, y), (y, x)].contains(pair),
                _ => false,
            };
            if distance >= -allowed || ledger.excuses(CheckKind::Collision, time, excuse) {
                continue;
            }
            let collision = found.entry((x, y)).or_insert(Collision {
                modules: (x, y),
                links,
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

/// The poses of all links of a robot that has come apart.
struct PlacedClusters<'a> {
    rollout: &'a Rollout<'a>,
    clusters: &'a [Cluster],
    paths: &'a [BasePath],
    /// The kinematics of the whole robot, which gives its links their numbers.
    numbers: Kinematics,
    /// The kinematics of each cluster with the bonds that hold, which are kept beside it.
    own: Vec<(Vec<bool>, Kinematics)>,
    /// The world poses of all links of the plan's robot (`X_WL`), by their numbers, m.
    poses: Vec<Pose>,
}

impl<'a> PlacedClusters<'a> {
    fn new(rollout: &'a Rollout<'a>, clusters: &'a [Cluster], paths: &'a [BasePath]) -> PlacedClusters<'a> {
        let tracks = rollout.tracks;
        let numbers = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
        let own = clusters.iter().map(|cluster| {
            let Tracks { robot, start, .. } = &cluster.tracks;
            (start.bonds.clone(), Kinematics::new(robot, &start.bonds, robot.base))
        });
        let (own, poses) = (own.collect(), vec![Pose::identity(); numbers.link_count()]);
        PlacedClusters { rollout, clusters, paths, numbers, own, poses }
    }

    /// Computes the poses of the links of all clusters that exist at a time (s), and returns these by their numbers.
    fn place(&mut self, time: f64) -> Vec<usize> {
        let exists = |c: &Cluster| c.from <= time && (time < c.to || c.to == self.rollout.end);
        let alive: Vec<usize> = (0..self.clusters.len()).filter(|&c| exists(&self.clusters[c])).collect();
        for &index in &alive {
            let Cluster { tracks, modules, .. } = &self.clusters[index];
            let state = tracks.state(time);
            if self.own[index].0 != state.bonds {
                let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
                self.own[index] = (state.bonds, kinematics);
            }
            let kinematics = &self.own[index].1;
            let mut poses = vec![Pose::identity(); kinematics.link_count()];
            let base = self.paths[index].at(time, self.rollout.tolerances);
            kinematics.link_poses(&state.joints, &base, &mut poses);
            for (own, &module) in modules.iter().enumerate() {
                for link in 0..tracks.robot.module_type(own).links.len() {
                    self.poses[self.numbers.link(module, link)] = poses[kinematics.link(own, link)];
                }
            }
        }
        alive
    }
}
