//! Kinematic chains: the way from one link to a frame on another along the tree, and inverse kinematics on it.
//!
//! A [`Chain`] is compiled once. [`Chain::descend`] is damped least squares (Buss 2005, *Introduction to inverse kinematics
//! with Jacobian transpose, pseudoinverse and damped least squares methods*) with the damping of Sugihara (2011,
//! *Solvability-unconcerned inverse kinematics by the Levenberg–Marquardt method*) in systems of six rows: a fraction of
//! the cost of [`super::inverse_kinematics`], which poses problems of any rows.

use super::assembly::{Assembly, JointOwner};
use super::jacobian::LinkFrame;
use super::kinematics::Kinematics;
use super::library::JointKind;
use super::step::{Motion, Step};
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{Pose, RigidTransform, Vec3};
use crate::optimize::random::SplitMix64;
use nalgebra::{Matrix6, UnitQuaternion, Vector6};
use std::f64::consts::{PI, TAU};

/// The links from a held one to a frame on another, with the joints between them. Poses are in the frame of the held
/// link.
#[derive(Clone, Debug)]
pub struct Chain {
    legs: Vec<Leg>,
    X_LF: Pose,
    joints: Vec<ChainJoint>,
    length: f64,
}

/// A step of the tree along the chain, in its own direction or against it.
#[derive(Clone, Debug)]
struct Leg {
    step: Step,
    forward: bool,
}

/// A joint that moves the frame at the end of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainJoint {
    /// The number of the joint in its [`super::JointId`].
    pub joint: usize,
    /// The least and the greatest position, rad or m; infinite where it turns for ever.
    pub limits: (f64, f64),
    /// True for a joint that slides, so that positions are in metres.
    pub slides: bool,
}

/// The orientation that a frame is to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// Any orientation: only the position is asked for.
    Free,
    /// The frame's x axis points along this unit vector; the turn about it is free.
    Along(Vec3),
    /// The orientation as a whole.
    Full(UnitQuaternion<f64>),
}

/// A place for a frame, in the frame of the held link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The position of the frame's origin, m.
    pub position: Vec3,
    /// The orientation of the frame.
    pub orientation: Orientation,
}

/// The distance of a frame from a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseError {
    /// The distance of the origins, m.
    pub distance: f64,
    /// The angle between the orientations, or between the axes, rad; 0 where the orientation is free.
    pub angle: f64,
}

/// The limits and weights of a descent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DescentSettings {
    /// The error up to which a target counts as reached. Default 1e-9 m and 1e-9 rad: a thousandth of what is promised.
    pub tolerance: PoseError,
    /// The greatest number of steps. Default 100.
    pub steps_max: usize,
    /// The greatest number of steps in a row that do not lessen the least error by a tenth. Default 12.
    pub patience: usize,
    /// True if steps are damped more where they lead away from the target: for the nearest posture to a place that is out of
    /// reach. Default false.
    pub cautious: bool,
}

impl Default for DescentSettings {
    fn default() -> DescentSettings {
        DescentSettings {
            tolerance: PoseError { distance: 1e-9, angle: 1e-9 },
            steps_max: 100,
            patience: 12,
            cautious: false,
        }
    }
}

/// The factor of the damping: it is this times the squared error, without unit.
const DAMPING: f64 = 1e-3;
/// The factor by which the damping grows after a step that led away.
const CAUTION: f64 = 4.0;
/// The factor by which it falls after a step that did not.
const CONFIDENCE: f64 = 1.5;
/// The least damping, without unit.
const DAMPING_MIN: f64 = 1e-12;
/// The greatest change of a joint in one step, rad, and as a fraction of the chain's length for a slide.
const CHANGE_MAX: f64 = 1.2;
/// The greatest part of the chain's length, and the greatest angle (rad), that one step corrects.
const CORRECTION_MAX: f64 = 0.7;
/// A descent that has lessened the least error by this factor counts as going on.
const PROGRESS: f64 = 0.9;

