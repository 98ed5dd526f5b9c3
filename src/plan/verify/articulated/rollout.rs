//! The rollout of a plan: the quasi-static motion of the robot on the ground, from sample to sample.
//!
//! Everything here is sequential, and depends on nothing but the plan: the attitude of a sample
//! follows from the sample before.

use super::dynamics::{GroundStep, SlipSpread, Traction, TravelSummary};
use super::entry::Entry;
use super::floating::Floating;
use super::in_force::{excused, positions, world_at};
use super::model::{Model, Posture};
use super::rollout_input::Rollout;
use super::sample::{Sample, TipOver};
use super::sampling;
use super::stance::{Placement, Stance, StepOutcome};
use crate::geometry::Pose;
use crate::interrupt;
use crate::plan::{Ground, World};
use crate::robot::dynamics::{Dynamics, Wrench};
use crate::units::{Dimension, quantity};

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
    /// The momentum with which the robot floats; `None` while it does not.
    floating: Option<Floating>,
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
        let floating = Floating::of(&rollout, &world, rollout.momentum());
        Stepper {
            rollout,
            model,
            bonds,
            stance,
            now,
            joints,
            poses,
            world,
            held_since,
            traction,
            floating,
            samples: 0,
        }
    }

    /// Sets the robot into its world, and observes the sample at the start; returns false if that stops the rollout.
    fn begin(&mut self, observe: &mut dyn FnMut(&Sample, &dyn Fn() -> Checkpoint) -> bool) -> bool {
        if let Some(entry) = self.rollout.begin {
            let step = self.come_off(entry);
            self.keep_moving(entry);
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
        let edge = if in_air { vec![] } else { begun.edge(tolerances) };
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
        let joints = sampling::divisions(rollout.tracks, from, target, rollout.settings, rollout.tolerances);
        let divisions = joints.max(self.drifts_for(target - from));
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
                let X_WB = self.floated(t, &joints);
                let placement = (&self.world, Placement::Fixed);
                self.stance =
                    Stance::start(&self.model, posture, &X_WB, placement, self.rollout.tolerances).0;
                Step { moved: true, ..Step::default() }
            }
        };
        (self.joints, self.now) = (joints, t);
        Some(self.changed(t, changes, step))
    }

    /// Returns the least number of samples over a time (s) in which the robot drifts or slides on by itself; 0 where it does not.
    fn drifts_for(&self, span: f64) -> usize {
        let (settings, tolerances) = (self.rollout.settings, self.rollout.tolerances);
        let coasts = self.traction.as_ref().is_some_and(|(traction, _)| traction.coasts());
        match &self.floating {
            Some(floating) => floating.divisions(&self.model, &self.stance, span, settings, tolerances),
            None if coasts => (libm::ceil(span / settings.sample - tolerances.sample_count) as usize).max(1),
            None => 0,
        }
    }

    /// Gives a part that comes off in motion, and stands, its motion over the ground.
    fn keep_moving(&mut self, entry: &Entry) {
        let Some((traction, dynamics)) = self.traction.as_mut().filter(|_| !self.stance.held) else { return };
        if self.world.ground == Ground::Settle && self.world.gravity > 0.0 {
            let ground = GroundStep {
                rollout: &self.rollout,
                bonds: &self.bonds,
                model: &self.model,
                dynamics,
                world: &self.world,
                before: self.now,
                time: self.now,
                R_before: &self.stance.R,
                R: &self.stance.R,
            };
            traction.begin(&ground, &entry.momentum, self.stance.planar_pose.yaw);
        }
    }

    /// Returns the world pose of the base (`X_WB`, m) off the ground at a time (s) with joints at these positions (rad or
    /// m): where it is, or where its momentum takes it.
    fn floated(&self, t: f64, joints: &[f64]) -> Pose {
        let X_WB = self.stance.base_pose(&self.model);
        let Some(floating) = &self.floating else { return X_WB };
        let mut middle = Vec::new();
        positions(&self.rollout, (self.now + t) / 2.0, &mut middle);
        floating.moved(&self.model, X_WB, [&self.joints, &middle, joints], t - self.now)
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
            let mut next = self.stance.settled(&self.model, attempt, tolerances);
            if self.traction.is_none() {
                (next.planar_pose, step.slips) = self.stance.moved(&self.model, &next);
            }
            self.stance = next;
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
            step.spread = traction.spread();
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
        let edge = over.edge(tolerances);
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
            if before != Ground::Off || self.world.ground != Ground::Off {
                // A robot that leaves the ground begins at rest.
                self.floating = Floating::of(&self.rollout, &self.world, Wrench::default());
            }
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
            spread: step.spread,
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
    spread: SlipSpread,
    settling: Option<f64>,
}
