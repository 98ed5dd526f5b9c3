//! Measurements of a simulation.

use super::commands::Commands;
use super::falls::Falls;
use super::recording::{Drive, Moment, Recording};
use super::terrain::Terrain;
use crate::behavior::Reason;
use crate::geometry::pose::lean;
use crate::geometry::{Placed, Pose, Vec3};
use crate::plan::forward_dynamics::{Joint, Model, Stepper};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The time over which efforts are means, s: shorter peaks are those of gears and bearings.
const WINDOW: f64 = 0.05;

/// Threshold: the part of a motor's limit below it at which it is at its limit: the effort of a motor that drives several
/// joints follows from theirs, with rounding.
const TOL_LIMIT: f64 = 1e-9;

/// The greatest value of a quantity, and where and when it was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The number of the joint's [`JointId`](crate::robot::JointId), or the index of the bond.
    pub of: usize,
    /// The time from the start of the plan, s.
    pub time: f64,
}

/// Something that happens to a bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondEvent {
    /// The index of the bond in the assembly.
    pub bond: usize,
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The change of the bond.
    pub kind: BondEventKind,
}

/// A change of a bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondEventKind {
    /// Its ports undock.
    Undocks,
    /// Its ports dock: their distance (m) and the angle (rad) from a perfect mate.
    Docks(f64, f64),
    /// Its ports should dock, and are farther from each other than the connector captures: distance (m) and angle (rad).
    Misses(f64, f64),
    /// It breaks under this part of what it holds.
    Breaks(f64),
}

/// The result of a plan that is played.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// The time step, s.
    pub step: f64,
    /// The ground where it was not level, with the robot put on it.
    pub terrain: Option<Terrain>,
    /// The obstacles, each of shapes placed in the world.
    pub obstacles: Arc<[Vec<Placed>]>,
    /// The duration of the plan, s, or of its program as it was executed.
    pub duration: f64,
    /// The displacement of the base from the start of the plan to 0.3 s after its end, m.
    pub travel: Vec3,
    /// The turn of the base about the vertical in that time, rad: whole turns count, as in a verdict.
    pub heading: f64,
    /// The angle by which the base's own vertical at the start leans at the end, rad.
    pub lean: f64,
    /// The greatest such angle on the way, rad.
    pub lean_max: f64,
    /// The time at which a robot is first found to fall, s; `None`: none does. It drops, topples or collapses.
    pub fall: Option<f64>,
    /// The module on whose body that robot hangs, where it is not the one with the plan's base.
    pub fallen: Option<usize>,
    /// The farthest that a joint that turns is behind the plan, rad; `None` without driven joints.
    pub lag: Option<Extreme>,
    /// The farthest that a joint that slides is behind the plan, m.
    pub lag_length: Option<Extreme>,
    /// The greatest effort of a motor as the mean over 50 ms, in parts of its limit; `None` without limits.
    pub effort: Option<Extreme>,
    /// The longest time that a motor is at its limit in all, s.
    pub saturated: Option<Extreme>,
    /// The farthest that a link slid over the ground in all while it pressed on it, m.
    pub slip: f64,
    /// The greatest speed at which a part that did not touch the ground comes down on it, m/s.
    pub impact: f64,
    /// The mechanical work that the motors do, J: what drives them gives nothing back.
    pub work: f64,
    /// The greatest load of a bond, in parts of what it holds; `None` where no bond states that.
    pub bond_load: Option<Extreme>,
    /// The time (s) at which the executed program was stopped before its end, and the reason in words; `None`: it was not.
    pub stop: Option<(f64, String)>,
    /// The changes of bonds, in order of time.
    pub bonds: Vec<BondEvent>,
    /// The bonds that are in no tree although the plan never undocks them: those that break.
    pub apart: Vec<usize>,
    /// The servos and motors whose efforts the motion tells.
    pub drives: Vec<Drive>,
    /// The motion from the start of the plan, every 20 ms; of a long one at twice that time, four times, and so on, so that
    /// there are at most 4096 moments, and fewer for more than a thousand joints.
    pub motion: Vec<Moment>,
}

impl Simulation {
    /// Returns the greatest distance of two ports (m) when they docked, or were to dock and missed each other, with the
    /// index of the bond; `None` where nothing was to dock.
    pub fn dock_error(&self) -> Option<Extreme> {
        self.greatest_off(|distance, _| distance)
    }

    /// Returns the greatest angle of two such ports from a perfect mate (rad), with the index of the bond; `None` where
    /// nothing was to dock.
    pub fn dock_angle(&self) -> Option<Extreme> {
        self.greatest_off(|_, angle| angle)
    }

