//! Quasi-static loads of joints, motors and bonds, compared with their limits.
//!
//! First with the loads that the ground takes without friction: if nothing is overloaded with those, forces exist.
//! Loads whose far side touches nothing are the same under all forces. The best contact forces are sought only for
//! others, and only if the first answer is no.

use super::contact::ContactPoint;
use super::contact_forces::{ContactForces, ContactQuery, WarmStart};
use super::fixed_base::BetweenSamples;
use super::load_limits::{MotorWork, Overload, is_excused, keep_margin, note_open_motors};
use super::model::Model;
use super::rollout_input::Rollout;
use super::sample::Sample;
use super::statics::{LoadKind, Section, Structure, Wrench, effects};
use super::tolerances::{NUMERICS, Tolerances};
use crate::geometry::Vec3;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Ground, Status};
use crate::units::{Dimension, quantity};

/// The monitor of quasi-static loads during a rollout, which compares them with their limits at each sample.
pub(super) struct Monitor<'a> {
    tolerances: &'a Tolerances,
    /// The cuts and loads for the bonds that hold; `None` before the first sample.
    compiled: Option<Compiled>,
    /// The loads over their limits at the last sample that moved, by index, with their ratios to them.
    over: Vec<(usize, f64)>,
    /// The overloads so far: one for each load.
    failures: Vec<Overload>,
    /// The contact forces found last: for joints and motors, and for bonds.
    warm_starts: [WarmStart; 2],
    work: MotorWork,
    /// The number of samples with weight and ground.
    samples: usize,
    /// The number of samples at which the forces of the ground do not carry the robot, so that loads are unknown.
    unknown: usize,
    /// The size of all LPs solved so far, columns and loads.
    effort: usize,
    /// The number of times that the existence of forces that overload nothing was not decided.
    undecided: usize,
    /// The worst time at which evenly distributed contact forces would overload something, and others do not.
    uneven: Option<UnevenForces>,
    /// True if loads were bounded between the samples, too.
    proved: bool,
    /// The grounds of the decision about the joints of the sample, for those who read it.
    decided: Option<Decided>,
}

/// The grounds of the decision about the torques of one sample.
#[derive(Default)]
struct Decided {
    /// The best contact forces, where evenly spread ones would overload a joint.
    best: Option<ContactForces>,
    /// True if no forces were found that decide it.
    open: bool,
    /// True if joints are overloaded whatever the forces are.
    sure: bool,
}

/// The efforts of the joints at one sample, and the forces of the ground with which they were judged.
pub(super) struct JudgedLoads {
    /// The force or torque that a motor supplies at each joint, by the number in its `JointId`, N or N·m; `None` where
    /// it is not known.
    pub efforts: Vec<Option<f64>>,
    /// The forces of the ground on links (N), at points from the centre of mass in level axes (m); `None` where they
    /// are not known.
    pub forces: Option<Vec<Wrench>>,
}

/// The cuts and loads of a robot, compiled for the bonds that hold.
struct Compiled {
    /// A flag for each bond, true if it holds.
    bonds: Vec<bool>,
    structure: Structure,
    /// The cuts that each joint loads, as [`effects`] returns them.
    effects: Vec<Vec<(usize, f64)>>,
}

/// The note where the best forces found are too great, and yet no proof was found that there are none.
const UNDECIDED: &str =
    "an overload was not proved: the best contact forces found are within rounding of the limit";

/// A time at which evenly distributed contact forces would overload something.
struct UnevenForces {
    /// The time of the sample, s.
    time: f64,
    /// The name of the load that is then greatest.
    name: String,
    /// The greatest load as a fraction of its limit with even forces without friction.
    even: f64,
    /// The greatest load as a fraction of its limit with the best forces.
    best: f64,
    /// True if no forces without friction were found that overload nothing.
    needs_friction: bool,
}

/// The factor by which another such time must be worse to be examined.
const UNEVEN_STEP: f64 = 1.1;

/// The loads of one stance.
struct Loads {
    /// The ratio of load to limit, of all loads.
    ratios: Vec<f64>,
    /// The load at every cut, N or N·m.
    held: Vec<f64>,
    /// The loads that are judged, by index: those that are known.
    judged: Vec<usize>,
    /// True if the forces of the ground carry the robot.
    balanced: bool,
}

