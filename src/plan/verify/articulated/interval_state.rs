//! The robot in the middle of an interval of time, with bounds on its motion until the ends, for conservative
//! advancement.
//!
//! Positions and velocities in the middle are exact. Positions at the ends are bounded, for each link as seen from
//! an origin link (see [`ReferenceLinks`](super::reference_links::ReferenceLinks)), by bounds on the deviation of
//! velocities from those in the middle:
//!
//! - turning: `ω' = ω + q̇ z`, where the axis z turns with the link before, deviates by the joint's own
//!   deviation plus `|q̇|` times the angle that z can turn by;
//! - moving: `v' = v + ω × r`, where r turns with its link, deviates by the deviation of ω times `|r|` plus
//!   `|ω|` times the distance that the tip of r can move.

use super::motion_bounds::{Interval, MotionBounds};
use super::reference_links::ReferenceLinks;
use crate::geometry::{Pose, Vec3};
use crate::robot::Kinematics;
use crate::robot::{Motion, Step};
use nalgebra::Matrix3;

/// The state of all links in the middle of an interval, with bounds on their motion.
#[derive(Clone, Debug, Default)]
pub(super) struct IntervalState {
    /// The joints over the interval.
    pub interval: Interval,
    poses: Vec<Pose>,
    /// Orientation, position (m), angular velocity (rad/s) and velocity (m/s) of each link, by its number in the
    /// kinematics, in the frame of the root link.
    pub links: Vec<Moving>,
    /// The state of each step of the kinematics.
    joints: Vec<JointInterval>,
    /// The deviation of each link, for each level that was asked for.
    deviations: Vec<Vec<Deviation>>,
    known: Vec<bool>,
}

/// Pose and velocity of a link, in the frame of the root link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moving {
    /// The orientation `R_0L` of the link L in the frame 0 of the root link.
    pub R: Matrix3<f64>,
    /// The position of the origin, m.
    pub p: Vec3,
    /// The angular velocity of the link against the root link, rad/s.
    pub spin: Vec3,
    /// The velocity of the origin, m/s.
    pub v: Vec3,
}

/// Bounds on the difference of a link's velocities, relative to a reference link, from those in the middle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Deviation {
    /// The deviation of the velocity of the link's origin, m/s.
    pub velocity: f64,
    /// The deviation of the velocity for each metre that a point is away from the link's origin, 1/s.
    pub gradient: f64,
    /// The deviation of the angular velocity, rad/s.
    turn: f64,
    /// A bound on the angular velocity, rad/s.
    spin: f64,
}

impl IntervalState {
    /// Computes poses and velocities in the middle of `from..to` (s).
    pub(super) fn set(&mut self, kinematics: &Kinematics, bounds: &MotionBounds, from: f64, to: f64) {
        bounds.over(from, to, &mut self.interval);
        self.poses.resize(kinematics.link_count(), Pose::identity());
        self.links.resize(kinematics.link_count(), Moving::default());
        kinematics.link_poses(&self.interval.at, &Pose::identity(), &mut self.poses);
        let root = kinematics.link(kinematics.root, 0);
        self.links[root] = Moving { R: Matrix3::identity(), ..Moving::default() };
        for step in &kinematics.steps {
            self.links[step.link] = self.moving(step);
        }
        let mut joints = std::mem::take(&mut self.joints);
        joints.clear();
        joints.extend(kinematics.steps.iter().map(|step| self.joint(step)));
        self.joints = joints;
        self.known.clear();
    }

    fn moving(&self, step: &Step) -> Moving {
        let before = &self.links[step.parent];
        let pose = &self.poses[step.link];
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let p = pose.translation.vector;
        let rate = step.position(&self.interval.rate);
        match (step.motion, step.motion.axis()) {
            (_, Some(axis)) => {
                let to_origin = R * step.offset;
                let spin = before.spin + R * axis * rate;
                let v = before.v + before.spin.cross(&(p - to_origin - before.p)) + spin.cross(&to_origin);
                Moving { R, p, spin, v }
            }
            (motion, None) => {
                let along = if let Motion::Along(d) = motion { before.R * d * rate } else { Vec3::zeros() };
                Moving { R, p, spin: before.spin, v: before.v + before.spin.cross(&(p - before.p)) + along }
            }
        }
    }

