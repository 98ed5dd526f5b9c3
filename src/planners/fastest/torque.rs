//! Torques of joints and motors of a robot whose base is held: linear in acceleration and squared velocity of the path.

use super::path::Stretch;
use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Vec3};
use crate::plan::{DynamicsModel, Ground, Plan, Tracks, World};
use crate::robot::dynamics::{Dynamics, MotionState, Twist};
use crate::robot::{Assembly, JointOwner, Kinematics};
use nalgebra::DMatrix;

/// The torques of a robot whose base is held, with the bonds that hold in one stretch.
pub(super) struct Torques<'a> {
    kinematics: Kinematics,
    dynamics: &'a Dynamics,
    base: Pose,
    gravity: Vec3,
    loads: Vec<Load>,
}

/// A joint or motor that states a greatest effort.
struct Load {
    name: String,
    /// True for a torque, false for a force.
    turns: bool,
    /// N·m or N, as stated.
    limit: f64,
    /// The part of the limit that may be used, N·m or N.
    allowed: f64,
    /// The joints, by id, and factors whose efforts make its own.
    terms: Vec<(usize, f64)>,
}

/// A torque at a point of a path: `a s̈ + b ṡ² + c`, at most `limit` in size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// The share of the acceleration of the path.
    pub(super) a: f64,
    /// The share of its squared velocity.
    pub(super) b: f64,
    /// The torque at rest, N·m or N.
    pub(super) c: f64,
    /// The greatest size, N·m or N.
    pub(super) limit: f64,
}

/// A torque at rest that is over its limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Excess {
    /// The path name of the joint or motor.
    pub(super) name: String,
    /// The torque, N·m or N.
    pub(super) torque: f64,
    /// The part of the stated limit that may be used, N·m or N.
    pub(super) allowed: f64,
    /// The stated limit, N·m or N.
    pub(super) limit: f64,
    /// True for a torque, false for a force.
    pub(super) turns: bool,
}

/// The motion of a path at a point: positions, their first and second derivatives by the parameter, of all joints by
/// id.
pub(super) struct PathPoint {
    /// Positions, rad or m.
    pub(super) q: Vec<f64>,
    /// First derivatives.
    pub(super) d: Vec<f64>,
    /// Second derivatives.
    pub(super) dd: Vec<f64>,
}

/// Returns true if the world has inertia in its loads, and a fixture alone bears the robot: on ground that is
/// [`Ground::Fixed`] contacts bear it where it has weight.
fn holds(world: &World) -> bool {
    let fixture = match world.ground {
        Ground::Held => true,
        Ground::Fixed => world.gravity <= 0.0,
        Ground::Settle | Ground::Off => false,
    };
    world.dynamics == DynamicsModel::Full && fixture
}

/// Returns the torques in a stretch under the world at its beginning; one that begins within it counts in
/// [`slowed`](super::slowdown::slowed) alone. `None` where no fixture alone holds the base, where loops leave torques
/// open, or where loads of motion are not judged.
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
    let mut loads = joints(robot);
    loads.extend(motors(robot, &kinematics));
    for load in &mut loads {
        load.allowed = (1.0 - reserve) * load.limit;
    }
    let gravity = Vec3::new(0.0, 0.0, -world.gravity);
    Some(Torques { kinematics, dynamics, base: tracks.start.base, gravity, loads })
}

fn joints(robot: &Assembly) -> Vec<Load> {
    let load = |(id, owner): (usize, JointOwner)| {
        let limit = match owner {
            JointOwner::Module { module, joint } => {
                let declared = &robot.module_type(module).joints[joint];
                declared.limits.effort.filter(|_| !declared.passive && declared.mimic.is_none())
            }
            JointOwner::Bond(bond) => robot.hinge(bond).and_then(|hinge| hinge.limits.effort),
        };
        limit.map(|limit| Load {
            name: robot.joint_name(owner),
            turns: !robot.slides(owner),
            limit,
            allowed: limit,
            terms: vec![(id, 1.0)],
        })
    };
    robot.joints().enumerate().filter_map(load).collect()
}

/// Returns the efforts of motors. With `motor = Σ factor · joint` the efforts of the joints are `F` times those of the
/// motors, so that F has to have an inverse.
fn motors(robot: &Assembly, kinematics: &Kinematics) -> Vec<Load> {
    let mut loads = Vec::new();
    for module in 0..robot.modules.len() {
        let motors = &robot.module_type(module).motors;
        let mut joints: Vec<usize> = motors.iter().flat_map(|m| m.joints.iter().map(|j| j.0)).collect();
        joints.sort_unstable();
        joints.dedup();
        if joints.len() != motors.len() {
            continue;
        }
        let mut factors = DMatrix::<f64>::zeros(joints.len(), motors.len());
        for (column, motor) in motors.iter().enumerate() {
            for (joint, factor) in &motor.joints {
                factors[(joints.partition_point(|j| j < joint), column)] += factor;
            }
        }
        let Some(inverse) = factors.try_inverse() else { continue };
        for (row, motor) in motors.iter().enumerate() {
            let Some(limit) = motor.limits.effort else { continue };
            let term =
                |(column, joint): (usize, &usize)| (kinematics.joint(module, *joint), inverse[(row, column)]);
            loads.push(Load {
                name: format!("{}.{}", robot.modules[module].name, motor.name),
                turns: true,
                limit,
                allowed: limit,
                terms: joints.iter().enumerate().map(term).collect(),
            });
        }
    }
    loads
}

impl Torques<'_> {
    /// Returns the torques at a point of a path, in the order of the loads.
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
            self.dynamics.inverse(&self.kinematics, &state, gravity).efforts
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

    /// Returns the torque at rest that is farthest over what may be used, as a part of it; `None` if none is.
    pub(super) fn excess(&self, rows: &[Row]) -> Option<(f64, Excess)> {
        let over = |(row, load): (&Row, &Load)| {
            let ratio = row.c.abs() / row.limit;
            let Load { ref name, turns, limit, allowed, .. } = *load;
            let excess = Excess { name: name.clone(), torque: row.c.abs(), allowed, limit, turns };
            (ratio > 1.0 + TOLERANCES.torque).then_some((ratio, excess))
        };
        let all = rows.iter().zip(&self.loads).filter_map(over);
        all.reduce(|a, b| if b.0 > a.0 { b } else { a })
    }
}
