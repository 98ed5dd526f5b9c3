//! The rollout of a plan: the quasi-static motion of the robot on the ground, from sample to sample.
//!
//! Everything here is sequential, and depends on nothing but the plan: the attitude of a sample
//! follows from the sample before.

use super::contact;
use super::dynamics::{GroundStep, Traction, TravelSummary};
use super::entry::Entry;
use super::in_force::{excused, world_at};
use super::model::{Model, Posture};
use super::sampling;
use super::stance::{Placement, Stance, StepOutcome};
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::interrupt;
use crate::plan::{Exemption, Ground, Plan, Settings, Tracks, World, WorldFrom, is_full};
use crate::robot::dynamics::Dynamics;
use crate::units::{Dimension, quantity};

/// A plan to roll out, with settings and tolerances. The plan must be valid.
#[derive(Clone, Copy)]
pub struct Rollout<'a> {
    /// The body of the plan: the robot, its state at the start, and the trajectories of its joints.
    pub tracks: &'a Tracks,
    /// The worlds that the plan assumes, in order of time.
    pub worlds: &'a [WorldFrom],
    /// The exemptions of the plan.
    pub exemptions: &'a [Exemption],
    /// The plan's settings of verification.
    pub settings: &'a Settings,
    /// The tolerances of the judge.
    pub tolerances: &'a Tolerances,
    /// A joint, by the number in its `JointId`, that is held from a time on (s), to find the command to blame; `None`:
    /// all joints move.
    pub held: Option<(usize, f64)>,
    /// The beginning of a robot in the middle of the plan, by docking or undocking; `None`: it begins with the plan.
    pub begin: Option<&'a Entry>,
    /// The end of the whole plan, s: later than that of `tracks` for a robot that comes apart before.
    pub end: f64,
    /// The robot in words, for messages.
    pub subject: &'a str,
    /// True if the height at which the robot is placed counts where there is no ground: it stands so to others.
    pub as_placed: bool,
}

impl<'a> Rollout<'a> {
    /// Returns the rollout of a whole plan, whose body is `tracks`: all its joints move.
    pub fn of(plan: &'a Plan, tracks: &'a Tracks, tolerances: &'a Tolerances) -> Rollout<'a> {
        Rollout {
            tracks,
            worlds: &plan.worlds,
            exemptions: &plan.exemptions,
            settings: &plan.settings,
            tolerances,
            held: None,
            begin: None,
            end: tracks.duration,
            subject: "the robot",
            as_placed: false,
        }
    }

    /// Returns the time at which the robot begins, s.
    pub(super) fn from(&self) -> f64 {
        self.begin.map_or(0.0, |entry| entry.time)
    }

    /// Returns the instants (s) that are samples whatever the settings are; see [`sampling::instants`].
    pub(super) fn instants(&self) -> Vec<f64> {
        sampling::instants(self.tracks, self.from(), self.worlds, self.exemptions)
    }

    /// Returns true if the plan is judged under full dynamics: in one of its worlds, and then in all.
    pub(super) fn is_full(&self) -> bool {
        is_full(self.worlds)
    }
}

/// The robot at one sample of a rollout, with what changed since the sample before.
pub struct Sample<'a> {
    /// The time of the sample from the start of the plan, s.
    pub time: f64,
    /// The time of the sample before, s; the same as `time` at the start.
    pub before: f64,
    /// The positions of all joints, by the number in their `JointId`, rad or m.
    pub joints: &'a [f64],
    /// A flag for every bond of the robot, by its index, true if it holds.
    pub bonds: &'a [bool],
    /// The model of the robot with those bonds.
    pub model: &'a Model<'a>,
    /// The stance of the robot: its posture and attitude, its place in the world, and its contacts.
    pub stance: &'a Stance,
    /// The world that the plan assumes just after that time.
    pub world: &'a World,
    /// True if anything moved since the sample before.
    pub moved: bool,
    /// The fall of the centre of mass as the robot settles with the joints held, m, also where the base is held so that
    /// it does not; 0 off the ground.
    pub fall: f64,
    /// An upper bound on the motion of the robot's points about the centre of mass since the sample before, m; 0 off
    /// the ground.
    pub motion: f64,
    /// The loss of support since the sample before; `None` if there was none.
    pub tip: Option<&'a TipOver>,
    /// The slip of each loaded link since the sample before, as (number of the link, slip in m, load as a fraction of
    /// the weight). Under statics half of the slip comes with the contact patches of the sample before, the other half
    /// with those of this one, so that a link may occur twice.
    pub slips: &'a [(usize, f64, f64)],
    /// The angle by which the robot turned to settle, rad, at the start, and when a ground begins; `None` at other
    /// samples.
    pub settling: Option<f64>,
    /// The travel over the ground since the start, with its sensitivity to friction and servo stiffness; all 0 under
    /// statics.
    pub travel: TravelSummary,
}

