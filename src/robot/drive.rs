//! Joints and motors with their limits: each position a sum of joints.

use super::library::{JointKind, Limits, ModuleType};
use super::step::driven;
use super::{Assembly, JointOwner};
use nalgebra::DMatrix;

/// A drive: a joint that is not fixed, or a motor that drives one or several joints, with its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The path name of the joint or motor.
    pub name: String,
    /// The limits of the drive, in rad or m and N·m or N.
    pub limits: Limits,
    /// The terms of the drive's position, as joints, by the numbers in their [`JointId`](super::JointId), with
    /// factors.
    pub terms: Vec<(usize, f64)>,
    /// The speed at which no effort is left, rad/s or m/s; `None`: not stated.
    pub no_load_speed: Option<f64>,
    /// True for positions in rad, false for m.
    pub turns: bool,
    /// True for a joint that is neither passive nor follows others, also where it shares motors with other joints, and
    /// for every hinge of a bond; false for passive joints, for joints that follow others, and for the entries of
    /// motors ([`ModuleType::motors`]).
    pub driven: bool,
}

impl Drive {
    /// Returns the greatest speed of the drive, rad/s or m/s: no motor drives faster than it turns without load. `None` if
    /// neither is stated.
    pub fn speed_limit(&self) -> Option<f64> {
        let limits = [self.limits.speed, self.no_load_speed];
        limits.into_iter().flatten().reduce(f64::min)
    }
}

/// Returns the drives of a robot: its joints that are not fixed, those of modules and hinges of bonds, in the order of
/// [`Assembly::joints`], and after them the motors of all modules, module by module.
pub fn drives(robot: &Assembly) -> Vec<Drive> {
    let mut first = 0;
    let mut firsts = Vec::with_capacity(robot.modules.len());
    for module in 0..robot.modules.len() {
        firsts.push(first);
        first += robot.module_type(module).joints.len();
    }
    let joints = robot.joints().enumerate().filter_map(|(id, owner)| {
        let name = robot.joint_name(owner);
        match owner {
            JointOwner::Module { module, joint } => {
                let declared = &robot.module_type(module).joints[joint];
                let kind = declared.kind;
                let terms = driven(robot.module_type(module), joint, firsts[module]);
                let turns = kind == JointKind::Revolute;
                let driven = declared.takes_commands();
                let (limits, no_load_speed) = (declared.limits, declared.servo.no_load_speed);
                (kind != JointKind::Fixed).then_some(Drive {
                    name,
                    limits,
                    terms,
                    no_load_speed,
                    turns,
                    driven,
                })
            }
            JointOwner::Bond(bond) => {
                let limits = robot.hinge(bond)?.limits;
                let terms = vec![(id, 1.0)];
                Some(Drive { name, limits, terms, no_load_speed: None, turns: true, driven: true })
            }
        }
    });
    let motors = (0..robot.modules.len()).flat_map(|module| {
        let firsts = &firsts;
        robot.module_type(module).motors.iter().map(move |motor| Drive {
            name: format!("{}.{}", robot.modules[module].name, motor.name),
            limits: motor.limits,
            terms: motor.joints.iter().map(|&(joint, factor)| (firsts[module] + joint, factor)).collect(),
            no_load_speed: None,
            turns: true,
            driven: false,
        })
    });
    joints.chain(motors).collect()
}

/// Returns for each motor of a module type, in order, the terms (index of a joint in [`ModuleType::joints`], factor)
/// whose sum is the motor's effort, given the efforts of the joints. Let F be the matrix by which the positions of the
/// motors follow from those of the joints that they drive: `motor = F joint`, with a row for each motor and a column
/// for each of these joints. The factors returned are the rows of `F⁻ᵀ`, as `τ_joint = Fᵀ τ_motor` by virtual work.
/// `None` if F is not square or is singular, so that the efforts of the motors do not follow from those of the joints.
pub fn motor_efforts(kind: &ModuleType) -> Option<Vec<Vec<(usize, f64)>>> {
    let motors = &kind.motors;
    let mut joints: Vec<usize> = motors.iter().flat_map(|m| m.joints.iter().map(|j| j.0)).collect();
    joints.sort_unstable();
    joints.dedup();
    if joints.len() != motors.len() {
        return None;
    }
    let mut factors = DMatrix::<f64>::zeros(joints.len(), motors.len());
    for (column, motor) in motors.iter().enumerate() {
        for &(joint, factor) in &motor.joints {
            factors[(joints.partition_point(|j| *j < joint), column)] += factor;
        }
    }
    let inverse = factors.try_inverse()?;
    let of =
        |row| joints.iter().enumerate().map(|(column, joint)| (*joint, inverse[(row, column)])).collect();
    Some((0..motors.len()).map(of).collect())
}
