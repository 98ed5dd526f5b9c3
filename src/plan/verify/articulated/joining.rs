//! Docking between robots that stand by themselves: the ports must be within capture of each other, and at rest against
//! each other. The bond keeps the error that they dock with, and nothing jumps, unless its connectors snap.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::docking::{apart, failure, tolerated, within};
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use super::snapping::{self, Snap};
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::geometry::pose::turned;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, DockingEvent, DockingKind, Failure, Tracks};
use crate::robot::{Assembly, Bond, Kinematics, Residual, mate};
use crate::units::{Dimension, number, quantity};

/// The docking of clusters with each other at one instant.
#[derive(Clone, Debug, Default)]
pub(super) struct Joining {
    /// The dockings, ascending by the indices of their bonds in the plan's robot.
    pub dockings: Vec<Docked>,
    /// The motions by which clusters snap to each other, in the order in which they do.
    pub snaps: Vec<Snap>,
}

/// A bond by which clusters dock with each other.
#[derive(Clone, Debug)]
pub(super) struct Docked {
    /// The index of the bond in the plan's robot.
    pub bond: usize,
    /// The error as the ports meet: the pose of the second in the frame that a perfect mate would give it, m.
    pub error: Pose,
    /// The error that the bond keeps, likewise; `None` where it has snapped to a perfect mate.
    pub misalignment: Option<Pose>,
    /// The speed of the second port against the first just before, m/s and rad/s.
    speed: (f64, f64),
    /// The distance (m) and the angle (rad) by which the error may be another if contacts slip as the settings state; `None`
    /// where nothing goes astray.
    spread: Option<(f64, f64)>,
}

impl Joining {
    /// Returns the errors and speeds with which a cluster's `joins` dock. `known`: the clusters before, with the paths of
    /// their bases.
    pub(super) fn of(rollout: &Rollout, cluster: &Cluster, known: &[(&Cluster, &BasePath)]) -> Joining {
        let (tracks, time) = (rollout.tracks, cluster.from);
        let tolerances = rollout.tolerances;
        let mut bonds = tracks.start.bonds.clone();
        for event in tracks.events.iter().take_while(|event| event.time < time) {
            bonds[event.bond] = event.kind == DockingKind::Dock;
        }
        let numbers = Kinematics::new(&tracks.robot, &bonds, 0);
        let place = |before: f64| {
            let mut poses = vec![Pose::identity(); numbers.link_count()];
            let joints = tracks.state(time - before).joints;
            let paths: Vec<BasePath> = cluster
                .parents
                .iter()
                .map(|parent| {
                    let (parent, path) = known[*parent];
                    BasePath::resting(time, just_before(rollout, parent, path, (time, before)))
                })
                .collect();
            let parents = cluster.parents.iter().zip(&paths).map(|(parent, path)| (known[*parent].0, path));
            let mut placed = PlacedClusters::new(tracks, parents.collect(), tolerances);
            (0..paths.len()).for_each(|parent| placed.place_one(parent, time, (&joints, &bonds), &mut poses));
            (poses, joints)
        };
        let ((mut poses, joints), earlier) = (place(0.0), place(tolerances.dock_step));
        let error = |event: &DockingEvent, joints: &[f64], poses: &[Pose]| {
            error(tracks, &numbers, event.bond, joints, poses)
        };
        let mut dockings: Vec<Docked> = Vec::with_capacity(cluster.joins.len());
        for event in &cluster.joins {
            let (at, before) = (error(event, &joints, &poses), error(event, &earlier.1, &earlier.0));
            let moved = before.inverse() * at;
            let speed = (at.translation.vector - before.translation.vector).norm() / tolerances.dock_step;
            let rate = moved.rotation.angle() / tolerances.dock_step;
            let spread = spread(rollout, known, (&numbers, &poses), event.bond);
            let (bond, speed) = (event.bond, (speed, rate));
            dockings.push(Docked { bond, error: at, misalignment: None, speed, spread });
        }
        let parents: Vec<&Cluster> = cluster.parents.iter().map(|parent| known[*parent].0).collect();
        let snaps = snapping::snap(rollout, (&numbers, &joints), (&parents, &cluster.joins), &mut poses);
        for (docked, event) in dockings.iter_mut().zip(&cluster.joins) {
            let snapped = snaps.iter().any(|snap| snap.bond == docked.bond && snap.stands.is_none());
            docked.misalignment = (!snapped).then(|| error(event, &joints, &poses));
        }
        dockings.sort_by_key(|docked| docked.bond);
        Joining { dockings, snaps }
    }

