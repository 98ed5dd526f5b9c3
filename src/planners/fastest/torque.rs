//! Torques of joints and motors of a robot whose base is held: linear in acceleration and squared velocity of the
//! parameter s of its path.

use super::Refusal;
use super::path::Stretch;
use crate::geometry::{Pose, Vec3};
use crate::plan::{DynamicsModel, Ground, Plan, Tracks, World};
use crate::robot::dynamics::{Dynamics, MotionState, Twist};
use crate::robot::{Assembly, Drive, Kinematics, drives, motor_efforts};

/// The efforts of the joints and motors of a robot whose base a fixture holds, as functions of the motion along the
/// path, with the bonds that are closed in one stretch.
pub(super) struct Torques<'a> {
    /// The kinematics with the bonds that hold, rooted at the base.
    kinematics: Kinematics,
    dynamics: &'a Dynamics,
    /// The world pose of the base, m.
    base: Pose,
    /// The vector of free fall in the world, m/s².
    gravity: Vec3,
    /// The inertia of each joint's rotor as the joint feels it, kg·m² or kg; 0 where none is stated.
    armatures: Vec<f64>,
    /// The joints, then the motors, that state a greatest effort.
    loads: Vec<Load>,
}

/// A joint or motor that states a greatest effort.
struct Load {
    /// The path name of the joint or motor.
    name: String,
    /// True for a torque, false for a force.
    turns: bool,
    /// The stated limit, N·m or N.
    limit: f64,
    /// The part of the limit that may be used, N·m or N.
    allowed: f64,
    /// The joints, by the number in their [`JointId`](crate::robot::JointId), whose efforts times factors make its own.
    terms: Vec<(usize, f64)>,
}

/// The effort (N·m or N) of one joint or motor at a point of a path: `a s̈ + b ṡ² + c` for the parameter s, at most
/// `limit` in absolute value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// The factor of the acceleration of the parameter.
    pub(super) a: f64,
    /// The factor of its squared velocity.
    pub(super) b: f64,
    /// The torque at rest, N·m or N.
    pub(super) c: f64,
    /// The greatest absolute value, with the reserve, N·m or N.
    pub(super) limit: f64,
}

/// The effort that one joint or motor needs against gravity at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AtRest {
    /// The index of the load in [`Torques::loads`].
    load: usize,
    /// The absolute value of the torque, N·m or N.
    torque: f64,
    /// The torque as a part of what may be used of its limit.
    ratio: f64,
}

/// A path at a point: positions, and their first and second derivatives by the parameter, of all joints by the number
/// in their [`JointId`](crate::robot::JointId).
pub(super) struct PathPoint {
    /// The positions, rad or m.
    pub(super) q: Vec<f64>,
    /// The first derivatives by the parameter, rad or m per its unit.
    pub(super) d: Vec<f64>,
    /// The second derivatives by the parameter, rad or m per its unit squared.
    pub(super) dd: Vec<f64>,
}

/// Returns true if the world has full dynamics, and a fixture alone bears the robot: on ground that is
/// [`Ground::Fixed`] contacts bear it where it has weight.
fn holds(world: &World) -> bool {
    let fixture = match world.ground {
        Ground::Held => true,
        Ground::Fixed => world.gravity <= 0.0,
        Ground::Settle | Ground::Off => false,
    };
    world.dynamics == DynamicsModel::Full && fixture
}

/// Returns the efforts of the robot in a stretch under the world at its beginning; a world that begins within it counts
/// in [`slowed`](super::slowdown::slowed) alone. `None` where the base is not held by a fixture alone, where closed
/// kinematic loops leave the efforts undetermined, or where the world has not full dynamics. `reserve`: the fraction, 0
/// to 1, of each limit that is left unused.
pub(super) fn torques<'a>(
    plan: &Plan,
    tracks: &Tracks,
    stretch: &Stretch,
    dynamics: &'a Dynamics,
    reserve: f64,
) -> Option<Torques<'a>> {
    let before = plan.worlds.iter().rev().find(|w| w.from <= stretch.from);
    let world = before.or(plan.worlds.first()).map(|w| w.world).filter(holds)?;
    let robot = &tracks.robot;
    let kinematics = Kinematics::new(robot, &tracks.state(stretch.from).bonds, robot.base);
    if !kinematics.tree.closing.is_empty() {
        return None;
    }
    let mut loads = joints(robot, reserve);
    loads.extend(motors(robot, &kinematics, reserve));
    let gravity = Vec3::new(0.0, 0.0, -world.gravity);
    let armatures = robot.joints().map(|owner| robot.servo(owner).armature.unwrap_or(0.0)).collect();
    Some(Torques { kinematics, dynamics, base: tracks.start.base, gravity, armatures, loads })
}