impl ChainJoint {
    /// Returns the joint of an owner with its limits if it takes commands; `joint`: the number in its [`super::JointId`]. Panics
    /// if there is no such module, joint or bond.
    pub fn commanded(robot: &Assembly, owner: JointOwner, joint: usize) -> Option<ChainJoint> {
        let range = match owner {
            JointOwner::Bond(bond) => robot.hinge(bond)?.limits.range,
            JointOwner::Module { module, joint } => {
                let declared = &robot.module_type(module).joints[joint];
                let moves =
                    declared.kind != JointKind::Fixed && !declared.passive && declared.mimic.is_none();
                moves.then_some(declared.limits.range)?
            }
        };
        let limits = range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        Some(ChainJoint { joint, limits, slides: robot.slides(owner) })
    }
}

impl PoseError {
    /// Returns true if neither part is greater than that of `tolerance`.
    pub fn is_within(&self, tolerance: &PoseError) -> bool {
        self.distance <= tolerance.distance && self.angle <= tolerance.angle
    }
}

impl Chain {
    /// Compiles the chain from the link of number `held` to a frame; `None` if bonds do not connect them. Fixed, passive and
    /// mimicking joints are no joints of the chain; what follows a joint moves with it. `robot`: the assembly;
    /// `kinematics`: its kinematics for the bonds that hold.
    pub fn new(robot: &Assembly, kinematics: &Kinematics, held: usize, frame: &LinkFrame) -> Option<Chain> {
        let path = kinematics.path(held, frame.link)?;
        let owners: Vec<JointOwner> = robot.joints().collect();
        let legs: Vec<Leg> = path
            .windows(2)
            .map(|pair| {
                let (step, sign) = kinematics.step_between(pair[0], pair[1]);
                Leg { step: step.clone(), forward: sign > 0.0 }
            })
            .collect();
        let mut joints: Vec<ChainJoint> = Vec::new();
        for leg in &legs {
            for &(joint, _) in leg.step.terms() {
                let known = joints.iter().any(|known| known.joint == joint);
                joints.extend(ChainJoint::commanded(robot, owners[joint], joint).filter(|_| !known));
            }
        }
        let length = length(&legs, frame, &joints);
        Some(Chain { legs, X_LF: frame.X_LF, joints, length })
    }

    /// Returns the joints of the chain, from the held link on.
    pub fn joints(&self) -> &[ChainJoint] {
        &self.joints
    }

    /// Returns an upper bound on the distance of the frame from the held link's origin, m; infinite with a slide without
    /// range.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the sum of the sizes of the factors by which a joint (its number in its [`super::JointId`]) moves steps of the
    /// chain, joints that follow it included; 0 if it moves none.
    pub fn factor(&self, joint: usize) -> f64 {
        let terms = self.legs.iter().flat_map(|leg| leg.step.terms());
        terms.filter(|(moved, _)| *moved == joint).map(|(_, factor)| factor.abs()).sum()
    }

    /// Returns the pose of the frame in that of the held link; `joints`: the positions of all joints of the robot (rad or
    /// m), by the number in their [`super::JointId`].
    pub fn pose(&self, joints: &[f64]) -> Pose {
        self.legs.iter().fold(Pose::identity(), |at, leg| leg.across(&at, joints)) * self.X_LF
    }

    /// Returns the error of a frame's pose against a target, and the motion that would correct it: a shift (m) and a
    /// rotation vector (rad).
    pub fn error(pose: &Pose, target: &Target) -> (PoseError, Vector6<f64>) {
        let apart = target.position - pose.translation.vector;
        let turn = match target.orientation {
            Orientation::Free => Vec3::zeros(),
            Orientation::Full(wanted) => {
                let turn = wanted * pose.rotation.inverse();
                rotation_vector(&RigidTransform::from(&Pose::from_parts(Vec3::zeros().into(), turn)).rotation)
            }
            Orientation::Along(wanted) => between(&(pose.rotation * Vec3::x()), &wanted),
        };
        let error = PoseError { distance: apart.norm(), angle: turn.norm() };
        (error, Vector6::new(apart.x, apart.y, apart.z, turn.x, turn.y, turn.z))
    }