impl<'a> Monitor<'a> {
    /// Returns a monitor before the first sample.
    pub(super) fn new(tolerances: &'a Tolerances) -> Monitor<'a> {
        Monitor {
            tolerances,
            compiled: None,
            over: vec![],
            failures: vec![],
            warm_starts: Default::default(),
            work: MotorWork::default(),
            samples: 0,
            unknown: 0,
            effort: 0,
            undecided: 0,
            uneven: None,
            proved: false,
            decided: None,
        }
    }

    /// Returns the loads of a sample as they are judged: with the ground's forces spread evenly and without friction,
    /// or with the best ones if those would overload a joint. `None` without gravity, and where the robot floats.
    pub(super) fn read(&mut self, sample: &Sample, ledger: &mut Ledger) -> Option<JudgedLoads> {
        if sample.world.gravity == 0.0 || sample.world.ground == Ground::Off {
            return None;
        }
        self.decided = Some(Decided::default());
        self.effort = 0;
        self.compile(sample);
        self.weigh(sample, ledger);
        let decided = self.decided.take()?;
        let Compiled { structure, effects, .. } = self.compiled.as_ref()?;
        let even = loads(structure, sample, &structure.sections(sample.stance), self.tolerances);
        let closed = decided.best.is_some() || (even.balanced && !decided.open && !decided.sure);
        let known = determinate_cuts(structure, sample, even.balanced, self.tolerances);
        let held = decided.best.as_ref().map_or(&even.held, |best| &best.held);
        let effort = |joint: usize| {
            let known = closed || effects[joint].iter().all(|&(cut, _)| known(cut));
            // The best forces of loops load the hinges that close them, too.
            let known = known && (decided.best.is_none() || !structure.closes_by(joint));
            known.then(|| structure.joint_effort(joint, held, effects))
        };
        let efforts = (0..sample.joints.len()).map(effort).collect();
        let weight = sample.model.mass * sample.world.gravity;
        let up = sample.stance.up();
        let spread = || pushing(sample).filter(|t| t.load > 0.0).map(|t| push(t, &up, weight)).collect();
        let forces = closed.then(|| decided.best.map_or_else(spread, |best| best.of_ground()));
        Some(JudgedLoads { efforts, forces })
    }

    /// Takes a sample, in order of time: compares its loads with their limits, and gathers overloads that no
    /// exemption excuses. Does nothing without gravity, and where the robot floats.
    pub(super) fn observe(&mut self, sample: &Sample, ledger: &mut Ledger) {
        if sample.world.gravity == 0.0 || sample.world.ground == Ground::Off {
            self.over.clear();
            return;
        }
        self.samples += 1;
        if sample.moved || self.compiled.is_none() {
            self.compile(sample);
            self.weigh(sample, ledger);
        }
        self.record(sample, ledger);
    }

    /// Compiles cuts and loads anew if the bonds that hold are others.
    fn compile(&mut self, sample: &Sample) {
        if self.compiled.as_ref().is_none_or(|c| c.bonds != sample.bonds) {
            let structure = Structure::new(sample.model);
            let effects = effects(sample.model);
            self.compiled = Some(Compiled { bonds: sample.bonds.to_vec(), structure, effects });
        }
    }

    /// Compares the loads of a sample with their limits.
    fn weigh(&mut self, sample: &Sample, ledger: &mut Ledger) {
        // Taken out while it is used, so that the rest can be written to.
        let Some(compiled) = self.compiled.take() else { return };
        self.compare_loads(sample, &compiled, ledger);
        self.compiled = Some(compiled);
    }

    /// Compares the loads of joints and bonds in one sample with their limits: by a feasible guess, else for
    /// statically determinate loads, else by the LP of contact forces.
    fn compare_loads(&mut self, sample: &Sample, compiled: &Compiled, ledger: &mut Ledger) {
        let structure = &compiled.structure;
        // Loads of the normal forces without friction (a feasible guess, not an optimum).
        let sections = structure.sections(sample.stance);
        let gravity_wrenches = weights(sample);
        let weights = structure.held(sample.model, &sections, &gravity_wrenches);
        let loads = loads(structure, sample, &sections, self.tolerances);
        if loads.judged.len() < structure.loads.len() {
            self.unknown += 1;
        }
        let effort = |joint| structure.joint_effort(joint, &loads.held, &compiled.effects);
        self.work.add(sample.joints.to_vec(), (0..sample.joints.len()).map(effort).collect());
        self.over.clear();
        // Joints and motors first, then bonds: each has a margin of its own.
        for (slot, check) in [CheckKind::Torque, CheckKind::BondLoad].into_iter().enumerate() {
            let bonds = check == CheckKind::BondLoad;
            let own = |i: &usize| structure.loads[*i].kind.check() == check;
            let judged: Vec<usize> = loads.judged.iter().copied().filter(own).collect();
            let Some(worst) = greatest(&judged, |i| loads.ratios[i]) else { continue };
            // Feasible already: these forces exist, and overload nothing.
            if loads.ratios[worst] <= 1.0 {
                keep_margin(&structure.loads[worst], loads.ratios[worst], sample.time, ledger);
                continue;
            }
            // Otherwise a query for the best contact forces.
            let query = ContactQuery {
                model: sample.model,
                structure,
                stance: sample.stance,
                sections: &sections,
                gravity_wrenches: &gravity_wrenches,
                weights: &weights,
                loads: &judged,
                weight: sample.model.mass * sample.world.gravity,
                friction: sample.world.friction,
                fixed_base: sample.world.ground == Ground::Held,
                tolerances: self.tolerances,
            };
            // Statically determinate loads over their limits need no LP: no contact forces change them.
            let sure = determinate_loads(structure, sample, &judged, true, self.tolerances);
            let sure = greatest(&sure, |i| loads.ratios[i]).filter(|&i| loads.ratios[i] > 1.0);
            let seen = if bonds { &ledger.verdict.bond_margin } else { &ledger.verdict.torque_margin };
            let seen = seen.as_ref().map_or(0.0, |w| 1.0 - w.value);
            let best = match sure {
                Some(_) => None,
                None => best(&query, &mut self.warm_starts[slot], seen, &mut self.effort),
            };
            if let (Some(decided), false) = (&mut self.decided, bonds) {
                (decided.open, decided.sure) = (sure.is_none() && best.is_none(), sure.is_some());
                decided.best.clone_from(&best);
            }
            // Neither determinate nor solved: the sample is undecided.
            if sure.is_none() && best.is_none() {
                self.undecided += 1;
                continue;
            }
            // Feasible contact forces settle it; otherwise the overloads are recorded.
            match best {
                Some(best) if best.ratio <= 1.0 => {
                    keep_margin(&structure.loads[best.load], best.ratio, sample.time, ledger);
                    self.uneven(sample.time, query, (worst, loads.ratios[worst]), &best);
                }
                best => {
                    if best.as_ref().is_some_and(|b| b.bound <= 1.0) {
                        ledger.note(UNDECIDED.to_owned());
                    }
                    let (load, ratio) = best
                        .map_or((sure.unwrap_or(worst), loads.ratios[sure.unwrap_or(worst)]), |b| {
                            (b.load, b.ratio)
                        });
                    keep_margin(&structure.loads[load], ratio, sample.time, ledger);
                    let all = judged.iter().copied().filter(|&i| sure.is_some() && loads.ratios[i] > 1.0);
                    let sures: Vec<_> = all.map(|i| (i, loads.ratios[i])).collect();
                    self.over.extend(if sures.is_empty() { vec![(load, ratio)] } else { sures });
                }
            }
        }
    }

    /// Records the greatest load that even contact forces would make, unless one nearly as great is known, with a flag
    /// for the need of friction.
    fn uneven(&mut self, time: f64, query: ContactQuery, worst: (usize, f64), best: &ContactForces) {
        if self.uneven.as_ref().is_some_and(|u| worst.1 <= UNEVEN_STEP * u.even) {
            return;
        }
        let name = query.structure.loads[worst.0].name.clone();
        let slippery = ContactQuery { friction: 0.0, ..query };
        let needs_friction = slippery.minimise_peak_load().is_none_or(|b| b.ratio > 1.0);
        self.uneven = Some(UnevenForces { time, even: worst.1, best: best.ratio, name, needs_friction });
    }

    /// Takes the present overloads into the failures, unless an exemption excuses them.
    fn record(&mut self, sample: &Sample, ledger: &mut Ledger) {
        let Some(compiled) = &self.compiled else { return };
        for &(index, ratio) in &self.over {
            let load = &compiled.structure.loads[index];
            if is_excused(load, sample.time, ledger) {
                continue;
            }
            let value = ratio * load.limit;
            match self.failures.iter_mut().find(|f| f.is_of(load)) {
                Some(failure) => {
                    failure.grow(value, sample.time);
                }
                None => self.failures.push(Overload::new(load, value, sample.time)),
            }
        }
    }

    /// Takes in the result about the time between samples: it may prove the check, or add an overload if no sample
    /// had one.
    pub(super) fn between(&mut self, between: &BetweenSamples, rollout: &Rollout) {
        self.proved = *between == BetweenSamples::Proved;
        if let (BetweenSamples::Over { time, load, ratio }, true) = (between, self.failures.is_empty()) {
            let model = Model::new(&rollout.tracks.robot, &rollout.tracks.bonds(*time));
            let load = &Structure::new(&model).loads[*load];
            self.failures.push(Overload::new(load, ratio * load.limit, *time));
        }
    }

    /// Returns the overloads found, one for each load, in order of their first time.
    pub(super) fn overloaded(&self) -> &[Overload] {
        &self.failures
    }

    /// Records in the verdict the energy that the motors spend (J), notes on forces that must be uneven, and the
    /// status of the checks of torque and bond loads.
    pub(super) fn finish(&self, ledger: &mut Ledger) {
        ledger.verdict.energy = self.work.energy();
        if let Some(uneven) = &self.uneven {
            let (time, name) = (quantity(uneven.time, Dimension::TIME), &uneven.name);
            let ratios = format!("{:.2} of its limit", uneven.even);
            ledger.note(match uneven.needs_friction {
                true => {
                    format!("at {time} {name} needs friction: {ratios} without, {:.2} at best with it", uneven.best)
                }
                false => format!(
                    "at {time} {name} would hold {ratios} if the ground's forces were spread evenly, {:.2} at best",
                    uneven.best
                ),
            });
        }
        if self.unknown > 0 {
            ledger.note(format!(
                "at {} samples the ground does not carry the robot: only what touches nothing was weighed",
                self.unknown
            ));
        }
        let structure = self.compiled.as_ref().map(|compiled| &compiled.structure);
        let stated = |check| structure.is_some_and(|structure| structure.has_limits(check));
        let status = |check| match (self.samples, stated(check)) {
            (0, _) => Status::NotChecked("nothing is weighed without gravity and a ground".to_owned()),
            (_, false) => Status::NoLimit,
            (samples, true) if self.undecided > 0 => Status::NotChecked(format!(
                "at {} of {samples} samples it was not decided whether contact forces exist that overload nothing",
                self.undecided
            )),
            (_, true) if self.proved => Status::Proved,
            (samples, true) => Status::Sampled(samples),
        };
        note_open_motors(structure.into_iter(), ledger);
        for check in [CheckKind::Torque, CheckKind::BondLoad] {
            ledger.check(check, status(check));
        }
    }
}

/// Computes the loads of joints at samples without judging them, for curves and drawings.
#[derive(Default)]
pub(super) struct LoadGauge {
    compiled: Option<Compiled>,
}

impl LoadGauge {
    /// Returns the ratio of load to limit of every joint or motor that states one, with the ground's forces spread
    /// evenly and without friction, as (number of the joint in its `JointId`, ratio). Empty without gravity, and
    /// where the robot floats.
    pub(super) fn read(&mut self, sample: &Sample, tolerances: &Tolerances) -> Vec<(usize, f64)> {
        if sample.world.gravity == 0.0 || sample.world.ground == Ground::Off {
            return vec![];
        }
        if self.compiled.as_ref().is_none_or(|c| c.bonds != sample.bonds) {
            let structure = Structure::new(sample.model);
            let bonds = sample.bonds.to_vec();
            self.compiled = Some(Compiled { bonds, structure, effects: effects(sample.model) });
        }
        let Some(Compiled { structure, .. }) = &self.compiled else { return vec![] };
        let found = loads(structure, sample, &structure.sections(sample.stance), tolerances);
        let of_joint = structure.loads.iter().zip(found.ratios).filter_map(|(load, ratio)| match load.kind {
            LoadKind::Joint { joint, .. } => Some((joint, ratio)),
            LoadKind::Pull | LoadKind::Moment => None,
        });
        of_joint.collect()
    }
}

/// Returns true if the load of this name is over its limit in a sample and no exemption excuses it.
pub(super) fn overloaded(sample: &Sample, name: &str, tolerances: &Tolerances, ledger: &mut Ledger) -> bool {
    let mut observe = Monitor::new(tolerances);
    observe.observe(sample, ledger);
    observe.failures.iter().any(|f| f.name == name)
}

/// The size of LPs (columns and loads) that are solved for the sake of an exact margin; after that only if the
/// existence of forces is open. About 500 LPs of a walker of 15 modules, 20 of a snake of 300.
const EFFORT_FOR_MARGIN: usize = 60_000;

/// Returns the best forces: those found last, brought to balance here, do if their greatest load, as a fraction of its
/// limit, is at most `seen`, the greatest so far, or after much work at most 1; otherwise those of an LP. `None` if
/// neither gives forces. `effort` grows by the size of the LP.
fn best(
    query: &ContactQuery,
    warm_start: &mut WarmStart,
    seen: f64,
    effort: &mut usize,
) -> Option<ContactForces> {
    // After much work, forces that will do are enough, and the margin is that of these.
    let enough = if *effort < EFFORT_FOR_MARGIN { seen.min(1.0) } else { 1.0 };
    if let Some(again) = query.warm_started(warm_start).filter(|again| again.ratio <= enough) {
        return Some(again);
    }
    *effort += query.lp_size();
    let best = query.minimise_peak_load()?;
    *warm_start = best.warm_start.clone();
    Some(best)
}

/// Returns the weights of all links, in level axes from the centre of mass.
fn weights(sample: &Sample) -> Vec<Wrench> {
    let (model, stance) = (sample.model, sample.stance);
    let push = |&link: &usize| {
        let body = &model.bodies[link];
        let posture = &stance.posture;
        let p = stance.R * (posture.R[link] * body.com + posture.p[link] - posture.centre);
        let f = stance.down() * (body.mass * sample.world.gravity);
        Wrench { link, p, f, m: Vec3::zeros() }
    };
    model.attached.iter().map(push).collect()
}

/// Returns the contact points at which the ground may push.
fn pushing<'s>(sample: &Sample<'s>) -> impl Iterator<Item = &'s ContactPoint> {
    let fixed_base = sample.world.ground == Ground::Held;
    sample.stance.contact_points.iter().filter(move |_| !fixed_base)
}

