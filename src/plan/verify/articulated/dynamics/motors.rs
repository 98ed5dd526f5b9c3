//! Motors in motion: their rotors, the effort that is left to them at speed, and joints that have none.

use super::super::model::Model;
use super::super::statics::{Load, LoadKind, effects};
use super::tolerances::PARAMETERS;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure};
use crate::robot::{Assembly, JointOwner};
use crate::units::{Dimension, quantity};

/// The rotor of the motor of a joint.
pub(super) struct Rotor {
    /// The joint, by [`JointId`].
    pub joint: usize,
    /// Its inertia as the joint feels it, kg·m² or kg.
    pub inertia: f64,
    /// The index of a cut that the joint drives.
    pub cut: usize,
    /// The factor of the cut's motion, which is not 0.
    pub factor: f64,
}

/// Returns the rotors of the motors of a robot whose inertia is stated.
pub(super) fn rotors(model: &Model) -> Vec<Rotor> {
    let owners = model.robot.joints().enumerate().zip(effects(model));
    let of = |((joint, owner), driven): ((usize, JointOwner), Vec<(usize, f64)>)| {
        let inertia = model.robot.servo(owner).armature?;
        let (cut, factor) = driven.into_iter().find(|(_, factor)| *factor != 0.0)?;
        Some(Rotor { joint, inertia, cut, factor })
    };
    owners.filter_map(of).collect()
}

/// Returns the speed without load of each joint's own motor, by [`crate::robot::JointId`], rad/s or m/s; `None` where none
/// is stated, or no limit of its effort.
pub(super) fn no_load_speeds(robot: &Assembly) -> Vec<Option<f64>> {
    robot.joints().map(|owner| robot.effort_limit(owner).and(robot.servo(owner).no_load_speed)).collect()
}

/// Returns the limit of a load, N·m or N, at the rates of the joints (rad/s or m/s, by [`crate::robot::JointId`]): the effort
/// with which a motor drives a motion falls with its speed along a line, down to nothing at the speed without load. `no_load`:
/// as [`no_load_speeds`] returns it; `load`: that of a joint or a bond, whose forces at the cuts of the structure are `held`;
/// `rates` is asked for where it counts.
pub(super) fn limit_in_motion(
    no_load: &[Option<f64>],
    load: &Load,
    held: &[f64],
    rates: impl FnOnce() -> Vec<f64>,
) -> f64 {
    let LoadKind::Joint { joint, .. } = load.kind else { return load.limit };
    let Some(no_load) = no_load[joint] else { return load.limit };
    let effort = -load.terms.iter().map(|&(cut, factor)| factor * held[cut]).sum::<f64>();
    let driving = rates()[joint] * effort.signum();
    let left = (1.0 - driving.max(0.0) / no_load).max(PARAMETERS.yielding_share);
    left * load.limit
}

/// Returns a joint without a motor that gives way, by [`crate::robot::JointId`]: nothing else holds it up to a deflection of
/// `deflection_max`. `deflections`: those of all joints under their loads, rad or m. Joints that follow others are held by these.
pub(super) fn gives_way(robot: &Assembly, deflections: &[f64]) -> Option<usize> {
    let loose = |(joint, owner): (usize, JointOwner)| {
        let JointOwner::Module { module, joint: own } = owner else { return None };
        let declared = &robot.module_type(module).joints[own];
        let passive = declared.passive && declared.mimic.is_none();
        (passive && deflections[joint].abs() > PARAMETERS.deflection_max).then_some(joint)
    };
    robot.joints().enumerate().find_map(loose)
}

/// Fails the check of balance for a joint without a motor that gives way at a time, s; `allows balance` and `allows unstable`
/// excuse it.
pub(super) fn fail_loose(robot: &Assembly, joint: usize, time: f64, ledger: &mut Ledger) {
    let allowed = |kind: &ExemptionKind| matches!(kind, ExemptionKind::Balance | ExemptionKind::Unstable);
    if ledger.excuses(CheckKind::Balance, time, allowed) {
        return;
    }
    let owner = robot.joints().nth(joint).expect("a joint of the robot");
    let dimension = if robot.slides(owner) { Dimension::LENGTH } else { Dimension::ANGLE };
    let name = robot.joint_name(owner);
    let most = PARAMETERS.deflection_max;
    ledger.fail(Failure {
        kind: CheckKind::Balance,
        time,
        until: None,
        at: vec![name.clone()],
        message: format!(
            "{name} has no motor, and nothing else holds it: under the weight it moves by more than {}",
            quantity(most, dimension)
        ),
        value: most,
        limit: most,
        blame: vec![],
        blames_start: false,
    });
}