    /// Changes `joints` (all of the robot, rad or m, by the number in their [`super::JointId`]) so that the frame comes to
    /// the target, by damped least squares within the limits of the joints, a local search. Returns the error at the
    /// end and the number of steps; the best positions stay in `joints`.
    pub fn descend(
        &self,
        target: &Target,
        joints: &mut [f64],
        settings: &DescentSettings,
    ) -> (PoseError, usize) {
        self.search(target, joints, settings, true)
    }

    /// Descends as [`descend`](Self::descend) does, first with joints that turn free to leave their limits, since whole turns
    /// may bring them back; only where they do not, within the limits. Returns the error at the end.
    pub fn attempt(&self, target: &Target, joints: &mut [f64], settings: &DescentSettings) -> PoseError {
        let begin = joints.to_vec();
        let (error, _) = self.search(target, joints, settings, false);
        let mut inside = true;
        for joint in self.joints.iter().filter(|joint| !joint.slides) {
            let at = &mut joints[joint.joint];
            *at = self.unwound(joint, *at, begin[joint.joint]);
            let clamped = at.clamp(joint.limits.0, joint.limits.1);
            inside &= clamped == *at;
            *at = clamped;
        }
        if inside && error.is_within(&settings.tolerance) {
            error
        } else {
            self.descend(target, joints, settings).0
        }
    }

    /// Returns a position less whole turns, so that it is within the limits and as near to another as may be.
    fn unwound(&self, joint: &ChainJoint, position: f64, near: f64) -> f64 {
        let nearest = position - TAU * libm::round((position - near) / TAU);
        let turns = |bound: f64| if bound.is_finite() { (bound - nearest) / TAU } else { bound };
        let (least, most) = (libm::ceil(turns(joint.limits.0)), libm::floor(turns(joint.limits.1)));
        nearest + TAU * if least <= most { 0.0f64.clamp(least, most) } else { 0.0 }
    }

    fn search(
        &self,
        target: &Target,
        joints: &mut [f64],
        settings: &DescentSettings,
        within: bool,
    ) -> (PoseError, usize) {
        let mut work = Workspace::default();
        let (mut best, mut best_joints) = (f64::INFINITY, joints.to_vec());
        let (mut progress, mut since, mut steps) = (f64::INFINITY, 0, 0);
        let mut least = PoseError { distance: f64::INFINITY, angle: f64::INFINITY };
        let (mut before, mut caution) = (f64::INFINITY, 1.0);
        loop {
            let (error, wanted) = self.evaluate(target, joints, &mut work);
            let merit = self.merit(&error);
            if merit < best {
                (best, least) = (merit, error);
                best_joints.copy_from_slice(joints);
            }
            if merit < PROGRESS * progress {
                (progress, since) = (merit, 0);
            } else {
                since += 1;
            }
            let done = error.is_within(&settings.tolerance);
            if done || since > settings.patience || steps >= settings.steps_max {
                break;
            }
            // Steps that lead away are too long for the linear model: the next are damped more.
            caution = match merit > before && settings.cautious {
                true => caution * CAUTION,
                false => f64::max(caution / CONFIDENCE, 1.0),
            };
            before = merit;
            let damping = caution * DAMPING * (merit * merit).min(1.0) + DAMPING_MIN;
            self.step(&wanted, (damping, within), joints, &mut work);
            steps += 1;
        }
        joints.copy_from_slice(&best_joints);
        (least, steps)
    }

    /// Searches for positions that bring the frame to a target by [`descend`](Self::descend) from those in `joints`, and, as
    /// long as that fails, by [`attempt`](Self::attempt) from random ones: `starts` in all. Returns the least error, the number of starts, and leaves
    /// the best positions in `joints`.
    pub fn reach(
        &self,
        target: &Target,
        joints: &mut [f64],
        (starts, rng): (usize, &mut SplitMix64),
        settings: &DescentSettings,
    ) -> (PoseError, usize) {
        let begin = joints.to_vec();
        let mut least = PoseError { distance: f64::INFINITY, angle: f64::INFINITY };
        for start in 0..starts {
            let mut trial = begin.clone();
            let error = if start == 0 {
                self.descend(target, &mut trial, settings).0
            } else {
                self.scatter(&begin, &mut trial, rng);
                self.attempt(target, &mut trial, settings)
            };
            if self.merit(&error) < self.merit(&least) {
                least = error;
                joints.copy_from_slice(&trial);
            }
            if error.is_within(&settings.tolerance) {
                return (error, start + 1);
            }
        }
        (self.approach(target, joints, settings), starts)
    }

