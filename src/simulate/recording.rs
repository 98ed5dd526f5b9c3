//! The motion that a simulation keeps, for pictures and curves: poses, efforts and contact forces at moments.

use super::commands::Commands;
use crate::geometry::{Pose, Vec3};
use crate::plan::forward_dynamics::Model;
use crate::plan::forward_dynamics::Stepper;

/// The least time between two moments of the motion that is kept, s.
const FRAME: f64 = 0.02;

/// The most moments that are kept.
const MOMENTS_MAX: usize = 4096;

/// The most positions and efforts that are kept, unless those are fewer than [`MOMENTS_KEPT`] moments.
const NUMBERS_MAX: usize = 8_000_000;

/// The number of moments that are kept of any robot.
const MOMENTS_KEPT: usize = 256;

/// The robot at a moment of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The world pose of the base module's body.
    pub base: Pose,
    /// The world poses of the roots of the other trees of the plan's [`LastingTrees`](crate::plan::LastingTrees) without
    /// the bonds that [`Simulation::apart`](super::Simulation::apart) names, in their order.
    pub roots: Vec<Pose>,
    /// The position of each joint by its [`JointId`](crate::robot::JointId), rad or m; of those that do not move, as the
    /// plan says.
    pub joints: Vec<f64>,
    /// The efforts of [`Simulation::drives`](super::Simulation::drives), in their order, N·m or N: means over 50 ms.
    pub efforts: Vec<f64>,
    /// The forces of contacts with the ground and between links, those with the ground first.
    pub contacts: Vec<ContactForce>,
}

/// The force of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The number of the link that it acts on, among those of all modules in order.
    pub link: usize,
    /// The number of the link that exerts it; `None`: the ground, or an obstacle.
    pub other: Option<usize>,
    /// The point in the world, m.
    pub point: Vec3,
    /// The force in the world, N. Its opposite acts on what exerts it.
    pub force: Vec3,
}

/// A servo of a joint, or a motor that drives several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// The number of the joint's [`JointId`](crate::robot::JointId); of a motor, that of the first joint that it drives.
    pub joint: usize,
    /// The index in [`ModuleType::motors`](crate::robot::ModuleType::motors) of a motor that drives several joints.
    pub motor: Option<usize>,
    /// The greatest effort, N·m or N, with the factor on it; `None` where none is stated.
    pub limit: Option<f64>,
}

/// The recording of a motion.
#[derive(Clone, Debug)]
pub(super) struct Recording {
    /// The time between two moments, s.
    apart: f64,
    /// The most moments that are kept.
    most: usize,
    /// The time from which on the next moment is kept, s.
    next: f64,
    /// The numbers of the links that bodies are.
    link_of: Vec<usize>,
    /// The bodies of the bases, but for the first.
    roots: Vec<usize>,
    /// The drives whose efforts are kept, in the order of [`Moment::efforts`].
    pub drives: Vec<Drive>,
    /// The moments that are kept, in order of time.
    pub motion: Vec<Moment>,
}

impl Recording {
    /// Returns the empty recording of a robot.
    pub(super) fn new(model: &Model) -> Recording {
        let link_of = model.links();
        let root = |body: &usize| model.bodies[*body].step.is_none() && model.fixture != Some(*body);
        let roots = (1..model.bodies.len()).filter(root).collect();
        let drives = drives(model);
        let numbers = model.moved_by.len() + drives.len();
        let most = (NUMBERS_MAX / numbers.max(1)).clamp(MOMENTS_KEPT, MOMENTS_MAX);
        Recording { apart: FRAME, most, next: 0.0, link_of, roots, drives, motion: Vec::new() }
    }

    /// Begins at time 0, with nothing kept.
    pub(super) fn restart(&mut self) {
        self.motion.clear();
        self.next = 0.0;
    }

    /// Returns true if the moment at which a step of length `step` ends, `time` (both in s), is to be kept.
    pub(super) fn is_due(&self, time: f64, step: f64) -> bool {
        time + 0.5 * step >= self.next
    }