/// Returns the loads without friction, with normal forces as they are distributed.
fn loads(structure: &Structure, sample: &Sample, sections: &[Section], tolerances: &Tolerances) -> Loads {
    let weight = sample.model.mass * sample.world.gravity;
    let mut wrenches = weights(sample);
    let (up, foot) = (sample.stance.up(), sample.stance.foot());
    let (mut x, mut y, mut size) = (0.0, 0.0, NUMERICS.robot_size);
    for contact_point in pushing(sample).filter(|t| t.load > 0.0) {
        wrenches.push(push(contact_point, &up, weight));
        let [px, py] = [contact_point.p.x - foot[0], contact_point.p.y - foot[1]];
        (x, y) = (x + contact_point.load * px, y + contact_point.load * py);
        size = size.max(contact_point.p.norm());
    }
    let held = structure.held(sample.model, sections, &wrenches);
    let ratios = structure.loads.iter().map(|load| structure.size(load, &held) / load.limit).collect();
    let all: Vec<usize> = (0..structure.loads.len()).collect();
    // A base fixed in the world is balanced by its fixture, whatever loops carry.
    let balanced = match sample.world.ground {
        Ground::Held => true,
        _ => libm::hypot(x, y) <= tolerances.balance * size && !sample.stance.held,
    };
    let judged = if balanced { all } else { determinate_loads(structure, sample, &all, false, tolerances) };
    Loads { ratios, held, judged, balanced }
}