    /// Comes as near to a target that is out of reach as small steps lead, from a posture near it, and returns the error.
    pub fn approach(&self, target: &Target, joints: &mut [f64], settings: &DescentSettings) -> PoseError {
        let patient = DescentSettings { patience: settings.steps_max, cautious: true, ..*settings };
        self.descend(target, joints, &patient).0
    }

    /// Puts the joints of the chain at random positions within their limits, those that turn for ever within half a turn of
    /// `begin`, in place.
    pub fn scatter(&self, begin: &[f64], joints: &mut [f64], rng: &mut SplitMix64) {
        for joint in &self.joints {
            let at = begin[joint.joint];
            let span = if joint.slides { self.scale() } else { PI };
            let low = if joint.limits.0.is_finite() { joint.limits.0 } else { at - span };
            let high = if joint.limits.1.is_finite() { joint.limits.1 } else { at + span };
            joints[joint.joint] = low + rng.next_f64() * (high - low);
        }
    }

    /// Returns an error as one number: distances as parts of the chain's length, with angles in rad.
    pub fn merit(&self, error: &PoseError) -> f64 {
        libm::hypot(error.distance / self.scale(), error.angle)
    }

    /// Returns the length by which distances are divided, so that they weigh as angles do, m.
    fn scale(&self) -> f64 {
        if self.length.is_finite() && self.length > 0.0 { self.length } else { 1.0 }
    }

    /// Returns the error and the motion that would correct it, and leaves the columns of the Jacobian in `work`.
    fn evaluate(&self, target: &Target, joints: &[f64], work: &mut Workspace) -> (PoseError, Vector6<f64>) {
        work.poses.clear();
        work.poses.push(Pose::identity());
        for leg in &self.legs {
            let last = work.poses[work.poses.len() - 1];
            work.poses.push(leg.across(&last, joints));
        }
        let pose = work.poses[work.poses.len() - 1] * self.X_LF;
        let origin = pose.translation.vector;
        work.columns.clear();
        work.columns.resize(self.joints.len(), Vector6::zeros());
        for (leg, pair) in self.legs.iter().zip(work.poses.windows(2)) {
            let (parent, child, sign) =
                if leg.forward { (&pair[0], &pair[1], 1.0) } else { (&pair[1], &pair[0], -1.0) };
            let Some(axis) = leg.step.axis_between(parent, child) else { continue };
            let (linear, angular) = axis.velocity(&origin);
            for &(joint, factor) in leg.step.terms() {
                let Some(at) = self.joints.iter().position(|known| known.joint == joint) else { continue };
                let factor = sign * factor;
                let (v, w) = (linear * factor, angular * factor);
                work.columns[at] += Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
            }
        }
        match target.orientation {
            Orientation::Full(_) => {}
            Orientation::Free => work.columns.iter_mut().for_each(|column| {
                column.fixed_rows_mut::<3>(3).fill(0.0);
            }),
            // Turns about the axis itself make no difference.
            Orientation::Along(_) => {
                let axis = pose.rotation * Vec3::x();
                for column in &mut work.columns {
                    let mut turn = column.fixed_rows_mut::<3>(3);
                    let along = axis.dot(&turn);
                    turn -= axis * along;
                }
            }
        }
        Chain::error(&pose, target)
    }

