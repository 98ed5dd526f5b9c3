//! The judgement of several clusters, robots that stand by themselves or parts that have come off one: each by itself, on its
//! own support, and each pair of them against collisions.

use super::base_path::BasePath;
use super::between_clusters;
use super::clusters::{self, Cluster};
use super::docking;
use super::dynamics;
use super::entry::Entry;
use super::in_force::world_at;
use super::model::Model;
use super::one_robot;
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use super::succession::{self, Begun};
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Exemption, Failure, Ground, RobotVerdict, Status, WorldFrom};
use crate::robot::{Kinematics, Misalignment, Residual};
use crate::units::{Dimension, counted, quantity};

/// Returns the clusters of a plan, as [`clusters::of`] does: the base of a cluster that has none of those before, nor one
/// that is stated, is the module nearest to its centre of mass.
pub(super) fn clusters(rollout: &Rollout) -> Option<Vec<Cluster>> {
    let mut clusters =
        clusters::of(rollout.tracks, rollout.exemptions, |cluster| central(cluster, rollout.tolerances))?;
    let mut released: Vec<bool> = Vec::with_capacity(clusters.len());
    for index in 0..clusters.len() {
        let cluster = &clusters[index];
        let off = |parent: &usize| released[*parent] || cluster.base() != clusters[*parent].base();
        released.push(!cluster.parents.is_empty() && cluster.parents.iter().all(off));
        if released[index] {
            clusters[index].worlds = Some(rollout.worlds.iter().map(unheld_in).collect());
        }
    }
    Some(clusters)
}

/// Returns the clusters of a plan, as [`clusters`] does, if each must be followed by itself: several, or one with bonds that do
/// not mate perfectly; `None` otherwise.
pub(super) fn several(rollout: &Rollout) -> Option<Vec<Cluster>> {
    let perfect = rollout.tracks.start.misalignments.is_empty();
    clusters(rollout).filter(|clusters| clusters.len() > 1 || !perfect)
}

