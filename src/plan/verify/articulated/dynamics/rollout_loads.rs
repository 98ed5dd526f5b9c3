//! Loads along a rollout, with inertia and friction: of joints, motors and bonds against their limits, and of contacts
//! against the balance of the robot.

use super::super::in_force::positions;
use super::super::load_limits::{MotorWork, is_excused, keep_margin, note_open_motors};
use super::super::model::Model;
use super::super::rollout_input::Rollout;
use super::super::slope;
use super::super::statics::{Load, LoadKind, Structure, Wrench as LinkWrench};
use super::balance::{Balance, Imbalance};
use super::base_motions::{BaseVelocities, Instants};
use super::bursts::Bursts;
use super::deflection::{DeflectedMotion, deflected};
use super::elastic_tree::LimitedMotor;
use super::equilibrium::{self, Equilibrium, Warm};
use super::loads::{self, Loads};
use super::motors::{Rotor, fail_loose, gives_way, limit_in_motion, no_load_speeds, rotors};
use super::overload::MeanOverload;
use super::posed::Situation;
use super::recorder::{Recorded, Recorder};
use super::slide::Slide;
use super::tolerances::PARAMETERS;
use super::traction::{GroundTravel, TravelSummary};
use crate::geometry::Vec3;
use crate::interrupt;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure, Ground, Status, World, Worst};
use crate::robot::dynamics::Twist;
use crate::robot::{JointId, JointOwner};
use crate::units::{Dimension, number, quantity, rounded};
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// The number of instants for which velocities of the base are found while loads of those before are judged.
const INSTANTS_AHEAD: usize = 64;

/// The robot with bonds that hold, compiled for loads.
struct Compiled {
    structure: Structure,
    /// The rotors of motors whose inertia is stated.
    rotors: Vec<Rotor>,
}

/// The loads of a robot's joints, motors, bonds and contacts along a rollout under full dynamics, with inertia and
/// friction.
pub(in super::super) struct RolloutLoads<'a> {
    rollout: &'a Rollout<'a>,
    /// The instants at which loads are determined.
    instants: Instants<'a>,
    /// The travel of the whole rollout.
    travel: TravelSummary,
    bursts: Bursts,
    /// The speed without load of each joint's motor, by [`JointId`], rad/s or m/s.
    no_load: Vec<Option<f64>>,
    /// The robot with each set of bonds that held, by [`Recorded::bonds`].
    compiled: Vec<Compiled>,
    /// The velocity (m/s, rad/s) and acceleration (m/s², rad/s²) of the base's frame at each instant, as far as they are found, in the
    /// level axes of the instant.
    motions: Vec<(Twist, Twist)>,
}

/// The loads of one instant.
struct Loaded {
    /// The load at every cut of the structure, N or N·m.
    held: Vec<f64>,
    /// The effort of each joint, N·m or N.
    efforts: Vec<f64>,
    /// The deflection of each joint, rad or m.
    deflections: Vec<f64>,
    /// The forces of the ground, from the centre of mass in level axes.
    ground: Vec<LinkWrench>,
    /// The imbalance of the base, as in [`Loads`](super::loads::Loads).
    imbalance: f64,
    /// The angle by which the base leans, as there.
    lean: f64,
    /// The links that bear some of the weight, by their numbers.
    bearing: BTreeSet<usize>,
    /// True if loads and friction did not come to agree.
    open: bool,
    /// True if the inertial force is more than friction can carry.
    slides: bool,
}

/// The loads of an instant as if the robot were at rest.
struct AtRest {
    /// The loads without friction; `None` where they can't be found.
    frictionless: Option<Loaded>,
    /// The loads with friction; `None` where they can't be found.
    standing: Option<Loaded>,
    /// The words of how far the robot sags, once they are known.
    sag: OnceCell<String>,
}

