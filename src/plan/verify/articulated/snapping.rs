//! Snapping: of two clusters that dock by a connector that draws its ports together, the smaller moves by the error of the
//! docking. The motion takes no time in the plan, as magnets pull within milliseconds; its way is the straight line and the one
//! turn from pose to pose, and is judged against all that stands around.

use super::clusters::Cluster;
use super::docking::within;
use super::in_force::world_at;
use super::joining;
use super::rollout_input::Rollout;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, DockingEvent, Failure, Ground, TOLERANCES};
use crate::robot::{Assembly, Bond, Kinematics, Residual};
use crate::units::{Dimension, quantity};

/// The motion by which one cluster snaps to another.
#[derive(Clone, Debug)]
pub(super) struct Snap {
    /// The bond whose connector draws its ports together, by its index in the plan's robot.
    pub bond: usize,
    /// The modules that move, by their indices in the plan's robot.
    pub modules: Vec<usize>,
    /// The distance (m) and the angle (rad) between the port that moves and its perfect mate before.
    pub error: (f64, f64),
    /// The motion in the world: it takes a pose before to the pose after, m.
    pub motion: Pose,
    /// The bases of the two clusters in words if neither is free to move; `None` for a snap that happens.
    pub stands: Option<[String; 2]>,
}

/// Clusters that have snapped to each other so far, with all their modules.
struct Group {
    modules: Vec<usize>,
    free: bool,
    name: String,
}

/// Moves clusters that dock by connectors that snap, in the order of the dockings, and returns the motions. `numbers` and `joints`:
/// the kinematics that gives the links their numbers, and the positions of all joints (rad or m); `poses`: the world poses of all
/// links (m), which move with them.
pub(super) fn snap(
    rollout: &Rollout,
    (numbers, joints): (&Kinematics, &[f64]),
    (parents, joins): (&[&Cluster], &[DockingEvent]),
    poses: &mut [Pose],
) -> Vec<Snap> {
    let (tracks, robot) = (rollout.tracks, &rollout.tracks.robot);
    let mut groups: Vec<Group> = parents
        .iter()
        .map(|parent| Group {
            modules: parent.modules.clone(),
            free: is_free(rollout, parent),
            name: parent.name.clone(),
        })
        .collect();
    let mut snaps = Vec::new();
    for event in joins.iter().filter(|event| robot.snaps(event.bond)) {
        let error = joining::error(tracks, numbers, event.bond, joints, poses);
        let (distance, angle) = (error.translation.vector.norm(), error.rotation.angle());
        if !within(robot, &Residual { bond: event.bond, distance, angle }, rollout.tolerances) {
            continue;
        }
        let Bond { a, b, .. } = robot.bonds[event.bond];
        let group_of = |module: usize| groups.iter().position(|group| group.modules.contains(&module));
        let (Some(first), Some(second)) = (group_of(a.module), group_of(b.module)) else { continue };
        // Errors of rounding need no motion.
        if first == second || distance.max(angle) < TOLERANCES.reported_zero {
            continue;
        }
        // At a tie the second moves.
        let smaller_first = groups[first].modules.len() < groups[second].modules.len();
        let (smaller, larger) = if smaller_first { (first, second) } else { (second, first) };
        let mover = [smaller, larger].into_iter().find(|group| groups[*group].free);
        let stands = mover.is_none().then(|| [first, second].map(|group| groups[group].name.clone()));
        let moving = mover.unwrap_or(second);
        let motion = match mover {
            Some(_) => closing(robot, numbers, event.bond, (joints, poses), moving == first),
            None => Pose::identity(),
        };
        let modules = groups[moving].modules.clone();
        for link in modules.iter().flat_map(|module| links(robot, numbers, *module)) {
            poses[link] = motion * poses[link];
        }
        if stands.is_none() {
            let gone = groups.remove(first.max(second));
            let kept = &mut groups[first.min(second)];
            kept.modules.extend(gone.modules);
            kept.free &= gone.free;
        }
        snaps.push(Snap { bond: event.bond, modules, error: (distance, angle), motion, stands });
    }
    snaps
}

/// Returns true if nothing but the ground carries a cluster as it ends: no fixture holds its base.
fn is_free(rollout: &Rollout, cluster: &Cluster) -> bool {
    let worlds = cluster.worlds.as_deref().unwrap_or(rollout.worlds);
    let ground = world_at(worlds, cluster.tracks.duration).ground;
    matches!(ground, Ground::Settle | Ground::Off)
}

/// Returns the motion in the world that closes the error of a bond, of the cluster of its first port (`first`) or of its second.
fn closing(
    robot: &Assembly,
    numbers: &Kinematics,
    bond: usize,
    (joints, poses): (&[f64], &[Pose]),
    first: bool,
) -> Pose {
    let Bond { a, b, .. } = robot.bonds[bond];
    let X_PQ = joining::perfect_mate(robot, numbers, bond, joints);
    let [X_WP, X_WQ] = [a, b].map(|port| numbers.port_pose(robot, port, poses));
    match first {
        true => X_WQ * X_PQ.inverse() * X_WP.inverse(),
        false => X_WP * X_PQ * X_WQ.inverse(),
    }
}

/// Returns the numbers of a module's links.
pub(super) fn links(
    robot: &Assembly,
    numbers: &Kinematics,
    module: usize,
) -> impl Iterator<Item = usize> + use<> {
    let first = numbers.link(module, 0);
    first..first + robot.module_type(module).links.len()
}

impl Snap {
    /// Records the failure of a snap where neither cluster is free to move, and notes the motion of one that happens. `cluster`:
    /// that which docking brings to be.
    pub(super) fn judge(&self, rollout: &Rollout, cluster: &Cluster, ledger: &mut Ledger) {
        let robot = &rollout.tracks.robot;
        let name = robot.bond_name(self.bond);
        if let Some([first, second]) = &self.stands {
            let Bond { a, b, .. } = robot.bonds[self.bond];
            let causes = cluster.joins.iter().filter(|event| event.bond == self.bond);
            return ledger.fail(Failure {
                kind: CheckKind::Docking,
                time: cluster.from,
                at: [a, b].map(|port| robot.modules[port.module].name.clone()).into(),
                blame: causes.map(|event| event.cause).collect(),
                ..Failure::form(format!("{name} can't snap: neither {first} nor {second} is free to move"))
            });
        }
        let Some(base) = self.modules.first().map(|module| &robot.modules[*module].name) else { return };
        let (distance, angle) = self.error;
        let distance = quantity(distance, Dimension::LENGTH);
        let angle = quantity(angle, Dimension::ANGLE);
        ledger.note(format!("{name} snaps: what `{base}` belongs to moves by {distance} and {angle}"));
    }
}
