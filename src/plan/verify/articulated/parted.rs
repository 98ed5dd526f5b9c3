//! The judgement of a robot that comes apart: each cluster by itself, on its own support, and each pair of them against
//! collisions.

use super::base_path::BasePath;
use super::between_clusters;
use super::clusters::{self, Cluster};
use super::entry::Entry;
use super::model::Model;
use super::one_robot;
use super::rollout::Rollout;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, DockingEvent, Failure, Ground, Status, Tracks};
use crate::robot::Kinematics;
use crate::units::{Dimension, counted, quantity};

/// Returns the clusters of a plan, and the event that joins two of them again, as [`clusters::of`] does: the base of a
/// part that comes off without the plan's is the module nearest to its centre of mass.
pub(super) fn clusters(rollout: &Rollout) -> Option<(Vec<Cluster>, Option<DockingEvent>)> {
    clusters::of(rollout.tracks, rollout.exemptions, |cluster| central(cluster, rollout.tolerances))
}

/// Returns the module of a cluster whose body is nearest to the centre of mass as it comes off; the first of those
/// equally near.
fn central(cluster: &Cluster, tolerances: &Tolerances) -> usize {
    let (robot, state) = (&cluster.tracks.robot, cluster.tracks.state(cluster.from));
    let model = Model::new(robot, &state.bonds);
    let mut poses = Vec::new();
    let centre = model.posture(&state.joints, &mut poses).centre;
    let distance =
        |module: usize| (model.kinematics.module_pose(module, &poses).translation.vector - centre).norm();
    (1..robot.modules.len()).fold(0, |nearest, module| {
        if distance(module) < distance(nearest) - tolerances.nearest { module } else { nearest }
    })
}

/// Judges the clusters of a plan one after the other: failures and worst values are those of all, and the travel is that
/// of the parts with the plan's base. `rollout`: that of the whole plan. `missed`: the bonds whose ports missed when
/// they docked, by their indices in the plan's robot.
pub(super) fn judge(rollout: &Rollout, clusters: &[Cluster], missed: &[usize], ledger: &mut Ledger) {
    let mut paths: Vec<BasePath> = Vec::with_capacity(clusters.len());
    let mut parts = Vec::with_capacity(clusters.len() + 1);
    for cluster in clusters {
        let parent = cluster.parent.map(|parent| (&clusters[parent], &paths[parent]));
        let entry = parent.map(|(before, path)| entry(rollout, cluster, before, path));
        let own = cluster.rollout(rollout, entry.as_ref());
        let mut part = Ledger::new(&cluster.exemptions, rollout.end);
        let missed = missed.iter().filter_map(|bond| cluster.bonds.binary_search(bond).ok()).collect();
        let mut path = BasePath::default();
        let came_off = entry.as_ref().zip(parent);
        if let Some((entry, _)) = came_off.filter(|(_, (before, _))| cluster.base() != before.base()) {
            unheld(&own, entry, &mut part);
        }
        one_robot::judge(&own, missed, &mut part, Some(&mut path));
        let moves = |before: &Cluster, path| own.is_full() && moves(&before.tracks, path, rollout.tolerances);
        if let Some((entry, _)) = came_off.filter(|(_, (before, path))| moves(before, path)) {
            momentum_is_lost(entry, &mut part);
        }
        if cluster.modules.contains(&rollout.tracks.robot.base) {
            let (sum, own) = (&mut ledger.verdict, &part.verdict);
            (0..3).for_each(|axis| sum.travel[axis] += own.travel[axis]);
            sum.heading += own.heading;
        }
        if path.poses.is_empty() {
            // The judge gave up on this part, and said so: nothing is known of what comes off it.
            parts.push(part);
            return ledger.merge(parts);
        }
        paths.push(path);
        parts.push(part);
    }
    let mut between = Ledger::new(rollout.exemptions, rollout.end);
    let ended = parts.iter().filter_map(Ledger::ended).min_by(|a, b| a.0.total_cmp(&b.0));
    between_clusters::judge(rollout, (clusters, &paths), ended, &mut between);
    parts.push(between);
    ledger.merge(parts);
}