    /// Keeps the moment at which a step ends, `time` (s). `efforts`: the efforts of the bodies' joints along their
    /// coordinates, N·m or N.
    pub(super) fn see(&mut self, stepper: &Stepper, commands: &Commands, efforts: &[f64], time: f64) {
        let model = stepper.model;
        let mut joints: Vec<f64> = commands.joints.iter().map(|(position, _)| *position).collect();
        for (body, coordinate) in model.bodies.iter().zip(&stepper.coordinates) {
            if let Some(joint) = &body.joint {
                joints[joint.id] = coordinate * joint.factor;
            }
        }
        let roots = self.roots.iter().map(|root| *stepper.base(*root)).collect();
        self.motion.push(Moment {
            time,
            base: *stepper.base(0),
            roots,
            joints,
            efforts: efforts_of_drives(model, efforts),
            contacts: self.contacts(stepper),
        });
        if self.motion.len() > self.most {
            // Every second moment goes, and the next ones are twice as far apart.
            let mut stays = false;
            self.motion.retain(|_| {
                stays = !stays;
                stays
            });
            self.apart *= 2.0;
        }
        self.next = self.motion.last().map_or(0.0, |moment| moment.time) + self.apart;
    }

    /// Returns the forces of the contacts of the step taken last.
    fn contacts(&self, stepper: &Stepper) -> Vec<ContactForce> {
        let of_ground = stepper.ground.iter().flat_map(|ground| &ground.contacts).map(|contact| {
            let link = self.link_of[contact.body];
            ContactForce {
                link,
                other: None,
                point: stepper.origin + contact.point,
                force: contact.contact.force,
            }
        });
        let links = stepper.couplings.links.iter().flat_map(|links| &links.contacts);
        let of_links = links.map(|contact| ContactForce {
            link: self.link_of[contact.second],
            other: (stepper.model.fixture != Some(contact.first)).then(|| self.link_of[contact.first]),
            point: stepper.origin + contact.point,
            force: contact.contact.force,
        });
        of_ground.chain(of_links).filter(|contact| contact.force.norm() > 0.0).collect()
    }
}

/// Returns the servos of a robot in the order of their bodies, and then the motors that drive several joints and have
/// limits.
fn drives(model: &Model) -> Vec<Drive> {
    let joints = model.bodies.iter().filter_map(|body| body.joint.as_ref());
    let servos = joints.filter_map(|joint| {
        let servo = joint.servo.as_ref()?;
        Some(Drive { joint: joint.id, motor: None, limit: servo.limit })
    });
    let mut drives: Vec<Drive> = servos.collect();
    for coupled in &model.coupled {
        let first = coupled.bodies.first().and_then(|(body, _)| model.bodies[*body].joint.as_ref());
        let limited = coupled.motors.iter().enumerate().filter(|(_, motor)| motor.effort.is_finite());
        drives.extend(first.into_iter().flat_map(|first| {
            limited.clone().map(|(number, motor)| Drive {
                joint: first.id,
                motor: Some(number),
                limit: Some(motor.effort),
            })
        }));
    }
    drives
}

/// Returns the efforts of the drives, N·m or N, for those of the bodies' joints along their coordinates.
fn efforts_of_drives(model: &Model, efforts: &[f64]) -> Vec<f64> {
    let servos = model.bodies.iter().zip(efforts).filter_map(|(body, effort)| {
        let joint = body.joint.as_ref().filter(|joint| joint.servo.is_some())?;
        Some(effort * joint.factor)
    });
    let motors = model.coupled.iter().flat_map(|coupled| {
        let limited = coupled.motors.iter().filter(|motor| motor.effort.is_finite());
        limited.map(|motor| {
            let terms = coupled.bodies.iter().zip(&motor.shares);
            terms.map(|((body, sign), share)| share * sign * efforts[*body]).sum()
        })
    });
    servos.chain(motors).collect()
}