/// Returns the loads of joints with a motor of their own that state a greatest effort.
fn joints(robot: &Assembly, reserve: f64) -> Vec<Load> {
    let load = |drive: Drive| {
        let limit = drive.limits.effort.filter(|_| drive.driven)?;
        let allowed = (1.0 - reserve) * limit;
        Some(Load { name: drive.name, turns: drive.turns, limit, allowed, terms: drive.terms })
    };
    drives(robot).into_iter().filter_map(load).collect()
}

/// Returns the loads of motors of several joints that state a greatest effort and follow from those of the joints.
fn motors(robot: &Assembly, kinematics: &Kinematics, reserve: f64) -> Vec<Load> {
    let mut loads = Vec::new();
    for module in 0..robot.modules.len() {
        let kind = robot.module_type(module);
        for (motor, shares) in kind.motors.iter().zip(motor_efforts(kind).into_iter().flatten()) {
            let Some(limit) = motor.limits.effort else { continue };
            let term = |(joint, share)| (kinematics.joint(module, joint), share);
            loads.push(Load {
                name: format!("{}.{}", robot.modules[module].name, motor.name),
                turns: true,
                limit,
                allowed: (1.0 - reserve) * limit,
                terms: shares.into_iter().map(term).collect(),
            });
        }
    }
    loads
}

impl AtRest {
    /// Returns the effort at rest that is the greatest fraction of what may be used of its limit; `None` without rows.
    /// Entry k of `rows` is that of load k.
    pub(super) fn of(rows: &[Row]) -> Option<AtRest> {
        let at_rest =
            |(load, row): (usize, &Row)| AtRest { load, torque: row.c.abs(), ratio: row.c.abs() / row.limit };
        rows.iter().enumerate().map(at_rest).reduce(AtRest::greater)
    }

    /// Returns that one of two efforts at rest which is the greater fraction of its limit; `self` if they are equal.
    pub(super) fn greater(self, other: AtRest) -> AtRest {
        if other.ratio > self.ratio { other } else { self }
    }
}

impl Torques<'_> {
    /// Returns the effort of each joint and motor with a limit at a point of a path, by inverse dynamics: without
    /// gravity for the factors of acceleration and of squared velocity, and at rest for the effort of gravity.
    pub(super) fn rows(&self, point: &PathPoint) -> Vec<Row> {
        let mut poses = vec![Pose::identity(); self.kinematics.link_count()];
        self.kinematics.link_poses(&point.q, &self.base, &mut poses);
        let still = vec![0.0; point.q.len()];
        let efforts = |velocities: &[f64], accelerations: &[f64], gravity: &Vec3| {
            let state = MotionState {
                poses: &poses,
                base: Twist::default(),
                base_acceleration: Twist::default(),
                velocities,
                accelerations,
            };
            let mut efforts = self.dynamics.inverse(&self.kinematics, &state, gravity).efforts;
            for (joint, effort) in efforts.iter_mut().enumerate() {
                *effort += self.armatures[joint] * accelerations[joint];
            }
            efforts
        };
        let zero = Vec3::zeros();
        let a = efforts(&still, &point.d, &zero);
        let b = efforts(&point.d, &point.dd, &zero);
        let c = efforts(&still, &still, &self.gravity);
        let sum = |terms: &[(usize, f64)], of: &[f64]| terms.iter().map(|&(j, f)| f * of[j]).sum();
        let row = |load: &Load| Row {
            a: sum(&load.terms, &a),
            b: sum(&load.terms, &b),
            c: sum(&load.terms, &c),
            limit: load.allowed,
        };
        self.loads.iter().map(row).collect()
    }

    /// Returns [`Refusal::Overloaded`] for a stretch in which this effort at rest is above its limit.
    pub(super) fn refusal(&self, at_rest: &AtRest, stretch: &Stretch) -> Refusal {
        let Load { ref name, turns, limit, allowed, .. } = self.loads[at_rest.load];
        let (torque, from, to) = (at_rest.torque, stretch.from, stretch.to);
        Refusal::Overloaded { name: name.clone(), torque, allowed, limit, turns, from, to }
    }
}