/// Returns in words which parts the robot comes apart into, with their times.
pub(super) fn in_words(clusters: &[Cluster]) -> String {
    let part = |cluster: &Cluster| {
        let count = counted(cluster.modules.len(), "module");
        format!("{} ({count}) from {}", name(cluster), quantity(cluster.from, Dimension::TIME))
    };
    let off = clusters.iter().filter(|cluster| cluster.parent.is_some());
    format!("the robot comes apart: {}", off.map(part).collect::<Vec<_>>().join(", "))
}

/// Returns a cluster in words, by its base.
fn name(cluster: &Cluster) -> String {
    let robot = &cluster.tracks.robot;
    format!("the part with `{}`", robot.modules[robot.base].name)
}

/// Returns the beginning of a cluster where the one that it was a part of left it. `path`: that of the other.
pub(super) fn entry(rollout: &Rollout, cluster: &Cluster, before: &Cluster, path: &BasePath) -> Entry {
    let state = before.tracks.state(cluster.from);
    let kinematics = Kinematics::new(&before.tracks.robot, &state.bonds, before.tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&state.joints, &path.at(cluster.from, rollout.tolerances), &mut poses);
    let base = before.modules.binary_search(&cluster.base()).expect("a part is of its parent's modules");
    let causes: Vec<CauseId> = rollout
        .tracks
        .events
        .iter()
        .filter(|event| event.time == cluster.from && before.bonds.binary_search(&event.bond).is_ok())
        .map(|event| event.cause)
        .collect();
    Entry { time: cluster.from, base: kinematics.module_pose(base, &poses), name: name(cluster), causes }
}

/// Records that nothing holds a part: in a world whose fixture holds the base of another, it falls.
fn unheld(rollout: &Rollout, entry: &Entry, ledger: &mut Ledger) {
    let mut worlds = rollout.worlds.iter().enumerate();
    let found = worlds.find(|(index, from)| {
        let until = rollout.worlds.get(index + 1).map_or(f64::INFINITY, |next| next.from);
        let fixed = matches!(from.world.ground, Ground::Held | Ground::Fixed) && from.world.gravity > 0.0;
        fixed && from.from <= rollout.tracks.duration && until > entry.time
    });
    let Some((_, from)) = found else { return };
    let time = from.from.max(entry.time);
    let message = format!("{} falls at {}: nothing holds it", entry.name, quantity(time, Dimension::TIME));
    let robot = &rollout.tracks.robot;
    ledger.fail(Failure {
        kind: CheckKind::Stability,
        time,
        at: vec![robot.modules[robot.base].name.clone()],
        blame: entry.causes.clone(),
        ..Failure::form(message)
    });
}

/// Returns true if joints of a robot turn or slide as its motion ends, or its base moves.
fn moves(tracks: &Tracks, path: &BasePath, tolerances: &Tolerances) -> bool {
    let end = tracks.duration;
    let fast = |velocity: f64| velocity.abs() > tolerances.speed_jump;
    let turns = tracks.tracks.iter().any(|track| {
        let mut around = track.segments.iter().filter(|segment| segment.start <= end && end <= segment.end);
        around.any(|segment| fast(segment.velocity(end)))
    });
    turns || path.ends_faster(tolerances.rest_speed)
}

/// Records that travel and balance of a part are not checked, as it comes off in motion.
fn momentum_is_lost(entry: &Entry, ledger: &mut Ledger) {
    let why = format!("{} comes off in motion, and its momentum is not carried over", entry.name);
    for check in &mut ledger.verdict.checks {
        let kind = [CheckKind::Traction, CheckKind::Balance].contains(&check.kind);
        if kind && check.status != Status::Failed {
            check.status = Status::NotChecked(why.clone());
        }
    }
}