/// A loss of support: the robot tips over an edge of its support polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct TipOver {
    /// The time at which the robot begins to fall over the edge, s, found by bisection up to the tolerance `time`.
    pub time: f64,
    /// The fall of the centre of mass, m, as the robot settles with the joints held at the sample that showed it.
    pub fall: f64,
    /// An upper bound on the motion of points about the centre of mass in the step that showed it, m.
    pub motion: f64,
    /// The numbers of the links at the two ends of the edge, one if they are the same; all supporting links if the
    /// support has no area.
    pub edge: Vec<usize>,
    /// True if an exemption excuses it.
    pub excused: bool,
    /// True if the robot falls onto the ground and not over an edge: it came off another above it.
    pub in_air: bool,
}

/// The reason why [`roll_out`] ended, which need not be the end of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RolloutEnd {
    /// The rollout reached the end of the plan.
    AtEnd,
    /// The rollout took all samples that are allowed.
    Limit {
        /// The time that it reached, s.
        time: f64,
        /// The number of features of the robot that can touch the ground; 0 where there is none.
        features: usize,
    },
    /// The observer ended the rollout.
    Stopped,
}

/// The greatest number of halvings of one step: times are then so close that nothing moves between them.
const HALVINGS_MAX: usize = 50;

/// The state of a rollout at a sample, from which [`roll_out`] can continue.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The stance at that time.
    pub stance: Stance,
    /// The time since which the base is held because the support was lost, s; `None` while it is not.
    held_since: Option<f64>,
    /// The state of travel; `None` under statics.
    traction: Option<Traction>,
}

/// A rollout in progress: the state of the robot at the last sample.
struct Stepper<'a> {
    rollout: Rollout<'a>,
    /// The model of the robot with the bonds that hold.
    model: Model<'a>,
    /// A flag for every bond, true if it holds.
    bonds: Vec<bool>,
    stance: Stance,
    /// The time of the last sample, s.
    now: f64,
    /// The positions of all joints, rad or m.
    joints: Vec<f64>,
    /// A buffer for the poses of the links.
    poses: Vec<Pose>,
    world: World,
    /// The time since which the base is held because the support was lost, s; `None` while it is not.
    held_since: Option<f64>,
    /// The state of travel and the masses of the robot; `None` under statics.
    traction: Option<(Traction, Dynamics)>,
    /// The number of samples since the start or the checkpoint, without that one.
    samples: usize,
}

