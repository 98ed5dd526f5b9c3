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

use super::motion_bounds::{Interval, JointMotion, JointMotions};
use super::reference_links::ReferenceLinks;
use crate::geometry::{Pose, Vec3};
use crate::robot::Kinematics;
use crate::robot::{Motion, Step};
use nalgebra::Matrix3;

/// The poses and velocities of the links in the middle of an interval of time, with bounds on how their velocities
/// deviate from these until its ends. A link is computed only when it is first [required](Self::require): most
/// intervals need few.
#[derive(Clone, Debug)]
pub(super) struct IntervalState {
    along: JointMotions,
    /// The interval of time whose middle this is the state of.
    pub interval: Interval,
    /// The number of the interval: an entry of the lists below is of this interval where its mark is this number.
    epoch: u32,
    /// The motion of each joint, by the number in its `JointId`.
    motions: Vec<JointMotion>,
    motions_of: Vec<u32>,
    /// The positions of the joints in the middle, rad or m.
    at: Vec<f64>,
    /// The rates of the joints in the middle, rad/s or m/s.
    rate: Vec<f64>,
    poses: Vec<Pose>,
    /// Orientation, position (m), angular velocity (rad/s) and velocity (m/s) of each link that was required, by its
    /// number in the kinematics, in the frame of the root link.
    pub links: Vec<Moving>,
    links_of: Vec<u32>,
    /// The state of the step to each link.
    joints: Vec<JointInterval>,
    /// The deviation of each link that was required, for each level, with the mark of its interval.
    deviations: Vec<Vec<(u32, Deviation)>>,
    /// The links that remain to be computed, on the way to the one that is required.
    pending: Vec<usize>,
    /// The links whose deviations remain to be computed.
    pending_deviations: Vec<usize>,
    /// The number of links and deviations computed since it was asked for.
    computed: usize,
}

/// Pose and velocity of a link, in the frame of the root link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moving {
    /// The orientation `R_0L` of the link L in the frame 0 of the root link.
    pub R: Matrix3<f64>,
    /// The position of the link's origin in the frame of the root link, m.
    pub p: Vec3,
    /// The angular velocity of the link against the root link, in the frame of the root link, rad/s.
    pub spin: Vec3,
    /// The velocity of the link's origin against the root link, in the frame of the root link, m/s.
    pub v: Vec3,
}

/// Bounds on the difference of a link's velocities anywhere in an interval from those in its middle, both relative to
/// a reference link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Deviation {
    /// A bound on the deviation of the velocity of the link's origin, m/s.
    pub velocity: f64,
    /// A bound on the deviation of the velocity for each metre that a point is away from the link's origin, 1/s.
    pub gradient: f64,
    /// The deviation of the angular velocity, rad/s.
    turn: f64,
    /// A bound on the angular velocity, rad/s.
    spin: f64,
}

impl IntervalState {
    /// Returns a state for joints that move as `along` says; an interval must be [`set`](Self::set) before anything
    /// is computed.
    pub(super) fn new(along: JointMotions) -> IntervalState {
        let joints = along.joint_count();
        IntervalState {
            along,
            interval: Interval::default(),
            epoch: 0,
            motions: vec![JointMotion::default(); joints],
            motions_of: vec![0; joints],
            at: vec![0.0; joints],
            rate: vec![0.0; joints],
            poses: Vec::new(),
            links: Vec::new(),
            links_of: Vec::new(),
            joints: Vec::new(),
            deviations: Vec::new(),
            pending: Vec::new(),
            pending_deviations: Vec::new(),
            computed: 0,
        }
    }

    /// Begins the interval `from..to` (s): nothing is computed yet but the root link, whose frame is that of all
    /// poses. `kinematics`: that of the part of the robot that is examined.
    pub(super) fn set(&mut self, kinematics: &Kinematics, from: f64, to: f64) {
        self.interval = self.along.interval(from, to);
        self.epoch += 1;
        let count = kinematics.link_count();
        self.poses.resize(count, Pose::identity());
        self.links.resize(count, Moving::default());
        self.links_of.resize(count, 0);
        self.joints.resize(count, JointInterval::default());
        let root = kinematics.link(kinematics.root, 0);
        self.poses[root] = Pose::identity();
        self.links[root] = Moving { R: Matrix3::identity(), ..Moving::default() };
        self.links_of[root] = self.epoch;
    }

    /// Returns the number of the present interval, counted from 1 over all that were [`set`](Self::set); 0 before the
    /// first.
    pub(super) fn epoch(&self) -> u32 {
        self.epoch
    }

    /// Returns the number of links and of deviations computed since this was called last, as a measure of work.
    pub(super) fn take_computed(&mut self) -> usize {
        std::mem::take(&mut self.computed)
    }

