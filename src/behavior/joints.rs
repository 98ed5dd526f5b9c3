//! Joints as behaviours see them: their limits, and the reasons why some take no commands.

use crate::robot::{Assembly, JointKind, JointOwner, Limits, ModuleType};

/// The facts about a joint that commands need: its name, its limits, those of its motors included, and if it takes
/// commands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct JointFacts {
    /// The path name, such as `leg[2].m[0].tilt`.
    pub(super) name: String,
    /// The module or the bond that the joint belongs to.
    pub(super) owner: JointOwner,
    /// The reason why it takes no commands; `None` if it takes them.
    pub(super) uncommandable: Option<Uncommandable>,
    /// `true` for a joint that moves along its axis, in metres.
    pub(super) prismatic: bool,
    /// The lowest and the highest position, rad or m; `None` for a continuous joint.
    pub(super) range: Option<(f64, f64)>,
    /// The greatest speed when it moves alone, rad/s or m/s, by its own limit and those of the motors that drive it;
    /// `None` for no limit.
    pub(super) speed: Option<f64>,
    /// The greatest acceleration when it moves alone, rad/s² or m/s², by its own limit and those of the motors that
    /// drive it; `None` for no limit.
    pub(super) acceleration: Option<f64>,
}

/// The reason why a joint can't be commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uncommandable {
    /// The joint is passive: it has no motor.
    Passive,
    /// The joint is a mimic: it follows other joints.
    Mimic,
    /// The joint is fixed: it does not move.
    Fixed,
}

/// Returns the facts about every joint of a robot, by the number in its [`JointId`](crate::robot::JointId).
pub(super) fn facts(robot: &Assembly) -> Vec<JointFacts> {
    let of = |owner| match owner {
        JointOwner::Module { module, joint } => of_module(robot, module, joint),
        JointOwner::Bond(bond) => {
            let limits = robot.hinge(bond).expect("joints() lists bonds with a hinge").limits;
            made(robot.joint_name(owner), owner, None, false, limits)
        }
    };
    robot.joints().map(of).collect()
}

/// Returns the facts about a joint of a module.
fn of_module(robot: &Assembly, module: usize, joint: usize) -> JointFacts {
    let owner = JointOwner::Module { module, joint };
    let kind = robot.module_type(module);
    let declared = &kind.joints[joint];
    let uncommandable = match declared.kind {
        _ if declared.mimic.is_some() => Some(Uncommandable::Mimic),
        JointKind::Fixed => Some(Uncommandable::Fixed),
        _ if declared.passive => Some(Uncommandable::Passive),
        _ => None,
    };
    let limits = with_motors(kind, joint);
    made(robot.joint_name(owner), owner, uncommandable, declared.kind == JointKind::Prismatic, limits)
}

/// Returns the facts about a joint under its limits.
fn made(
    name: String,
    owner: JointOwner,
    uncommandable: Option<Uncommandable>,
    prismatic: bool,
    limits: Limits,
) -> JointFacts {
    let Limits { range, speed, acceleration, .. } = limits;
    JointFacts { name, owner, uncommandable, prismatic, range, speed, acceleration }
}

/// Returns a joint's own limits, tightened by every motor that drives it.
fn with_motors(kind: &ModuleType, joint: usize) -> Limits {
    let mut limits = kind.joints[joint].limits;
    for motor in &kind.motors {
        for &(_, factor) in motor.joints.iter().filter(|(j, factor)| *j == joint && *factor != 0.0) {
            limits.speed = tighter(limits.speed, motor.limits.speed, factor);
            limits.acceleration = tighter(limits.acceleration, motor.limits.acceleration, factor);
        }
    }
    limits
}

/// Returns the lesser of a joint's own limit and that of a motor which turns `factor` times as fast as the joint;
/// `None` if neither has one.
fn tighter(own: Option<f64>, motor: Option<f64>, factor: f64) -> Option<f64> {
    let motor = motor.map(|limit| limit / factor.abs());
    match (own, motor) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}