    fn greatest_off(&self, of: impl Fn(f64, f64) -> f64) -> Option<Extreme> {
        let mut greatest = None;
        for event in &self.bonds {
            if let BondEventKind::Docks(distance, angle) | BondEventKind::Misses(distance, angle) = event.kind
            {
                keep(&mut greatest, of(distance, angle), event.bond, event.time);
            }
        }
        greatest
    }

    /// Returns true if ports that were to dock missed each other.
    pub fn misses(&self) -> bool {
        self.bonds.iter().any(|event| matches!(event.kind, BondEventKind::Misses(..)))
    }

    /// Returns true if a bond broke.
    pub fn breaks(&self) -> bool {
        self.bonds.iter().any(|event| matches!(event.kind, BondEventKind::Breaks(_)))
    }

    /// Returns the time at which a robot first fell, a bond broke, ports did not dock, or the program was stopped before its
    /// end, s; `None` if nothing of that happened.
    pub fn failed_first(&self) -> Option<f64> {
        let bonds = self
            .bonds
            .iter()
            .filter(|event| matches!(event.kind, BondEventKind::Misses(..) | BondEventKind::Breaks(_)));
        let stop = self.stop.as_ref().map(|(time, _)| *time);
        bonds.map(|event| event.time).chain(self.fall).chain(stop).min_by(f64::total_cmp)
    }

    /// Returns true if a robot fell, a bond broke, ports did not dock, or the program was stopped before its end.
    pub fn fails(&self) -> bool {
        self.failed_first().is_some()
    }
}

/// The measurement of a simulation.
pub(super) struct Recorder<'a> {
    model: &'a Model,
    /// The bodies that servos drive, with their joints, side by side in memory.
    driven: Vec<(usize, Joint)>,
    step: f64,
    /// The efforts of the last steps in a ring, and their sums, by body.
    history: Vec<Vec<f64>>,
    sums: Vec<f64>,
    slot: usize,
    /// The time that each motor has been at its limit, s, by body.
    saturated: Vec<f64>,
    /// The same of the motors that drive several joints.
    saturated_coupled: Vec<Vec<f64>>,
    start: Pose,
    /// The way that each body had slid by the start of the plan, m.
    slid: Vec<f64>,
    falls: Falls<'a>,
    recording: Recording,
    out: Simulation,
}

fn keep(known: &mut Option<Extreme>, value: f64, of: usize, time: f64) {
    if known.is_none_or(|extreme| value > extreme.value) {
        *known = Some(Extreme { value, of, time });
    }
}