/// Returns the force at a contact point against gravity, whose opposite direction is `up`: without friction on level
/// ground, and on a slope with as much of it as holds the robot.
fn push(contact_point: &ContactPoint, up: &Vec3, weight: f64) -> Wrench {
    let f = up * (contact_point.load * weight);
    Wrench { link: contact_point.link, p: contact_point.p, f, m: Vec3::zeros() }
}

/// Returns those of some loads that no forces of the ground can change: nothing beyond their cuts, or
/// everything, touches it, and no loop passes through them.
fn determinate_loads(
    structure: &Structure,
    sample: &Sample,
    loads: &[usize],
    balanced: bool,
    tolerances: &Tolerances,
) -> Vec<usize> {
    let settled = determinate_cuts(structure, sample, balanced, tolerances);
    let all = |index: &usize| {
        let load = &structure.loads[*index];
        load.closing.is_none() && load.terms.iter().all(|&(cut, _)| settled(cut))
    };
    loads.iter().copied().filter(all).collect()
}

/// Returns a function that is true of a cut if no forces of the ground can change the load that it holds.
fn determinate_cuts<'s>(
    structure: &'s Structure,
    sample: &Sample,
    balanced: bool,
    tolerances: &Tolerances,
) -> impl Fn(usize) -> bool + use<'s> {
    let touching = pushing(sample).filter(|t| t.gap <= tolerances.gap_loaded).map(|t| t.link);
    let near = structure.in_tree_order(touching);
    move |cut| {
        let at = structure.cut_link(cut);
        let beyond = structure.count_beyond(at, &near);
        let looped = |&(_, a, b): &(usize, usize, usize)| structure.beyond(at, a) != structure.beyond(at, b);
        (beyond == 0 || (beyond == near.len() && balanced)) && !structure.closing.iter().any(looped)
    }
}

/// Returns the index of the load with the greatest ratio, the first of equal ones; `None` without loads.
fn greatest(loads: &[usize], ratio: impl Fn(usize) -> f64) -> Option<usize> {
    loads.iter().copied().reduce(|w, i| if ratio(i) > ratio(w) { i } else { w })
}
