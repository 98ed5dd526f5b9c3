//! Docking between robots that stand by themselves: the ports must be within capture of each other, and at rest against
//! each other. The bond keeps the error that they dock with; nothing jumps.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::docking::{apart, failure, within};
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::geometry::pose::turned;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, DockingEvent, DockingKind, Failure, Tracks};
use crate::robot::{Kinematics, Residual, mate};
use crate::units::{Dimension, quantity};

/// The docking of clusters with each other at one instant.
#[derive(Clone, Debug, Default)]
pub(super) struct Joining {
    /// The error of each bond, the pose of its second port in the frame that a perfect mate would give it, by the index of
    /// the bond in the plan's robot, ascending.
    pub misalignments: Vec<(usize, Pose)>,
    /// The speed of the second port against the first just before, for each bond, m/s and rad/s.
    pub speeds: Vec<(f64, f64)>,
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
                    BasePath { poses: vec![(time, just_before(rollout, parent, path, (time, before)))] }
                })
                .collect();
            let parents = cluster.parents.iter().zip(&paths).map(|(parent, path)| (known[*parent].0, path));
            let mut placed = PlacedClusters::new(tracks, parents.collect(), tolerances);
            (0..paths.len()).for_each(|parent| placed.place_one(parent, time, (&joints, &bonds), &mut poses));
            (poses, joints)
        };
        let (now, earlier) = (place(0.0), place(tolerances.dock_step));
        let mut docked: Vec<(usize, Pose, (f64, f64))> = cluster
            .joins
            .iter()
            .map(|event| {
                let error =
                    |(poses, joints): &(Vec<Pose>, Vec<f64>)| error(tracks, &numbers, event, joints, poses);
                let (at, before) = (error(&now), error(&earlier));
                let moved = before.inverse() * at;
                let speed = (at.translation.vector - before.translation.vector).norm() / tolerances.dock_step;
                (event.bond, at, (speed, moved.rotation.angle() / tolerances.dock_step))
            })
            .collect();
        docked.sort_by_key(|(bond, ..)| *bond);
        let speeds = docked.iter().map(|(.., speed)| *speed).collect();
        Joining { misalignments: docked.into_iter().map(|(bond, error, _)| (bond, error)).collect(), speeds }
    }

    /// Judges the dockings of a cluster, and notes their errors; returns the bonds whose ports missed, by their indices in
    /// the plan's robot.
    pub(super) fn judge(&self, rollout: &Rollout, cluster: &Cluster, ledger: &mut Ledger) -> Vec<usize> {
        let robot = &rollout.tracks.robot;
        let mut missed = Vec::new();
        for ((bond, error), (speed, rate)) in self.misalignments.iter().zip(&self.speeds) {
            let name = robot.bond_name(*bond);
            let distance = error.translation.vector.norm();
            let residual = Residual { bond: *bond, distance, angle: error.rotation.angle() };
            let causes: Vec<_> =
                cluster.joins.iter().filter(|event| event.bond == *bond).map(|event| event.cause).collect();
            let kind = CheckKind::Docking;
            if !within(robot, &residual, rollout.tolerances) {
                let message = format!("{name} does not dock: {}", apart(&residual));
                ledger.fail(failure(kind, robot, &residual, cluster.from, message, causes, rollout));
                missed.push(*bond);
                continue;
            }
            let limit = rollout.tolerances;
            let shown = |speed: f64, rate: f64| {
                let speed = quantity(speed, Dimension::SPEED);
                format!("{speed} and {}", quantity(rate, Dimension::ANGULAR_SPEED))
            };
            if *speed > limit.dock_speed || *rate > limit.dock_rate {
                let message = format!(
                    "{name} docks too fast: the ports move at {} against each other, of {} at most",
                    shown(*speed, *rate),
                    shown(limit.dock_speed, limit.dock_rate)
                );
                let found = failure(kind, robot, &residual, cluster.from, message, causes, rollout);
                ledger.fail(Failure { value: *speed, limit: limit.dock_speed, ..found });
            }
            let at = quantity(cluster.from, Dimension::TIME);
            ledger.note(format!("{name} docks at {at}: {}", apart(&residual)));
        }
        missed
    }
}

/// Returns the pose of the second port of a docking in the frame that a perfect mate with the first would give it.
/// `numbers`: the kinematics that gives the links their numbers; `joints`: the positions of all joints, rad or m; `poses`:
/// the world poses of all links, m.
fn error(
    tracks: &Tracks,
    numbers: &Kinematics,
    event: &DockingEvent,
    joints: &[f64],
    poses: &[Pose],
) -> Pose {
    let robot = &tracks.robot;
    let hinge = robot.hinge(event.bond).zip(numbers.hinge(event.bond));
    let open = hinge.map_or(Pose::identity(), |(hinge, joint)| turned(hinge.axis, joints[joint]));
    (open * mate(robot, event.bond)).inverse() * pose_of_second(tracks, numbers, event.bond, poses)
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