/// Rolls a plan out from its start, or after the checkpoint `from` (`None`: from the start), until `until` (s) or its
/// end. `observe` receives every sample in order of time, with a function that returns the checkpoint at it, and
/// returns false to stop. The sample of the checkpoint itself is not observed again.
pub fn roll_out(
    rollout: Rollout,
    from: Option<&Checkpoint>,
    until: f64,
    observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool,
) -> RolloutEnd {
    let mut stepper = Stepper::new(rollout, from);
    if from.is_none() && !stepper.begin(observe) {
        return RolloutEnd::Stopped;
    }
    let first = stepper.now;
    let instants = rollout.instants();
    for &instant in instants.iter().filter(|t| **t > first) {
        interrupt::progress_checkpoint(|| {
            let [now, until] = [stepper.now, until].map(|t| quantity(t, Dimension::TIME));
            format!("walked {now} of {until}, {} samples", stepper.samples)
        });
        let target = instant.min(until);
        if target > stepper.now {
            match stepper.interval(target, observe) {
                RolloutEnd::AtEnd => {}
                ended => return ended,
            }
        }
        if instant >= until {
            break;
        }
    }
    RolloutEnd::AtEnd
}

impl<'a> Stepper<'a> {
    fn new(rollout: Rollout<'a>, from: Option<&Checkpoint>) -> Stepper<'a> {
        let tracks = rollout.tracks;
        let now = from.map_or(rollout.from(), |w| w.time);
        let bonds = tracks.bonds(now);
        let model = Model::new(&tracks.robot, &bonds);
        let world = world_at(rollout.worlds, now);
        let mut poses = Vec::new();
        let mut joints = Vec::new();
        positions(&rollout, now, &mut joints);
        let posture = model.posture(&joints, &mut poses);
        let stance = match from {
            Some(checkpoint) => checkpoint.stance.clone(),
            None => {
                let (base, placement) = match rollout.begin {
                    Some(entry) => (&entry.base, Placement::Fixed),
                    None => (&tracks.start.base, Placement::unsettled(&world, rollout.as_placed)),
                };
                Stance::start(&model, posture, base, (&world, placement), rollout.tolerances).0
            }
        };
        let held_since = from.and_then(|w| w.held_since);
        let traction = rollout.is_full().then(|| {
            let known = from.and_then(|checkpoint| checkpoint.traction.clone());
            (known.unwrap_or_default(), Dynamics::new(&tracks.robot))
        });
        Stepper { rollout, model, bonds, stance, now, joints, poses, world, held_since, traction, samples: 0 }
    }

    /// Sets the robot into its world, and observes the sample at the start; returns false if that stops the rollout.
    fn begin(&mut self, observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool) -> bool {
        if let Some(entry) = self.rollout.begin {
            let step = self.come_off(entry);
            return self.show(observe, self.now, &step);
        }
        let pose = self.rollout.tracks.start.base;
        let placement = if self.on_ground() {
            Placement::Settled
        } else {
            Placement::unsettled(&self.world, self.rollout.as_placed)
        };
        let (settling, fall) = match self.world.is_sloped() {
            true => self.place_on_slope(&pose),
            false => self.place_on_ground(&pose, placement),
        };
        self.show(observe, 0.0, &Step { settling: Some(settling), fall, moved: true, ..Step::default() })
    }

    /// Finds out whether the part, which stands where it came off another, stands by itself: it falls if there is
    /// ground below it that it does not touch, and if it tips over on it. It then settles, unless it is held for
    /// `unstable_for`.
    fn come_off(&mut self, entry: &Entry) -> Step {
        let mut step = Step { moved: true, ..Step::default() };
        if !self.on_ground() {
            return step;
        }
        let tolerances = self.rollout.tolerances;
        let begun = self.stance.clone();
        let posture = self.model.posture(&self.joints, &mut self.poses);
        let placement = (&self.world, Placement::Lowered);
        let lowered = Stance::start(&self.model, posture, &entry.base, placement, tolerances).0;
        let drop = begun.height - lowered.height;
        let (_, fall) = self.place_on_ground(&entry.base, Placement::Settled);
        let in_air = drop > tolerances.fall_floor;
        step.fall = fall + drop.max(0.0);
        if step.fall <= tolerances.fall_floor {
            return step;
        }
        let edge = if in_air { vec![] } else { edge(&begun, tolerances) };
        let excused = entry.time < self.rollout.end && excused(self.rollout.exemptions, entry.time);
        step.tip = Some(TipOver { time: entry.time, fall: step.fall, motion: 0.0, edge, excused, in_air });
        if !excused && !in_air {
            self.held_since = Some(entry.time);
            self.stance = begun.held_here(tolerances);
        }
        step
    }

    /// Takes the samples from `now` to `target` (s), between which no segment, bond, world or exemption begins or ends.
    fn interval(
        &mut self,
        target: f64,
        observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool,
    ) -> RolloutEnd {
        let (from, rollout) = (self.now, self.rollout);
        let divisions =
            sampling::divisions(rollout.tracks, from, target, rollout.settings, rollout.tolerances);
        for i in 1..=divisions.max(1) {
            let t =
                if i >= divisions { target } else { from + (target - from) * i as f64 / divisions as f64 };
            let ended = self.advance(t, divisions > 0, observe);
            if ended != RolloutEnd::AtEnd {
                return ended;
            }
        }
        RolloutEnd::AtEnd
    }

    /// Takes the sample at `target` (s), and others before it where a step has to be halved. `moving`: true if joints
    /// move on the way.
    fn advance(
        &mut self,
        target: f64,
        moving: bool,
        observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool,
    ) -> RolloutEnd {
        let mut targets = vec![target];
        while let Some(&t) = targets.last() {
            let features = if self.on_ground() { self.model.features.len() } else { 0 };
            if self.samples >= sampling::samples_max(self.rollout.settings, features) {
                return RolloutEnd::Limit { time: self.now, features };
            }
            self.samples += 1;
            let before = self.now;
            let Some(step) = self.step(t, moving, targets.len() < HALVINGS_MAX) else {
                targets.push(before + (t - before) / 2.0);
                continue;
            };
            targets.pop();
            if !self.show(observe, before, &step) {
                return RolloutEnd::Stopped;
            }
        }
        RolloutEnd::AtEnd
    }

    /// Moves the state on to the time `t` (s); `None`, with the state as it was, if the step has to be halved.
    fn step(&mut self, t: f64, moving: bool, may_halve: bool) -> Option<Step> {
        let changes = self.changes(t);
        if !moving && !changes.bonds && !changes.world && !self.stance.held {
            self.now = t;
            return Some(Step::default());
        }
        let mut joints = Vec::new();
        positions(&self.rollout, t, &mut joints);
        let posture = self.model.posture(&joints, &mut self.poses);
        let step = match self.on_ground() {
            true => self.step_on_ground(t, posture, may_halve)?,
            false => {
                self.stance = self.stance.kept(&self.model, posture, &self.world, self.rollout.tolerances);
                Step { moved: true, ..Step::default() }
            }
        };
        (self.joints, self.now) = (joints, t);
        Some(self.changed(t, changes, step))
    }

    /// Follows a change of posture on the ground, by settling or, after a loss of support, by holding the base; `None`
    /// if the step has to be halved.
    fn step_on_ground(&mut self, t: f64, posture: Posture, may_halve: bool) -> Option<Step> {
        let tolerances = self.rollout.tolerances;
        let attempt = self.stance.attempt(&self.model, posture, tolerances);
        let (fall, motion) = (attempt.fall, attempt.motion);
        let mut outcome = attempt.outcome(tolerances);
        if may_halve
            && (outcome == StepOutcome::Undecided || motion > tolerances.motion_sample)
            && !self.stance.held
        {
            if t - self.now > tolerances.time {
                return None;
            }
            outcome = if fall > tolerances.fall_floor { StepOutcome::TipOver } else { StepOutcome::Steady };
        }
        let mut step = Step { moved: true, fall, motion, ..Step::default() };
        let mut hold = false;
        if self.stance.held {
            let since = self.held_since.unwrap_or(t);
            hold = fall > tolerances.fall_floor && t - since <= self.rollout.settings.unstable_for;
        } else if outcome != StepOutcome::Steady {
            let tip = self.tip(t, fall, motion);
            hold = !tip.excused && t - tip.time <= self.rollout.settings.unstable_for;
            self.held_since = hold.then_some(tip.time);
            step.tip = Some(tip);
        }
        let (R, pose) = (self.stance.R, self.stance.planar_pose);
        if hold {
            self.stance = self.stance.holding(&self.model, attempt, tolerances);
        } else {
            (self.stance, step.slips) = self.stance.settled(&self.model, attempt, tolerances);
            self.held_since = None;
        }
        if let Some((traction, dynamics)) = &mut self.traction {
            let ground = GroundStep {
                rollout: &self.rollout,
                bonds: &self.bonds,
                model: &self.model,
                dynamics,
                world: &self.world,
                before: self.now,
                time: t,
                R_before: &R,
                R: &self.stance.R,
            };
            (self.stance.planar_pose, step.slips) = traction.advance(&ground, &pose);
        }
        Some(step)
    }

    /// Locates a tip-over in time, by bisection between the last sample, at which the robot stood, and the one at `t`
    /// (s), and finds the edge nearest to the centre of mass then. `fall`, `motion`: those at `t`, m.
    fn tip(&mut self, t: f64, fall: f64, motion: f64) -> TipOver {
        let tolerances = self.rollout.tolerances;
        let (mut standing, mut fallen) = (self.now, t);
        let mut joints = Vec::new();
        for _ in 0..HALVINGS_MAX {
            if fallen - standing <= tolerances.time {
                break;
            }
            let middle = standing + (fallen - standing) / 2.0;
            positions(&self.rollout, middle, &mut joints);
            let posture = self.model.posture(&joints, &mut self.poses);
            let tried = self.stance.attempt(&self.model, posture, tolerances);
            if tried.fall > tolerances.fall_floor {
                fallen = middle;
            } else {
                standing = middle;
            }
        }
        positions(&self.rollout, fallen, &mut joints);
        let posture = self.model.posture(&joints, &mut self.poses);
        let attempt = self.stance.attempt(&self.model, posture, tolerances);
        let over = self.stance.holding(&self.model, attempt, tolerances);
        let edge = edge(&over, tolerances);
        let excused = fallen < self.rollout.end && excused(self.rollout.exemptions, fallen);
        TipOver { time: fallen, fall, motion, edge, excused, in_air: false }
    }

    /// Returns flags for the changes from the last sample to just after `t` (s).
    fn changes(&self, t: f64) -> Changes {
        let bonds = self.rollout.tracks.bonds(t) != self.bonds;
        Changes { bonds, world: world_at(self.rollout.worlds, t) != self.world }
    }

    /// Brings the state, and the step that led to `t` (s), past the changes at that time.
    fn changed(&mut self, t: f64, changes: Changes, mut step: Step) -> Step {
        if changes.bonds {
            self.bonds = self.rollout.tracks.bonds(t);
            self.model = Model::new(&self.rollout.tracks.robot, &self.bonds);
            step.moved = true;
            self.rebuild_stance();
        }
        if changes.world {
            let before = self.world.ground;
            self.world = world_at(self.rollout.worlds, t);
            self.stance.enter(&self.model, &self.world, self.rollout.tolerances);
            step.moved = true;
            if self.on_ground() && before != Ground::Settle {
                let pose = self.stance.base_pose(&self.model);
                let (settling, fall) = self.place_on_ground(&pose, Placement::Settled);
                (step.settling, step.fall) = (Some(settling), fall);
            }
        }
        step
    }

    /// Rebuilds the stance for the present model, whose tree of links may be another one: nothing moves.
    fn rebuild_stance(&mut self) {
        let pose = self.stance.base_pose(&self.model);
        let held = self.stance.held;
        let posture = self.model.posture(&self.joints, &mut self.poses);
        let placement = (&self.world, Placement::Fixed);
        self.stance = Stance::start(&self.model, posture, &pose, placement, self.rollout.tolerances).0;
        self.stance.held = held;
    }

    /// Sets the robot down with its base at a pose, and returns the angle by which it turned to settle (rad) and the
    /// fall of the centre of mass (m).
    fn place_on_ground(&mut self, pose: &Pose, placement: Placement) -> (f64, f64) {
        let posture = self.model.posture(&self.joints, &mut self.poses);
        let (stance, fall, turn) =
            Stance::start(&self.model, posture, pose, (&self.world, placement), self.rollout.tolerances);
        (self.stance, self.held_since) = (stance, None);
        (turn, fall)
    }

    /// Sets the robot down on a slope as it was drawn, leaning with the ground or not: as it falls less. Returns the angle
    /// by which it turned to settle (rad) and the fall (m).
    fn place_on_slope(&mut self, pose: &Pose) -> (f64, f64) {
        let leaning = self.world.ground_pose() * pose;
        let first = self.place_on_ground(&leaning, Placement::Settled);
        let stance = self.stance.clone();
        let second = self.place_on_ground(pose, Placement::Settled);
        if second.1 < first.1 {
            return second;
        }
        self.stance = stance;
        first
    }

    /// Returns true if the robot rests and settles on the ground.
    fn on_ground(&self) -> bool {
        self.world.ground == Ground::Settle && self.world.gravity > 0.0
    }

    /// Hands the present sample to the observer; returns false if that stops the rollout. `before`: the time of the
    /// sample before, s.
    fn show(
        &self,
        observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool,
        before: f64,
        step: &Step,
    ) -> bool {
        let sample = Sample {
            time: self.now,
            before,
            joints: &self.joints,
            bonds: &self.bonds,
            model: &self.model,
            stance: &self.stance,
            world: &self.world,
            moved: step.moved,
            fall: step.fall,
            motion: step.motion,
            tip: step.tip.as_ref(),
            slips: &step.slips,
            settling: step.settling,
            travel: self
                .traction
                .as_ref()
                .map_or_else(TravelSummary::default, |(traction, _)| traction.travel()),
        };
        let checkpoint = || Checkpoint {
            time: self.now,
            stance: self.stance.clone(),
            held_since: self.held_since,
            traction: self.traction.as_ref().map(|(traction, _)| traction.clone()),
        };
        observe(&sample, &checkpoint)
    }
}

/// The changes at an instant: `true` for what differs after it from before.
#[derive(Clone, Copy)]
struct Changes {
    bonds: bool,
    world: bool,
}

/// The changes of a step, by the names of [`Sample`].
#[derive(Default)]
struct Step {
    moved: bool,
    fall: f64,
    motion: f64,
    tip: Option<TipOver>,
    slips: Vec<(usize, f64, f64)>,
    settling: Option<f64>,
}

/// Returns the links at the ends of the edge of support nearest to the centre of mass of a stance, one if they are the
/// same; all supporting links if the support has no area.
fn edge(stance: &Stance, tolerances: &Tolerances) -> Vec<usize> {
    let points = &stance.contact_points;
    let mut edge = match contact::margin(points, stance.foot(), |point| point.gap <= tolerances.gap_exact) {
        Some(margin) => vec![points[margin.edge.0].link, points[margin.edge.1].link],
        None => points.iter().filter(|x| x.gap <= tolerances.gap_exact).map(|x| x.link).collect(),
    };
    edge.dedup();
    edge
}

/// Overwrites `joints` with the positions (rad or m) of all joints at a time (s), by the number in their `JointId`;
/// the joint that the rollout holds keeps the position at which it is held.
pub(super) fn positions(rollout: &Rollout, t: f64, joints: &mut Vec<f64>) {
    joints.clear();
    joints.extend_from_slice(&rollout.tracks.start.joints);
    for track in &rollout.tracks.tracks {
        let index = track.joint.0 as usize;
        let t = match rollout.held {
            Some((joint, from)) if joint == index => t.min(from),
            _ => t,
        };
        joints[index] = track.position(joints[index], t);
    }
}