/// Returns the world as it is for what no fixture holds: without weight it floats.
fn unheld_in(from: &WorldFrom) -> WorldFrom {
    let mut from = from.clone();
    let fixed = matches!(from.world.ground, Ground::Held | Ground::Fixed);
    if fixed && from.world.gravity == 0.0 {
        from.world.ground = Ground::Off;
    }
    from
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
/// of the clusters with the plan's base. `rollout`: that of the whole plan.
pub(super) fn judge(rollout: &Rollout, clusters: &mut [Cluster], ledger: &mut Ledger) {
    let exemptions: Vec<Vec<Exemption>> = clusters.iter().map(|cluster| cluster.exemptions.clone()).collect();
    let mut parts = Vec::with_capacity(clusters.len() + 1);
    let mut missed = misaligned_at_start(rollout, ledger);
    let paths = succession::follow(rollout, clusters, f64::INFINITY, &mut |begun| {
        let mut part = Ledger::new(&exemptions[begun.index], rollout.end);
        let path = judge_one(rollout, &begun, &mut missed, &mut part);
        parts.push(part);
        path
    });
    if paths.iter().any(|path| path.poses.is_empty()) {
        // The judge gave up on one, and said so: nothing is known of what comes of it.
        return ledger.merge(parts);
    }
    let mut between = Ledger::new(rollout.exemptions, rollout.end);
    let ended = parts.iter().filter_map(Ledger::ended).min_by(|a, b| a.0.total_cmp(&b.0));
    between_clusters::judge(rollout, (clusters, &paths), ended, &mut between);
    parts.push(between);
    let travels = Travels::new(rollout, clusters, &paths, &parts);
    (ledger.verdict.travel, ledger.verdict.heading) = travels.of(rollout.tracks.robot.base);
    if !rollout.tracks.start.clusters.is_empty() {
        ledger.verdict.robots = robots(rollout, clusters, &parts, &travels);
    }
    ledger.merge(parts);
}

/// Records the bonds whose ports stand farther apart at the start than they dock, and returns them.
fn misaligned_at_start(rollout: &Rollout, ledger: &mut Ledger) -> Vec<usize> {
    let robot = &rollout.tracks.robot;
    let mut missed = Vec::new();
    for Misalignment { bond, pose } in &rollout.tracks.start.misalignments {
        let distance = pose.translation.vector.norm();
        let residual = Residual { bond: *bond, distance, angle: pose.rotation.angle() };
        if !docking::within(robot, &residual, rollout.tolerances) {
            let name = robot.bond_name(*bond);
            let message = format!("{name} does not hold at the start: {}", docking::apart(&residual));
            let found = docking::failure(CheckKind::Docking, robot, &residual, 0.0, message, vec![], rollout);
            ledger.fail(Failure { blames_start: true, ..found });
            missed.push(*bond);
        }
    }
    missed
}

/// Judges one cluster, and returns the path of its base. `missed`: the bonds of the plan's robot whose ports missed so far,
/// to which it adds.
fn judge_one(rollout: &Rollout, begun: &Begun, missed: &mut Vec<usize>, part: &mut Ledger) -> BasePath {
    let (cluster, entry) = (begun.cluster(), begun.beginning.entry.as_ref());
    let own = begun.rollout(rollout);
    missed.extend(begun.beginning.joining.judge(rollout, cluster, part));
    let before: Vec<usize> =
        missed.iter().filter_map(|bond| cluster.bonds.binary_search(bond).ok()).collect();
    let own_missed = docking::judge(&own, part);
    missed.extend(own_missed.iter().map(|bond| cluster.bonds[*bond]));
    let came_off = entry.zip(cluster.parents.first()).filter(|_| cluster.parents.len() == 1);
    if let Some((entry, _)) = came_off.filter(|(_, parent)| cluster.base() != begun.clusters[**parent].base())
    {
        unheld(&own, entry, part);
    }
    let mut path = BasePath::default();
    one_robot::judge(&own, [before, own_missed].concat(), part, Some(&mut path));
    if came_off.is_some_and(|(entry, _)| own.is_full() && lifts(&own, entry)) {
        momentum_is_lost(own.subject, part);
    }
    if cluster.lasts
        && let Some(drift) = drifts(&own, &path)
    {
        part.note(drift);
    }
    path
}

/// The way of each module over a plan of several clusters.
struct Travels<'a> {
    clusters: &'a [Cluster],
    /// The change of heading of each cluster, rad.
    headings: Vec<f64>,
    /// The displacement of each module's body from the start to the end, m.
    displacements: Vec<[f64; 3]>,
}

