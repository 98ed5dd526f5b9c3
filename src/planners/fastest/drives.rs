//! Joints and motors with their limits of speed and acceleration.

use super::Refusal;
use super::path::Stretch;
use crate::robot::{Assembly, JointKind, JointOwner, Limits, driven};

/// A joint, or a motor that drives several, with limits.
pub(super) struct Drive {
    /// The joints, by id, and factors whose sum is its position.
    pub(super) terms: Vec<(usize, f64)>,
    /// The greatest speed, rad/s or m/s; `None`: not stated.
    pub(super) speed: Option<f64>,
    /// The greatest acceleration, rad/s² or m/s²; `None`: not stated.
    pub(super) acceleration: Option<f64>,
}

/// Returns the joints and motors of a robot that state a limit of speed or acceleration.
pub(super) fn drives(robot: &Assembly) -> Vec<Drive> {
    let mut first = 0;
    let mut firsts = Vec::with_capacity(robot.modules.len());
    for module in 0..robot.modules.len() {
        firsts.push(first);
        first += robot.module_type(module).joints.len();
    }
    let drive = |limits: &Limits, terms: Vec<(usize, f64)>| Drive {
        terms,
        speed: limits.speed,
        acceleration: limits.acceleration,
    };
    let mut found = Vec::new();
    for (id, owner) in robot.joints().enumerate() {
        match owner {
            JointOwner::Module { module, joint } => {
                let declared = &robot.module_type(module).joints[joint];
                if declared.kind != JointKind::Fixed {
                    let terms = driven(robot.module_type(module), joint, firsts[module]);
                    found.push(drive(&declared.limits, terms));
                }
            }
            JointOwner::Bond(bond) => {
                found.extend(robot.hinge(bond).map(|hinge| drive(&hinge.limits, vec![(id, 1.0)])));
            }
        }
    }
    for (module, first) in firsts.iter().enumerate() {
        found.extend(robot.module_type(module).motors.iter().map(|motor| {
            let terms = motor.joints.iter().map(|&(joint, factor)| (first + joint, factor)).collect();
            drive(&motor.limits, terms)
        }));
    }
    found.retain(|drive| drive.speed.is_some() || drive.acceleration.is_some());
    found
}

/// Checks that every joint that moves in a stretch states a limit of acceleration, or is driven by motors that do.
///
/// # Errors
/// [`Refusal::NoAcceleration`] for the first that does not.
pub(super) fn check(stretch: &Stretch, robot: &Assembly, drives: &[Drive]) -> Result<(), Refusal> {
    for track in &stretch.path {
        let id = track.joint.0 as usize;
        let limited = |drive: &Drive| {
            drive.acceleration.is_some()
                && drive.terms.iter().any(|&(joint, factor)| joint == id && factor != 0.0)
        };
        if !drives.iter().any(limited) {
            return Err(Refusal::NoAcceleration { joint: name(robot, id), time: stretch.from });
        }
    }
    Ok(())
}

/// Returns the path name of a joint by its id; empty if there is none.
pub(super) fn name(robot: &Assembly, joint: usize) -> String {
    robot.joints().nth(joint).map_or_else(String::new, |owner| robot.joint_name(owner))
}