impl<'a> Recorder<'a> {
    /// Returns the measurement of a robot that has not moved. `falls`: the watch on its falls; `apart`: the bonds that are not
    /// in its trees although they hold all the time; `step`: the time step, s.
    pub(super) fn new(model: &'a Model, falls: Falls<'a>, apart: &[usize], step: f64) -> Recorder<'a> {
        let count = model.bodies.len();
        let driven = model.bodies.iter().enumerate().filter_map(|(at, body)| {
            let joint = body.joint.as_ref().filter(|joint| joint.servo.is_some())?;
            Some((at, joint.clone()))
        });
        let window = (libm::round(WINDOW / step) as usize).max(1);
        let out = Simulation {
            step,
            terrain: None,
            obstacles: Arc::default(),
            duration: 0.0,
            travel: Vec3::zeros(),
            heading: 0.0,
            lean: 0.0,
            lean_max: 0.0,
            fall: None,
            fallen: None,
            lag: None,
            lag_length: None,
            effort: None,
            saturated: None,
            slip: 0.0,
            impact: 0.0,
            work: 0.0,
            bond_load: None,
            stop: None,
            bonds: Vec::new(),
            apart: apart.to_vec(),
            drives: Vec::new(),
            motion: Vec::new(),
        };
        Recorder {
            model,
            driven: driven.collect(),
            step,
            history: vec![vec![0.0; count]; window],
            sums: vec![0.0; count],
            slot: 0,
            saturated: vec![0.0; count],
            saturated_coupled: model.coupled.iter().map(|coupled| vec![0.0; coupled.motors.len()]).collect(),
            start: model.start[0],
            slid: Vec::new(),
            falls,
            recording: Recording::new(model),
            out,
        }
    }

    /// Takes down that the program was stopped, the first time.
    pub(super) fn stop(&mut self, time: f64, reason: &Reason) {
        self.out.stop.get_or_insert_with(|| match reason {
            Reason::Aborted { message, .. } => (time, format!("the program is aborted: {message}")),
            other => (time, format!("the program stops: {other}")),
        });
    }

    /// Takes down something that happens to a bond.
    pub(super) fn bond(&mut self, event: BondEvent) {
        self.out.bonds.push(event);
    }

    /// Takes down the load of a bond, in parts of what it holds.
    pub(super) fn load(&mut self, bond: usize, load: f64, time: f64) {
        keep(&mut self.out.bond_load, load, bond, time);
    }

    /// Measures after a step that ends at `time` (s); before the start of the plan only what is needed later.
    pub(super) fn see(&mut self, stepper: &Stepper, commands: &Commands, time: f64) {
        for (at, (effort, old)) in stepper.efforts.iter().zip(&mut self.history[self.slot]).enumerate() {
            self.sums[at] += effort - *old;
            *old = *effort;
        }
        self.slot = (self.slot + 1) % self.history.len();
        if time <= 0.5 * self.step {
            self.start = *stepper.base(0);
            self.slid = stepper.slid().to_vec();
            self.recording.restart();
            self.record(stepper, commands, 0.0);
            // Steps before the last one of the rest at the start are forgotten.
            if time > -0.5 * self.step {
                self.falls.look(stepper, commands);
            }
            return;
        }
        if self.out.fall.is_none()
            && let Some(module) = self.falls.look(stepper, commands)
        {
            self.out.fall = Some(time);
            self.out.fallen = Some(module).filter(|module| *module != self.model.module_of[0]);
        }
        self.out.impact = self.out.impact.max(stepper.impact());
        let window = self.history.len() as f64;
        for (at, joint) in &self.driven {
            let at = *at;
            let lag = (stepper.coordinates[at] - commands.joints[joint.id].0 * joint.factor).abs();
            let lags = if joint.slides { &mut self.out.lag_length } else { &mut self.out.lag };
            keep(lags, lag, joint.id, time);
            self.out.work += (stepper.efforts[at] * stepper.rates[at]).max(0.0) * self.step;
            if let Some(limit) = joint.servo.and_then(|servo| servo.limit) {
                if limit > 0.0 {
                    keep(&mut self.out.effort, self.sums[at].abs() / (window * limit), joint.id, time);
                }
                if stepper.efforts[at].abs() >= limit {
                    self.saturated[at] += self.step;
                    keep(&mut self.out.saturated, self.saturated[at], joint.id, time);
                }
            }
        }
        self.see_coupled(stepper, time);
        let turn = stepper.base(0).rotation * self.start.rotation.inverse();
        // The angle of the turn about the vertical, when that is split off; of the whole turns that it may have the nearest.
        let heading = 2.0 * libm::atan2(turn.k, turn.w);
        self.out.heading += (heading - self.out.heading + PI).rem_euclid(TAU) - PI;
        self.out.lean = lean(&turn);
        self.out.lean_max = self.out.lean_max.max(self.out.lean);
        self.record(stepper, commands, time);
    }

    /// Keeps the moment `time` (s), if it is time for one.
    fn record(&mut self, stepper: &Stepper, commands: &Commands, time: f64) {
        if !self.recording.is_due(time, self.step) {
            return;
        }
        let window = self.history.len() as f64;
        let means: Vec<f64> = self.sums.iter().map(|sum| sum / window).collect();
        self.recording.see(stepper, commands, &means, time);
    }

    /// Measures the motors that drive several joints. The joint that is told is the first of them.
    fn see_coupled(&mut self, stepper: &Stepper, time: f64) {
        let window = self.history.len() as f64;
        for (number, coupled) in self.model.coupled.iter().enumerate() {
            let joint = |(body, _): &(usize, f64)| self.model.bodies[*body].joint.as_ref().map(|j| j.id);
            let Some(joint) = coupled.bodies.first().and_then(joint) else { continue };
            for (motor, saturated) in coupled.motors.iter().zip(&mut self.saturated_coupled[number]) {
                let terms = || coupled.bodies.iter().zip(&motor.shares);
                let of = |efforts: &[f64]| -> f64 {
                    terms().map(|((body, sign), share)| share * sign * efforts[*body]).sum()
                };
                if !motor.effort.is_finite() || motor.effort <= 0.0 {
                    continue;
                }
                keep(&mut self.out.effort, of(&self.sums).abs() / window / motor.effort, joint, time);
                if of(&stepper.efforts).abs() >= motor.effort * (1.0 - TOL_LIMIT) {
                    *saturated += self.step;
                    keep(&mut self.out.saturated, *saturated, joint, time);
                }
            }
        }
    }

    /// Returns what was measured, with the base where it is now; `duration`: that of the motion, s.
    pub(super) fn end(mut self, stepper: &Stepper, duration: f64) -> Simulation {
        self.out.duration = duration;
        let end = stepper.base(0);
        self.out.travel = end.translation.vector - self.start.translation.vector;
        let slid = stepper.slid().iter().zip(&self.slid).map(|(now, before)| now - before);
        self.out.slip = slid.fold(0.0, f64::max);
        self.out.drives = self.recording.drives;
        self.out.motion = self.recording.motion;
        self.out
    }
}