    /// Computes pose and velocity, in the middle of the interval, of a link and of those between it and the root.
    /// `link`: its number ([`Kinematics::link`]), of the part that `kinematics` reaches, or it panics.
    #[inline]
    pub(super) fn require(&mut self, kinematics: &Kinematics, link: usize) {
        if self.links_of[link] != self.epoch {
            self.compute(kinematics, link);
        }
    }

    fn compute(&mut self, kinematics: &Kinematics, link: usize) {
        let mut pending = std::mem::take(&mut self.pending);
        let mut at = link;
        while self.links_of[at] != self.epoch {
            pending.push(at);
            at = kinematics.step(at).expect("a link of the connected part").parent;
        }
        while let Some(link) = pending.pop() {
            let step = kinematics.step(link).expect("it is not the root's body");
            for &(joint, _) in step.terms() {
                self.require_joint(joint);
            }
            self.poses[link] = step.child_pose(&self.poses[step.parent], &self.at);
            self.links[link] = self.moving(step);
            self.joints[link] = self.joint(step);
            self.links_of[link] = self.epoch;
            self.computed += 1;
        }
        self.pending = pending;
    }

    fn require_joint(&mut self, joint: usize) {
        if self.motions_of[joint] != self.epoch {
            let motion = self.along.over(joint, &self.interval);
            (self.at[joint], self.rate[joint], self.motions[joint]) = (motion.at, motion.rate, motion);
            self.motions_of[joint] = self.epoch;
        }
    }

    fn moving(&self, step: &Step) -> Moving {
        let before = &self.links[step.parent];
        let pose = &self.poses[step.link];
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let p = pose.translation.vector;
        let rate = step.position(&self.rate);
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

    /// Computes the deviation of a link at a level, an index in [`ReferenceLinks::levels`], and all that it follows
    /// from: pose and velocity of the links between it and its reference link. `link`: its number
    /// ([`Kinematics::link`]).
    #[inline]
    pub(super) fn require_deviation(
        &mut self,
        kinematics: &Kinematics,
        levels: &ReferenceLinks,
        level: usize,
        link: usize,
    ) {
        let known = self.deviations.get(level).and_then(|of| of.get(link));
        if known.is_none_or(|(mark, _)| *mark != self.epoch) {
            self.compute_deviation(kinematics, levels, level, link);
        }
    }

    fn compute_deviation(
        &mut self,
        kinematics: &Kinematics,
        levels: &ReferenceLinks,
        level: usize,
        link: usize,
    ) {
        if self.deviations.len() <= level {
            self.deviations.resize(level + 1, Vec::new());
        }
        let mut deviations = std::mem::take(&mut self.deviations[level]);
        deviations.resize(self.links.len(), (0, Deviation::default()));
        let plan = &levels.levels[level];
        let mut pending = std::mem::take(&mut self.pending_deviations);
        let origin = levels.origin(level, link);
        self.require(kinematics, origin);
        let mut at = link;
        while deviations[at].0 != self.epoch {
            self.require(kinematics, at);
            let Some(hop) = plan.hop_to(at) else {
                deviations[at] = (self.epoch, Deviation::default());
                break;
            };
            pending.push(at);
            at = hop.from as usize;
        }
        let reference = self.links[origin].spin;
        let spin = |link: usize| (self.links[link].spin - reference).norm();
        while let Some(link) = pending.pop() {
            let hop = plan.hop_to(link).expect("it is not the reference link");
            let (from, child) = (hop.from as usize, hop.child as usize);
            let step = kinematics.step(child).expect("a step leads to a child");
            let (before, after) = (spin(from), spin(link));
            let deviation =
                deviations[from].1.beyond(step, &self.joints[child], (hop.out, hop.back), (before, after));
            deviations[link] = (self.epoch, deviation);
            self.computed += 1;
        }
        self.pending_deviations = pending;
        self.deviations[level] = deviations;
    }

    /// Returns the deviation of a link, by its number ([`Kinematics::link`]), from its velocity relative to the
    /// reference link of a level. It must have been [required](Self::require_deviation) in this interval.
    #[inline]
    pub(super) fn deviation(&self, level: usize, link: usize) -> &Deviation {
        let (mark, deviation) = &self.deviations[level][link];
        debug_assert_eq!(*mark, self.epoch, "it was required");
        deviation
    }

    /// Returns `X_AB`, the pose of link b in link a's frame in the middle of the interval; both by their numbers
    /// ([`Kinematics::link`]), and both [required](Self::require) before.
    pub(super) fn relative(&self, a: usize, b: usize) -> Pose {
        self.poses[a].inverse() * self.poses[b]
    }

    fn joint(&self, step: &Step) -> JointInterval {
        let terms = step.terms().iter();
        JointInterval {
            rate: step.position(&self.rate).abs(),
            deviation: terms.map(|&(joint, factor)| factor.abs() * self.motions[joint].deviation).sum(),
            half: self.interval.half,
            reach: step.position(&self.at).abs(),
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