    /// Computes the bounds of all links at a level (an index in
    /// [`ReferenceLinks::levels`](super::reference_links::ReferenceLinks::levels)), when first asked for since
    /// [`set`](Self::set).
    pub(super) fn deviations(&mut self, kinematics: &Kinematics, levels: &ReferenceLinks, level: usize) {
        if self.known.len() != levels.levels.len() {
            self.known.resize(levels.levels.len(), false);
            self.deviations.resize(levels.levels.len(), Vec::new());
        }
        if std::mem::replace(&mut self.known[level], true) {
            return;
        }
        let mut deviations = std::mem::take(&mut self.deviations[level]);
        deviations.resize(self.links.len(), Deviation::default());
        let plan = &levels.levels[level];
        plan.origins.iter().for_each(|origin| deviations[*origin] = Deviation::default());
        for hop in &plan.hops {
            let step = &kinematics.steps[hop.step as usize];
            let origin = &self.links[plan.origin_of[hop.to as usize] as usize];
            let spin = |link: u32| (self.links[link as usize].spin - origin.spin).norm();
            let (before, after) = (spin(hop.from), spin(hop.to));
            let joint = &self.joints[hop.step as usize];
            deviations[hop.to as usize] =
                deviations[hop.from as usize].beyond(step, joint, (hop.out, hop.back), (before, after));
        }
        self.deviations[level] = deviations;
    }

    /// Returns the bound of a link, by its number in the kinematics, at a level for which
    /// [`deviations`](Self::deviations) was called.
    pub(super) fn deviation(&self, level: usize, link: usize) -> &Deviation {
        &self.deviations[level][link]
    }

    /// Returns `X_AB`, the pose of link b in link a, both by their numbers in the kinematics, in the middle of the
    /// interval.
    pub(super) fn relative(&self, a: usize, b: usize) -> Pose {
        self.poses[a].inverse() * self.poses[b]
    }

    fn joint(&self, step: &Step) -> JointInterval {
        let sum = |of: &[f64]| step.terms().iter().map(|&(joint, factor)| factor.abs() * of[joint]).sum();
        JointInterval {
            rate: step.position(&self.interval.rate).abs(),
            deviation: sum(&self.interval.deviation),
            half: self.interval.half,
            reach: step.position(&self.interval.at).abs(),
        }
    }
}

/// The joint of a step over the interval.
#[derive(Clone, Copy, Debug, Default)]
struct JointInterval {
    rate: f64,
    deviation: f64,
    half: f64,
    /// Extension of a prismatic joint, m.
    reach: f64,
}

impl Deviation {
    /// Returns the deviation of the next link over a joint. `arms`: the two links' origins from its axis, m;
    /// `spins`: the two links' angular velocities in the middle, rad/s.
    fn beyond(&self, step: &Step, joint: &JointInterval, arms: (f64, f64), spins: (f64, f64)) -> Deviation {
        // An axis of this link turns by at most this angle, and a unit vector moves by no more.
        let tilt = f64::min(2.0, self.spin * joint.half);
        if let Motion::Along(_) = step.motion {
            let slide = (joint.rate + joint.deviation) * joint.half;
            let arm = arms.0 + joint.reach + slide;
            let velocity = self.velocity + self.turn * arm + spins.0 * (tilt * arm + slide);
            return Deviation { velocity: velocity + joint.deviation + joint.rate * tilt, ..*self };
        }
        let turn = self.turn + joint.deviation + joint.rate * tilt;
        let spin = spins.1 + turn;
        let gradient = turn + spins.1 * f64::min(2.0, spin * joint.half);
        Deviation {
            velocity: self.velocity + self.gradient * arms.0 + gradient * arms.1,
            gradient,
            turn,
            spin,
        }
    }
}