    /// Takes one step of damped least squares towards a motion of the frame, `wanted`, in place. A joint at an end of its range
    /// that the step would move beyond it takes no part, and the others make up for it (the clamping loop of Baerlocher and
    /// Boulic 2004, *An inverse kinematics architecture enforcing an arbitrary number of strict priority levels*).
    fn step(
        &self,
        wanted: &Vector6<f64>,
        (damping, within): (f64, bool),
        joints: &mut [f64],
        work: &mut Workspace,
    ) {
        let scale = self.scale();
        let shift = shortened(wanted.fixed_rows::<3>(0) / scale, CORRECTION_MAX);
        let turn = shortened(wanted.fixed_rows::<3>(3).into(), CORRECTION_MAX);
        let task = Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
        for column in &mut work.columns {
            let mut linear = column.fixed_rows_mut::<3>(0);
            linear /= scale;
        }
        let mut gram = Matrix6::identity() * damping;
        work.columns.iter().for_each(|column| gram += column * column.transpose());
        let solved = loop {
            let Some(solved) = gram.cholesky().map(|factor| factor.solve(&task)) else { return };
            let mut clamped = false;
            for (joint, column) in self.joints.iter().zip(&mut work.columns) {
                let (at, change) = (joints[joint.joint], column.dot(&solved));
                let leaves = change < 0.0 && at <= joint.limits.0 || change > 0.0 && at >= joint.limits.1;
                if (within || joint.slides) && leaves {
                    gram -= *column * column.transpose();
                    column.fill(0.0);
                    clamped = true;
                }
            }
            if !clamped {
                break solved;
            }
        };
        let unit = |joint: &ChainJoint| if joint.slides { scale } else { 1.0 };
        let changes = work.columns.iter().map(|column| column.dot(&solved));
        let greatest = changes
            .zip(&self.joints)
            .fold(0.0, |most: f64, (change, joint)| most.max(change.abs() / unit(joint)));
        let part = (CHANGE_MAX / greatest.max(f64::MIN_POSITIVE)).min(1.0);
        for (joint, column) in self.joints.iter().zip(&work.columns) {
            let at = &mut joints[joint.joint];
            *at += part * column.dot(&solved);
            if within || joint.slides {
                *at = at.clamp(joint.limits.0, joint.limits.1);
            }
        }
    }
}

/// The buffers of a descent, which one evaluation leaves for the step after it.
#[derive(Default)]
struct Workspace {
    /// The poses of the links along the chain.
    poses: Vec<Pose>,
    /// The columns of the Jacobian, one for each joint of the chain.
    columns: Vec<Vector6<f64>>,
}

impl Leg {
    /// Returns the pose of the next link from that of the one before.
    fn across(&self, at: &Pose, joints: &[f64]) -> Pose {
        if self.forward {
            self.step.child_pose(at, joints)
        } else {
            at * self.step.child_pose(&Pose::identity(), joints).inverse()
        }
    }
}

/// Returns the sum of the distances from axis to axis, and of the travels of slides, m.
fn length(legs: &[Leg], frame: &LinkFrame, joints: &[ChainJoint]) -> f64 {
    let (mut length, mut last) = (0.0, Vec3::zeros());
    for leg in legs {
        // The point of the axis that both links carry, in the frame of the one and of the other.
        let (in_parent, in_child) = (leg.step.shift, -leg.step.offset);
        let (here, there) = if leg.forward { (in_parent, in_child) } else { (in_child, in_parent) };
        length += (here - last).norm();
        last = there;
        if let Motion::Along(_) = leg.step.motion {
            let travel = |(joint, factor): &(usize, f64)| {
                let limits =
                    joints.iter().find(|known| known.joint == *joint).map_or((0.0, 0.0), |j| j.limits);
                factor.abs() * limits.0.abs().max(limits.1.abs())
            };
            length += leg.step.terms().iter().map(travel).sum::<f64>();
        }
    }
    length + (frame.X_LF.translation.vector - last).norm()
}

/// Returns the shortest rotation vector that turns one unit vector to another, rad; about any axis where they are opposite.
fn between(from: &Vec3, to: &Vec3) -> Vec3 {
    let normal = from.cross(to);
    let angle = libm::atan2(normal.norm(), from.dot(to));
    let aside = if from.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
    let axis = normal.try_normalize(f64::EPSILON).unwrap_or_else(|| from.cross(&aside).normalize());
    axis * angle
}

/// Returns a vector, shortened to a length if it is longer.
fn shortened(vector: Vec3, length: f64) -> Vec3 {
    vector * (length / vector.norm().max(f64::MIN_POSITIVE)).min(1.0)
}