impl<'a> Travels<'a> {
    /// Returns the ways of all modules. `paths` and `parts`: those of the clusters' bases, and the records of what was found of
    /// them, in the order of `clusters`; others may follow.
    fn new(rollout: &Rollout, clusters: &'a [Cluster], paths: &[BasePath], parts: &[Ledger]) -> Travels<'a> {
        let tracks = rollout.tracks;
        let numbers = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
        let mut placed =
            PlacedClusters::new(tracks, clusters.iter().zip(paths).collect(), rollout.tolerances);
        let mut place = |time: f64| {
            let mut poses = vec![Pose::identity(); numbers.link_count()];
            placed.place(time, &mut poses);
            poses
        };
        let (begin, end) = (place(0.0), place(tracks.duration));
        let moved = |module: usize| {
            let at = |poses: &[Pose]| numbers.module_pose(module, poses).translation.vector;
            (at(&end) - at(&begin)).into()
        };
        Travels {
            clusters,
            headings: parts.iter().take(clusters.len()).map(|part| part.verdict.heading).collect(),
            displacements: (0..tracks.robot.modules.len()).map(moved).collect(),
        }
    }

    /// Returns (displacement, heading) of a module over the plan, m and rad.
    fn of(&self, module: usize) -> ([f64; 3], f64) {
        let own =
            self.clusters.iter().zip(&self.headings).filter(|(cluster, _)| cluster.modules.contains(&module));
        (self.displacements[module], own.map(|(_, heading)| heading).sum())
    }
}

/// Returns the verdicts on the robots with which a plan begins. `parts`: the records of its clusters, and at last that of what
/// happens between them.
fn robots(rollout: &Rollout, clusters: &[Cluster], parts: &[Ledger], travels: &Travels) -> Vec<RobotVerdict> {
    let Some((between, own)) = parts.split_last() else { return vec![] };
    let names = &rollout.tracks.robot.modules;
    let robot = |start: &Cluster| {
        let module = start.base();
        let mut verdict = Ledger::new(rollout.exemptions, rollout.end);
        let its = clusters.iter().zip(own).filter(|(cluster, _)| cluster.modules.contains(&module));
        let mut records: Vec<Ledger> = its.map(|(_, part)| part.clone()).collect();
        let mut others = between.clone();
        let concerns = |at: &[String]| start.modules.iter().any(|module| at.contains(&names[*module].name));
        others.verdict.failures.retain(|failure| concerns(&failure.at));
        others.verdict.clearance = others.verdict.clearance.filter(|worst| concerns(&worst.at));
        records.push(others);
        verdict.merge(records);
        if rollout.is_full() {
            verdict.drop_consequences();
        }
        (verdict.verdict.travel, verdict.verdict.heading) = travels.of(module);
        if rollout.is_full() {
            dynamics::bound_travel(&mut verdict.verdict);
        }
        RobotVerdict { reference: names[module].name.clone(), verdict: verdict.finish() }
    };
    clusters.iter().filter(|cluster| cluster.parents.is_empty()).map(robot).collect()
}

/// Returns in words how robots come apart and dock with each other, with their times; none where they do not.
pub(super) fn in_words(clusters: &[Cluster]) -> Option<String> {
    let part = |cluster: &Cluster| {
        let count = counted(cluster.modules.len(), "module");
        format!("{} ({count}) from {}", cluster.name, quantity(cluster.from, Dimension::TIME))
    };
    let off: Vec<String> = clusters
        .iter()
        .filter(|cluster| {
            cluster.parents.len() == 1 && clusters[cluster.parents[0]].modules != cluster.modules
        })
        .map(part)
        .collect();
    (!off.is_empty()).then(|| format!("the robot comes apart: {}", off.join(", ")))
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
    let message =
        format!("{} falls at {}: nothing holds it", rollout.subject, quantity(time, Dimension::TIME));
    let robot = &rollout.tracks.robot;
    ledger.fail(Failure {
        kind: CheckKind::Stability,
        time,
        at: vec![robot.modules[robot.base].name.clone()],
        blame: entry.causes.clone(),
        ..Failure::form(message)
    });
}

/// Returns true if a part on the ground comes off as it lifts or tilts: turning counts with one metre for a radian.
fn lifts(rollout: &Rollout, entry: &Entry) -> bool {
    let world = world_at(rollout.worlds, entry.time);
    let turn = world.ground_pose().rotation.inverse();
    let (linear, angular) = (turn * entry.twist.linear, turn * entry.twist.angular);
    let speed = linear.z.abs() + angular.xy().norm();
    world.ground == Ground::Settle && world.gravity > 0.0 && speed > rollout.tolerances.rest_speed
}

/// Records that travel and balance of a part are not checked, as it comes off while it lifts or tilts.
fn momentum_is_lost(subject: &str, ledger: &mut Ledger) {
    let why = format!("{subject} comes off as it lifts or tilts, and that momentum is not carried over");
    for check in &mut ledger.verdict.checks {
        let kind = [CheckKind::Traction, CheckKind::Balance].contains(&check.kind);
        if kind && check.status != Status::Failed {
            check.status = Status::NotChecked(why.clone());
        }
    }
}

/// Returns in words how a robot that floats still drifts as the plan ends; `None` if it does not.
fn drifts(rollout: &Rollout, path: &BasePath) -> Option<String> {
    let end = rollout.tracks.duration;
    if !rollout.floats || world_at(rollout.worlds, end).ground != Ground::Off {
        return None;
    }
    let twist = path.end_twist();
    let (speed, rate) = (twist.linear.norm(), twist.angular.norm());
    (speed + rate > rollout.tolerances.rest_speed).then(|| {
        let [speed, rate] =
            [(speed, Dimension::SPEED), (rate, Dimension::ANGULAR_SPEED)].map(|(x, unit)| quantity(x, unit));
        format!("{} drifts on at the end, at {speed} and {rate}", rollout.subject)
    })
}