impl<'a> RolloutLoads<'a> {
    /// Returns the loads along a rollout, whose attitudes `recorder` holds. It determines the motion of the base at
    /// all instants; the loads themselves are found where they are needed.
    pub(in super::super) fn new(rollout: &'a Rollout<'a>, recorder: Recorder) -> RolloutLoads<'a> {
        let mut loads = RolloutLoads::begun(rollout, recorder);
        let mut velocities = BaseVelocities::default();
        velocities.follow(&loads.instants, usize::MAX);
        loads.follow_base(&velocities);
        loads
    }

    /// Returns the loads along a rollout before any motion of the base is found.
    fn begun(rollout: &'a Rollout<'a>, recorder: Recorder) -> RolloutLoads<'a> {
        let robot = &rollout.tracks.robot;
        let models: Vec<Model> = recorder.bonds.iter().map(|bonds| Model::new(robot, bonds)).collect();
        let compile = |model| Compiled { structure: Structure::new(model), rotors: rotors(model) };
        let compiled = models.iter().map(compile).collect();
        let bursts = Bursts::new(rollout.tracks);
        RolloutLoads {
            rollout,
            instants: Instants::new(rollout, recorder.recorded, &bursts, models),
            travel: recorder.travel,
            bursts,
            no_load: no_load_speeds(robot),
            compiled,
            motions: vec![],
        }
    }

    /// Adds the motions of the base at further instants, as far as velocities lead to them.
    fn follow_base(&mut self, velocities: &BaseVelocities) {
        while let Some(motion) = velocities.motion(&self.instants, self.motions.len()) {
            self.motions.push(motion);
        }
    }

    /// Returns the loads of the instant of an index: with velocities and accelerations if `moving`, else as if the
    /// robot were at rest. `friction`: a factor on the friction of the world; `warm`: the guess, which becomes that of
    /// the next instant. `None` where the loads can't be found.
    fn loads(&self, index: usize, moving: bool, friction: f64, warm: &mut Warm) -> Option<Loaded> {
        let recorded = &self.instants.recorded[index];
        let Compiled { structure, rotors } = &self.compiled[recorded.bonds];
        let posed = self.instants.posed(index);
        let world = World { friction: recorded.world.friction * friction, ..recorded.world };
        let situation = match moving {
            true => Situation::moving(&posed, &world, &self.motions[index]),
            false => Situation::at_rest(&posed, &world),
        };
        let Equilibrium { loads, friction, open, slides, .. } = equilibrium::solve(&situation, None, warm)?;
        let zero = Vec3::zeros();
        let pushed = situation.candidates.iter().zip(&loads.normal).zip(&friction);
        let pushed = pushed.filter(|((_, normal), _)| **normal > 0.0).map(|((candidate, normal), (_, f))| {
            LinkWrench { link: candidate.link, p: candidate.p, f: f + Vec3::z() * *normal, m: zero }
        });
        let ground: Vec<LinkWrench> = pushed.collect();
        let wrenches: Vec<LinkWrench> = loads
            .wrenches
            .iter()
            .enumerate()
            .map(|(link, w)| LinkWrench { link, p: zero, f: -w.force, m: -w.moment })
            .collect();
        let mut held = structure.held(posed.model, &structure.sections_at(&posed.poses), &wrenches);
        let least = PARAMETERS.bearing_min * situation.weight;
        let bears = situation.candidates.iter().zip(&loads.normal).filter(|(_, normal)| **normal > least);
        let bearing = bears.map(|(candidate, _)| candidate.link).collect();
        let Loads { mut efforts, deflections, imbalance, lean, .. } = loads;
        for rotor in rotors.iter().filter(|_| moving) {
            let effort = rotor.inertia * posed.accelerations[rotor.joint];
            efforts[rotor.joint] += effort;
            held[rotor.cut] -= effort / rotor.factor;
        }
        Some(Loaded { held, efforts, deflections, ground, imbalance, lean, bearing, open, slides })
    }

    /// Returns the joint that sags most at an instant as if the robot stood still in it, with motors that bear no more
    /// than their limits, and its deflection, rad or m. `None` where no rest is found.
    fn sag(&self, index: usize) -> Option<(usize, f64)> {
        let recorded = &self.instants.recorded[index];
        let posed = self.instants.posed(index);
        let situation = Situation::at_rest(&posed, &recorded.world);
        let found = equilibrium::solve(&situation, None, &mut Warm::default())?;
        let forces: Vec<Vec3> = found.friction.iter().map(|(_, force)| *force).collect();
        let robot = &self.rollout.tracks.robot;
        let limited = |(joint, owner): (usize, JointOwner)| {
            let effort = robot.effort_limit(owner)?;
            Some(LimitedMotor { joint, deflection: effort / situation.stiffness[joint] })
        };
        let motors = robot.joints().enumerate().filter_map(limited).collect();
        let deflections = loads::sag(&situation, &forces, motors)?;
        let most = deflections.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some((most.0, most.1.abs()))
    }

    /// Returns true if `allows saturation` excuses an overload of a joint at an instant, because the robot then sags
    /// little, and marks it as needed. `sags_little`: whether it does at this instant, once that is known.
    fn is_saturated(
        &self,
        load: &Load,
        index: usize,
        sags_little: &OnceCell<bool>,
        ledger: &mut Ledger,
    ) -> bool {
        let time = self.instants.recorded[index].time;
        let of = |kind: &ExemptionKind| *kind == ExemptionKind::Saturation;
        let little = || self.sag(index).is_some_and(|(_, sag)| sag <= PARAMETERS.sag_allowed);
        matches!(load.kind, LoadKind::Joint { .. })
            && self.rollout.exemptions.iter().any(|e| of(&e.kind) && e.covers(time))
            && *sags_little.get_or_init(little)
            && ledger.excuses(CheckKind::Torque, time, of)
    }

    /// Returns (efforts, forces) at a time (s): the effort of each joint (N·m or N), by the number in its [`JointId`],
    /// interpolated between the instants about it; and the forces of the ground (N) at the nearer of them, from the
    /// centre of mass in level axes. Before the first instant and after the last they are those of that instant. `None`
    /// if they can't be found, or if no attitude was recorded.
    pub(in super::super) fn read(&self, time: f64) -> Option<(Vec<f64>, Vec<LinkWrench>)> {
        let recorded = &self.instants.recorded;
        let next = recorded.partition_point(|r| r.time <= time).clamp(1, recorded.len().max(1));
        let last = recorded.len().checked_sub(1)?;
        let (a, b) = (next - 1, next.min(last));
        let span = recorded[b].time - recorded[a].time;
        let part = if span > 0.0 { ((time - recorded[a].time) / span).clamp(0.0, 1.0) } else { 0.0 };
        let of = |index: usize| self.loads(index, true, 1.0, &mut Warm::default());
        let (from, to) = (of(a)?, of(b)?);
        let efforts = from.efforts.iter().zip(&to.efforts).map(|(x, y)| x + part * (y - x)).collect();
        Some((efforts, if part < 0.5 { from.ground } else { to.ground }))
    }

    /// Judges torque, loads of bonds, balance and traction at all instants of a rollout, whose attitudes `recorder` holds, and records
    /// the results and the work of the motors. `free`: a joint on which the robot may roll down a slope. Returns the motion of
    /// the joints as servos yield under these loads that are softer than stated by the factor `servo_softer`, and the instants at
    /// which the ground does not balance the base, whose failure the caller records.
    pub(in super::super) fn judge(
        rollout: &'a Rollout<'a>,
        recorder: Recorder,
        free: Option<&str>,
        ledger: &mut Ledger,
    ) -> (DeflectedMotion, Imbalance) {
        let mut loads = RolloutLoads::begun(rollout, recorder);
        let mut findings = Findings::default();
        let mut velocities = BaseVelocities::default();
        let mut recent = Recent::default();
        let mut judged = 0;
        // Loads take longer than the velocities of the base, which do not depend on them.
        while judged < loads.instants.recorded.len() {
            let known = judged..loads.motions.len();
            let (all, instants) = (&loads, &loads.instants);
            let mut judge = || {
                known.clone().for_each(|index| all.judge_instant(index, &mut recent, &mut findings, ledger));
            };
            let mut follow = || velocities.follow(instants, INSTANTS_AHEAD);
            match (known.is_empty(), loads.motions.len() == loads.instants.recorded.len()) {
                (true, _) => follow(),
                (false, true) => judge(),
                (false, false) => {
                    interrupt::join(judge, follow);
                }
            }
            judged = known.end;
            loads.follow_base(&velocities);
        }
        // Many joints are often overloaded at one instant.
        let mut at_rest: BTreeMap<usize, AtRest> = BTreeMap::new();
        for overload in &findings.overloads {
            let at_rest = at_rest.entry(overload.instant).or_insert_with(|| loads.at_rest(overload.instant));
            ledger.fail(loads.explained(overload, at_rest));
        }
        loads.finish(&findings, &velocities.slides, free, ledger);
        (findings.deflected, findings.balance.into_imbalance())
    }

    /// Judges the loads of the instant of an index, after those before it.
    fn judge_instant(&self, index: usize, recent: &mut Recent, found: &mut Findings, ledger: &mut Ledger) {
        interrupt::checkpoint();
        let recorded = &self.instants.recorded[index];
        let Recent { window, warm } = recent;
        if self.instants.begins(index) {
            *warm = Warm::default();
            window.clear();
        }
        found.instants += 1;
        let mut joints = Vec::new();
        positions(self.rollout, recorded.time, &mut joints);
        let loaded = self.loads(index, true, 1.0, warm);
        found.balance.follow(recorded.time, loaded.as_ref().map(|loaded| loaded.lean));
        let Some(loaded) = loaded else {
            found.unknown += 1;
            found.deflected.along.push(recorded.time, &joints);
            window.clear();
            return;
        };
        found.open += usize::from(loaded.open);
        self.hold_passive(index, &loaded, &mut found.loose);
        if loaded.slides {
            found.slides.get_or_insert(recorded.time);
        }
        if let Some((_, before, last)) = window.back() {
            let landed: Vec<usize> = loaded.bearing.difference(&last.bearing).copied().collect();
            self.note_impacts(*before, index, &landed, ledger);
        }
        match deflected(&joints, &loaded.deflections).filter(|_| !self.is_overloaded(index, &loaded)) {
            Some(deflected) => {
                found.deflected.instants += 1;
                found.deflected.along.push(recorded.time, &deflected);
            }
            // The plan's own positions stand for those of a robot that gives way: its links do not meet there.
            None => found.deflected.along.push(recorded.time, &joints),
        }
        found.work.add(joints, loaded.efforts.clone());
        window.push_back((recorded.time, index, loaded));
        while window.front().is_some_and(|(t, _, _)| recorded.time - t > self.instants.windows[index]) {
            window.pop_front();
        }
        self.compare(window, found, ledger);
    }

    /// Keeps the greatest speed with which links come down that bear at an instant and did not at the one before: the mean
    /// over at least 10 ms, and where the robot tips over √(3gh), that of the end of a uniform rod that falls over.
    fn note_impacts(&self, before: usize, index: usize, landed: &[usize], ledger: &mut Ledger) {
        let Recorded { time, tips, world, .. } = self.instants.recorded[index];
        let elapsed = (time - self.instants.recorded[before].time).max(PARAMETERS.spacing_least);
        let Some(stood) = (!landed.is_empty()).then(|| self.instants.posed(before)) else { return };
        let heights = stood.heights();
        for &link in landed.iter().filter(|link| heights[**link].is_finite()) {
            let speed = match tips {
                true => {
                    (3.0 * world.gravity * stood.height_of_landing(&self.instants.posed(index), link)).sqrt()
                }
                false => heights[link] / elapsed,
            };
            let known = &mut ledger.verdict.impact;
            if known.as_ref().is_none_or(|worst| speed > worst.value) {
                let name = self.rollout.tracks.robot.link_name(link);
                *known = Some(Worst { value: speed, time, at: vec![name] });
            }
        }
    }

    /// Returns true if a joint is overloaded at an instant, so that it does not yield like a spring.
    fn is_overloaded(&self, index: usize, loaded: &Loaded) -> bool {
        let structure = &self.compiled[self.instants.recorded[index].bonds].structure;
        let over = |load: &Load| structure.size(load, &loaded.held) > load.limit;
        structure.loads.iter().any(|load| matches!(load.kind, LoadKind::Joint { .. }) && over(load))
    }

    /// Keeps the first joint without a motor that gives way under the weight, with its time (s): nothing but friction holds it
    /// at an instant.
    fn hold_passive(&self, index: usize, loaded: &Loaded, loose: &mut Option<(f64, usize)>) {
        let robot = &self.rollout.tracks.robot;
        if loose.is_some() || gives_way(robot, &loaded.deflections).is_none() {
            return;
        }
        let at_rest = self.loads(index, false, 0.0, &mut Warm::default());
        let joint = at_rest.and_then(|at_rest| gives_way(robot, &at_rest.deflections));
        *loose = joint.map(|joint| (self.instants.recorded[index].time, joint));
    }

    /// Compares the mean loads over a window, of instants as (time in s, index, loads), with their limits, and the mean
    /// imbalance of the base with `imbalance_max`.
    fn compare(&self, window: &VecDeque<(f64, usize, Loaded)>, found: &mut Findings, ledger: &mut Ledger) {
        let count = window.len() as f64;
        let (time, middle, _) = &window[window.len() / 2];
        let structure = &self.compiled[self.instants.recorded[*middle].bonds].structure;
        let cuts = window[0].2.held.len();
        let mean: Vec<f64> =
            (0..cuts).map(|cut| window.iter().map(|(_, _, l)| l.held[cut]).sum::<f64>() / count).collect();
        let sags_little = OnceCell::new();
        for (index, load) in structure.loads.iter().enumerate() {
            let value = structure.size(load, &mean);
            let rates = || self.instants.posed(*middle).velocities;
            let limit = limit_in_motion(&self.no_load, load, &mean, rates);
            let ratio = value / limit;
            keep_margin(load, ratio, *time, ledger);
            if ratio <= 1.0 - self.rollout.settings.reserve
                || is_excused(load, *time, ledger)
                || self.is_saturated(load, *middle, &sags_little, ledger)
            {
                continue;
            }
            match found.overloads.iter_mut().find(|over| over.overload.is_of(load)) {
                Some(over) => over.grow(value, *time, *middle),
                None => found.overloads.push(MeanOverload::new(load, index, (value, limit), *time, *middle)),
            }
        }
        let imbalance = window.iter().map(|(_, _, l)| l.imbalance).sum::<f64>() / count;
        found.balance.compare(*time, imbalance, self.bursts.near_step(*time), ledger);
    }

    /// Returns the failure of an overload, with its shares by origin.
    fn explained(&self, overload: &MeanOverload, at_rest: &AtRest) -> Failure {
        let structure = &self.compiled[self.instants.recorded[overload.instant].bonds].structure;
        let load = &structure.loads[overload.load];
        let size = |loaded: &Option<Loaded>| Some(structure.size(load, &loaded.as_ref()?.held));
        let shares = size(&at_rest.frictionless).zip(size(&at_rest.standing));
        let mut failure = overload.failure(shares, self.rollout.settings.reserve);
        let gives_way = shares.is_some_and(|(_, standing)| standing > load.limit);
        if gives_way && matches!(load.kind, LoadKind::Joint { .. }) {
            failure.message += at_rest.sag.get_or_init(|| self.sag_words(overload.instant));
        }
        failure
    }

    /// Returns the loads of the instant of an index as if the robot were at rest.
    fn at_rest(&self, index: usize) -> AtRest {
        let loads = |friction| self.loads(index, false, friction, &mut Warm::default());
        // Without friction nothing holds the robot in place, but nothing moves it either: it stands still.
        AtRest { frictionless: loads(0.0), standing: loads(1.0), sag: OnceCell::new() }
    }

    /// Notes a margin of torque that is smaller than the error of the loads.
    fn note_small_margin(&self, ledger: &mut Ledger) {
        let known = ledger.verdict.torque_margin.as_ref();
        if let Some(worst) = known.filter(|w| (0.0..PARAMETERS.load_error).contains(&w.value)) {
            let note = format!(
                "loads are known within some {} %: {} keeps {} of its limit at {}, and may reach it",
                number(100.0 * PARAMETERS.load_error),
                worst.at.join(", "),
                rounded(worst.value, 3),
                quantity(worst.time, Dimension::TIME)
            );
            ledger.note(note);
        }
    }

    /// Returns in words how far the robot would sag at an instant.
    fn sag_words(&self, index: usize) -> String {
        let robot = &self.rollout.tracks.robot;
        match self.sag(index).filter(|(_, sag)| *sag <= PARAMETERS.deflection_max) {
            None => "; it would give way".to_owned(),
            Some((joint, sag)) => {
                let owner = robot.joints().nth(joint).expect("a joint of the robot");
                let dimension = if robot.slides(owner) { Dimension::LENGTH } else { Dimension::ANGLE };
                let name = robot.joint_name(owner);
                format!("; with its motors at their limits, {name} would sag by {}", quantity(sag, dimension))
            }
        }
    }

    /// Judges if friction and servos determine the travel: its end must not move by more than the part
    /// `travel_undetermined` of it under a variation, and if by more than `travel_uncertain`, it is known within
    /// that only.
    fn travel(&self, ledger: &mut Ledger) {
        let differs = |travel: &GroundTravel, part: f64, least: f64| {
            travel.away > part * travel.length && travel.away > least
        };
        let undetermined = |travel: &GroundTravel| {
            differs(travel, PARAMETERS.travel_undetermined, PARAMETERS.travel_undetermined_min)
        };
        let TravelSummary { judged, allowed, allowed_by } = &self.travel;
        if undetermined(allowed) {
            allowed_by.iter().for_each(|&index| ledger.use_exemption(index, CheckKind::Traction));
        }
        let [length, away] = [judged.length, judged.away].map(|v| quantity(v, Dimension::LENGTH));
        if undetermined(judged) {
            ledger.fail(Failure {
                kind: CheckKind::Traction,
                time: 0.0,
                until: Some(self.rollout.tracks.duration),
                at: vec![],
                message: format!(
                    "the travel is not determined: {length}, but {away} elsewhere {}",
                    judged.variation.words()
                ),
                value: judged.away,
                limit: PARAMETERS.travel_undetermined * judged.length,
                blame: vec![],
                blames_start: false,
            });
        } else if differs(judged, PARAMETERS.travel_uncertain, PARAMETERS.travel_uncertain_min) {
            ledger.verdict.travel_within = Some(judged.away);
            ledger.note(format!(
                "the travel of {length} would end {away} elsewhere {}",
                judged.variation.words()
            ));
        }
    }

    /// Writes the findings of all instants into the verdict: the work, failures, notes, and the status of each check. `slides`: the
    /// instants at which the robot slides down a slope; `free`: a joint on which it may roll down one.
    fn finish(&self, found: &Findings, slides: &[Slide], free: Option<&str>, ledger: &mut Ledger) {
        ledger.verdict.energy = found.work.energy();
        if let Some((time, joint)) = found.loose {
            fail_loose(&self.rollout.tracks.robot, joint, time, ledger);
        }
        self.travel(ledger);
        Slide::judge(slides, ledger);
        self.note_small_margin(ledger);
        if let Some(step) = self.bursts.steps().first() {
            let name = self.rollout.tracks.robot.name_of(JointId(step.joint as u32));
            let more = self.bursts.steps().len() - 1;
            ledger.note(format!(
                "{name} changes its speed at once at {}{}: its torque is judged as if over {}",
                quantity(step.time, Dimension::TIME),
                if more > 0 { format!(" (and {more} more)") } else { String::new() },
                quantity(self.bursts.window(step.time), Dimension::TIME)
            ));
        }
        if let Some(time) = found.slides {
            ledger.note(format!(
                "from {} on the motion needs more friction than there is: the robot slides",
                quantity(time, Dimension::TIME)
            ));
        }
        if found.open > 0 {
            ledger.note(format!(
                "at {} of {} instants loads and friction did not come to agree: several answers are possible",
                found.open, found.instants
            ));
        }
        let sampled = |stated: bool| match found.instants {
            _ if found.unknown > 0 => Status::NotChecked(format!(
                "at {} of {} instants no loads were found",
                found.unknown, found.instants
            )),
            _ if !stated => Status::NoLimit,
            instants => Status::Sampled(instants),
        };
        let structures = self.compiled.iter().map(|compiled| &compiled.structure);
        for check in [CheckKind::Torque, CheckKind::BondLoad] {
            let stated = structures.clone().any(|structure| structure.has_limits(check));
            ledger.check(check, sampled(stated));
        }
        let settles = self.instants.recorded.iter().any(|instant| instant.world.ground == Ground::Settle);
        let balance = match (settles, found.balance.stepped) {
            (false, _) => Status::NotChecked("nothing stands on the ground by itself".to_owned()),
            (true, true) => Status::NotChecked("a step of velocity may lift the robot".to_owned()),
            (true, false) => sampled(true),
        };
        ledger.check(CheckKind::Balance, balance);
        let traction = match settles {
            true => slope::rolls(free, sampled(true)),
            false => Status::NotChecked("the base is not carried by the ground".to_owned()),
        };
        ledger.check(CheckKind::Traction, traction);
        note_open_motors(structures, ledger);
    }
}

/// The results of the instants just before one, which its judgement takes.
#[derive(Default)]
struct Recent {
    /// The loads of the instants within the window of the last: (time in s, index, loads).
    window: VecDeque<(f64, usize, Loaded)>,
    warm: Warm,
}

/// Findings from instant to instant.
#[derive(Default)]
struct Findings {
    /// The number of instants.
    instants: usize,
    /// The number of instants at which no loads were found.
    unknown: usize,
    /// The number of instants at which loads and friction did not come to agree.
    open: usize,
    /// The first time at which friction can't carry the inertial force, s.
    slides: Option<f64>,
    balance: Balance,
    /// The first time (s) at which a joint without a motor gives way, by its [`JointId`].
    loose: Option<(f64, usize)>,
    overloads: Vec<MeanOverload>,
    work: MotorWork,
    deflected: DeflectedMotion,
}