    /// Judges the dockings of a cluster, and notes their errors; returns the bonds whose ports missed, by their indices in
    /// the plan's robot.
    pub(super) fn judge(&self, rollout: &Rollout, cluster: &Cluster, ledger: &mut Ledger) -> Vec<usize> {
        let mut missed = Vec::new();
        for docked in &self.dockings {
            let bond = docked.bond;
            let causes: Vec<_> =
                cluster.joins.iter().filter(|event| event.bond == bond).map(|event| event.cause).collect();
            if !docked.judge(rollout, cluster.from, causes, ledger) {
                missed.push(bond);
            }
        }
        for snap in &self.snaps {
            snap.judge(rollout, cluster, ledger);
        }
        missed
    }
}

impl Docked {
    /// Judges the docking at a time (s), for which `causes` are to blame, and notes its error; returns false where the ports
    /// missed.
    fn judge(&self, rollout: &Rollout, time: f64, causes: Vec<CauseId>, ledger: &mut Ledger) -> bool {
        let (robot, limit) = (&rollout.tracks.robot, rollout.tolerances);
        let name = robot.bond_name(self.bond);
        let (distance, angle) = (self.error.translation.vector.norm(), self.error.rotation.angle());
        let residual = Residual { bond: self.bond, distance, angle };
        let kind = CheckKind::Docking;
        if !within(robot, &residual, limit) {
            let message = format!("{name} does not dock: {}", apart(&residual));
            ledger.fail(failure(kind, robot, &residual, time, message, causes, rollout));
            return false;
        }
        let shown = |speed: f64, rate: f64| {
            let speed = quantity(speed, Dimension::SPEED);
            format!("{speed} and {}", quantity(rate, Dimension::ANGULAR_SPEED))
        };
        let (speed, rate) = self.speed;
        let capture = tolerated(robot, self.bond, limit);
        let most = (capture.speed.unwrap_or(limit.dock_speed), capture.rate.unwrap_or(limit.dock_rate));
        if speed > most.0 || rate > most.1 {
            let message = format!(
                "{name} docks too fast: the ports move at {} against each other, of {} at most",
                shown(speed, rate),
                shown(most.0, most.1)
            );
            let found = failure(kind, robot, &residual, time, message, causes, rollout);
            ledger.fail(Failure { value: speed, limit: most.0, ..found });
        }
        let at = quantity(time, Dimension::TIME);
        let spread = self.spread.map_or_else(String::new, |spread| self.spread_in_words(spread, rollout));
        ledger.note(format!("{name} docks at {at}: {}{spread}", apart(&residual)));
        true
    }

    /// Returns in words by how much the error may be another, to go on after it.
    fn spread_in_words(&self, (distance, angle): (f64, f64), rollout: &Rollout) -> String {
        let capture = tolerated(&rollout.tracks.robot, self.bond, rollout.tolerances);
        let beyond = self.error.translation.vector.norm() + distance > capture.distance
            || self.error.rotation.angle() + angle > capture.angle;
        let captured =
            if beyond { "more than the connector captures" } else { "which the connector captures" };
        // A bound is rounded up.
        let [distance, angle] = [(distance, Dimension::LENGTH, 0), (angle, Dimension::ANGLE, 1)].map(
            |(value, dimension, step)| {
                let step = rollout.tolerances.spread_step[step];
                quantity(libm::ceil(value / step) * step, dimension)
            },
        );
        let slip = number(100.0 * rollout.settings.slip);
        format!("; if wheels slip by {slip} % of their speed, up to {distance} and {angle} more, {captured}")
    }
}

/// Returns the distance (m) and the angle (rad) by which the pose of a bond's second port against its first may be another if
/// contacts slip as the settings state, on all ways on which the two are of different clusters; `None` where they do not go
/// astray. `numbers` and `poses`: the kinematics that gives the links their numbers, and their world poses as they dock, m.
fn spread(
    rollout: &Rollout,
    known: &[(&Cluster, &BasePath)],
    (numbers, poses): (&Kinematics, &[Pose]),
    bond: usize,
) -> Option<(f64, f64)> {
    let robot = &rollout.tracks.robot;
    let Bond { a, b, .. } = robot.bonds[bond];
    let mut off = (0.0, 0.0);
    for port in [a, b] {
        let at = numbers.port_pose(robot, port, poses).translation.vector;
        let holds = |cluster: &Cluster, module: usize| cluster.modules.binary_search(&module).is_ok();
        for (cluster, path) in known {
            if holds(cluster, port.module) && !(holds(cluster, a.module) && holds(cluster, b.module)) {
                let (distance, angle) = path.astray_at(&at);
                off = (off.0 + distance, off.1 + angle);
            }
        }
    }
    let slip = rollout.settings.slip;
    (off.0 * slip > 0.0).then_some((off.0 * slip, off.1 * slip))
}

/// Returns the pose of the second port of a bond in the frame that a perfect mate with the first would give it.
/// `numbers`: the kinematics that gives the links their numbers; `joints`: the positions of all joints, rad or m; `poses`:
/// the world poses of all links, m.
pub(super) fn error(
    tracks: &Tracks,
    numbers: &Kinematics,
    bond: usize,
    joints: &[f64],
    poses: &[Pose],
) -> Pose {
    perfect_mate(&tracks.robot, numbers, bond, joints).inverse()
        * pose_of_second(tracks, numbers, bond, poses)
}

/// Returns the pose of a bond's second port in the frame of its first (`X_PQ`, m) in a perfect mate, its hinge at its position.
/// `numbers` and `joints`: as for [`error`].
pub(super) fn perfect_mate(robot: &Assembly, numbers: &Kinematics, bond: usize, joints: &[f64]) -> Pose {
    let hinge = robot.hinge(bond).zip(numbers.hinge(bond));
    let open = hinge.map_or(Pose::identity(), |(hinge, joint)| turned(hinge.axis, joints[joint]));
    open * mate(robot, bond)
}

/// Returns the pose of the second port of a bond, given by its index, in the frame of the first, `X_PQ` in m. `numbers` and
/// `poses`: the kinematics that gives the links their numbers, and their world poses, m.
pub(super) fn pose_of_second(tracks: &Tracks, numbers: &Kinematics, bond: usize, poses: &[Pose]) -> Pose {
    let robot = &tracks.robot;
    let declared = robot.bonds[bond];
    numbers.port_pose(robot, declared.a, poses).inverse() * numbers.port_pose(robot, declared.b, poses)
}

/// Returns the world pose of a cluster's base (`X_WB`, m) at its end, `time`, less a short time `before` (s), during which it
/// moves as it does at its end.
fn just_before(rollout: &Rollout, cluster: &Cluster, path: &BasePath, (time, before): (f64, f64)) -> Pose {
    let last = path.at(time, rollout.tolerances);
    let [.., (begin, first), (end, _)] = path.poses.as_slice() else { return last };
    let speed = end_speed(rollout, cluster, path);
    let mean = path.mean_speed(path.poses.len() - 1);
    if before == 0.0 || speed == 0.0 || mean == 0.0 {
        return last;
    }
    let part = (speed / mean) * before / (end - begin);
    last.try_lerp_slerp(first, part.min(1.0), rollout.tolerances.nearest).unwrap_or(last)
}

/// Returns the speed of a cluster's base at its end, m/s, to which turning counts with one metre for a radian. A robot whose
/// joints are at rest is at rest, unless it slides: full dynamics take means over windows, which lag behind.
fn end_speed(rollout: &Rollout, cluster: &Cluster, path: &BasePath) -> f64 {
    let count = path.poses.len();
    if count < 2 {
        return 0.0;
    }
    let last = path.mean_speed(count - 1);
    let [.., (begin, _), (end, _)] = path.poses.as_slice() else { return 0.0 };
    // The speed at the end by that in the middle of the last two intervals.
    let ends = match count {
        2 => last,
        _ => {
            let (earlier, span) = (path.mean_speed(count - 2), end - path.poses[count - 3].0);
            (last + (last - earlier) * (end - begin) / span).max(0.0)
        }
    };
    if !joints_rest(&cluster.tracks, rollout.tolerances) {
        return ends;
    }
    let index = path
        .poses
        .partition_point(|(time, _)| *time < end - rollout.tolerances.braking_time)
        .clamp(1, count - 1);
    let slides = rollout.is_full() && ends > rollout.tolerances.braked * path.mean_speed(index);
    if slides { ends } else { 0.0 }
}

/// Returns true if no joint of a robot moves as its motion ends.
fn joints_rest(tracks: &Tracks, tolerances: &Tolerances) -> bool {
    let end = tracks.duration;
    !tracks.tracks.iter().any(|track| {
        let mut around = track.segments.iter().filter(|segment| segment.start < end && end <= segment.end);
        around.any(|segment| segment.velocity(end).abs() > tolerances.speed_jump)
    })
}
