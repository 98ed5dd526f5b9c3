//! The forces in struts and contacts that hold a truss under its weight: the best distribution that there is, and the
//! elastic one.
//!
//! Equilibrium at the ends and in the middle of every linear step, at rest and with the inertia of nodes that accelerate
//! (d'Alembert), on the nodes that stay on the ground all the way of it.
//! Forces are in equilibrium at every node with half the weight of each of its struts; contacts push, within a pyramid
//! inside the friction cone. *The best distribution* is the one whose greatest force, as a part of what a strut bears,
//! is least, over all self-stresses that the motors may give the truss: a linear program (LP), which is solved where a
//! bound does not decide, and whose solution is checked again here. *The elastic distribution* is that of struts as
//! stiff as they are short, without stress when nothing pulls, on ground as stiff as a strut.

use super::judgement::{Judgement, Step};
use super::support::StabilityMonitor;
use crate::geometry::Vec3;
use crate::optimize::{LinearProgram, Row, solve_linear_program};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Exemption, ExemptionKind, Failure, Interpolation, Status, World};
use crate::robot::truss_statics::{Contact, FRICTION, ForceModel, Weights};
use crate::units::{Dimension, quantity};

/// The number of edges of the pyramid inside a friction cone.
const EDGES: usize = 8;
/// The number of times that the weights of struts are levelled before the LP is asked.
const LEVELLINGS: usize = 6;
/// The number of nodes above which only some keyframes are looked at.
const NODES_ALL: usize = 200;
/// The number of keyframes of a larger truss that are looked at.
const KEYFRAMES_LARGE: usize = 10;

/// The monitor of the forces that hold a truss from step to step.
pub(super) struct LoadMonitor<'a> {
    /// The weights of struts for the best distribution, which go on from one instant to the next.
    weights: Weights,
    /// The instants looked at.
    pub samples: usize,
    /// The greatest of the least greatest forces so far, as a part of what the strut bears.
    worst: f64,
    /// The forces beyond what struts bear where the plan is not excused, and where it is.
    beyond: [Option<Beyond>; 2],
    /// The exemptions of the plan.
    exemptions: &'a [Exemption],
}

/// Forces beyond what struts bear, with the best distribution at every instant.
struct Beyond {
    /// The first of them as a failure, without words and values: its time, and who is to blame.
    first: Failure,
    /// The strut of the greatest: its name.
    strut: String,
    /// The time of the greatest, s.
    time: f64,
    /// The greatest.
    best: Best,
}

/// Forces that hold a truss, found by the LP.
struct Best {
    /// The greatest force of a strut as a part of what it bears.
    ratio: f64,
    /// The strut of that force.
    strut: usize,
    /// The greatest force, N.
    force: f64,
}

impl<'a> LoadMonitor<'a> {
    /// Returns a monitor before the first step of a plan with these exemptions.
    pub(super) fn new(exemptions: &'a [Exemption]) -> LoadMonitor<'a> {
        let beyond = [None, None];
        LoadMonitor { weights: Weights::default(), samples: 0, worst: 0.0, beyond, exemptions }
    }

    /// Forgets the weights of struts, as the topology is another from now on.
    pub(super) fn begin(&mut self) {
        self.weights = Weights::default();
    }

    /// Judges the forces in a truss at rest, with the nodes at `x` (m), at a time (s), on all nodes that are on the ground.
    pub(super) fn rest(
        &mut self,
        judgement: &Judgement,
        (x, time): (&[Vec3], f64),
        world: World,
        standing: &StabilityMonitor,
        ledger: &mut Ledger,
    ) {
        let feet = (0..x.len()).filter(|&node| standing.touches(judgement, x[node]));
        let normal = |node: usize| judgement.paths.surroundings.normal(x[node]);
        let contacts: Vec<Contact> = feet.map(|node| Contact { node, normal: normal(node) }).collect();
        self.samples += 1;
        self.instant(judgement, (x, &contacts), &model(judgement, world), time, ledger);
    }

    /// Judges the forces during the step to the keyframe of this index, and records failures and the least margins; of
    /// rolls, which are falls, nothing is judged. `tips`: true if a roll is next, so that the truss may tip while it brakes.
    pub(super) fn step(
        &mut self,
        judgement: &Judgement,
        (step, tips): (&Step, bool),
        keyframe: usize,
        world: World,
        standing: &StabilityMonitor,
        ledger: &mut Ledger,
    ) {
        if step.interpolation != Interpolation::Linear || !looked_at(judgement, keyframe) {
            return;
        }
        let feet: Vec<usize> =
            (0..step.from.len()).filter(|&n| standing.stays_down(judgement, step, n)).collect();
        let model = model(judgement, world);
        for (part, rate) in moments(step, tips) {
            let model = if rate == 0.0 { &model } else { &accelerating(judgement, &model, step, rate) };
            let x = step.at(part);
            let normal = |node: usize| judgement.paths.surroundings.normal(x[node]);
            let contacts: Vec<Contact> =
                feet.iter().map(|&node| Contact { node, normal: normal(node) }).collect();
            let time = step.time(part);
            self.samples += 1;
            if !self.instant(judgement, (&x, &contacts), model, time, ledger) {
                return;
            }
        }
    }

    /// Judges the forces at an instant. Returns false if none hold the truss.
    fn instant(
        &mut self,
        judgement: &Judgement,
        (x, contacts): (&[Vec3], &[Contact]),
        model: &ForceModel,
        time: f64,
        ledger: &mut Ledger,
    ) -> bool {
        let Judgement { struts, layout, strut: kind, .. } = judgement;
        let length = |strut: usize| {
            let (a, b) = struts[strut];
            (x[a] - x[b]).norm()
        };
        let name = |strut: usize| vec![judgement.strut_name(strut)];
        let excused = usize::from(self.exemptions.iter().any(|exemption| is_overload(exemption, time)));
        // The elastic distribution.
        let mut elastic = Weights::default();
        elastic.struts = (0..struts.len()).map(|strut| length(strut) / kind.length.1).collect();
        if let Ok(found) = elastic.forces(layout, x, struts, contacts, model) {
            keep_least(&mut ledger.verdict.elastic_margin, 1.0 - found.ratio, time, || name(found.strut));
        }
        // An upper bound on the least greatest force; what is no worse than what is known needs no LP.
        let mut bound = f64::INFINITY;
        for _ in 0..LEVELLINGS {
            let Ok(found) = self.weights.forces(layout, x, struts, contacts, model) else {
                self.weights = Weights::default();
                break;
            };
            bound = bound.min(found.ratio);
            let known = self.beyond[excused].as_ref().map_or(1.0, |beyond| beyond.best.ratio);
            if bound <= self.worst.min(known) {
                return true;
            }
            self.weights.levelled(&found, length, model);
        }
        let Some(best) = best(struts, x, contacts, (model, judgement.tolerances.balance)) else {
            let feet = contacts.iter().map(|contact| judgement.node_name(contact.node)).collect();
            let (node, names) = without_hold(judgement, x);
            let message = match node {
                Some(name) => {
                    format!("no forces, of any size, hold the node {name}: its struts lie in one plane")
                }
                None => format!(
                    "no forces of its struts and of the ground hold it, with a friction of {}",
                    model.friction
                ),
            };
            let at = if names.is_empty() { feet } else { names };
            ledger.fail(judgement.failure(CheckKind::Stability, time, at, message));
            return false;
        };
        self.worst = self.worst.max(best.ratio);
        keep_least(&mut ledger.verdict.force_margin, 1.0 - best.ratio, time, || name(best.strut));
        if best.ratio > 1.0 + judgement.tolerances.load {
            let known = &mut self.beyond[excused];
            if known.as_ref().is_none_or(|known| best.ratio > known.best.ratio) {
                let first = match known.take() {
                    Some(known) => known.first,
                    None => judgement.failure(CheckKind::StrutLoad, time, Vec::new(), String::new()),
                };
                *known = Some(Beyond { first, strut: judgement.strut_name(best.strut), time, best });
            }
        }
        true
    }

    /// Records the check of forces: as failed where struts would bear more than they can and the plan is not excused,
    /// with the least force that the path needs and where.
    pub(super) fn conclude(&self, judgement: &Judgement, ledger: &mut Ledger) {
        let strut = judgement.strut;
        let words = |found: &Beyond, would: &str| {
            let Best { force, ratio, .. } = found.best;
            let [needed, limit] =
                [force.abs(), force.abs() / ratio].map(|force| quantity(force, Dimension::FORCE));
            let time = quantity(found.time, Dimension::TIME);
            format!(
                "the strut {} {would} {needed} at {time}, however forces are distributed; a {} bears {limit}",
                found.strut, strut.name
            )
        };
        let [beyond, excused] = &self.beyond;
        if let Some(found) = beyond {
            let (at, message) = (vec![found.strut.clone()], words(found, "would bear"));
            ledger.fail(Failure { at, message, value: found.best.ratio, limit: 1.0, ..found.first.clone() });
        }
        if let Some(found) = excused {
            let excuses = |exemption: &Exemption| is_overload(exemption, found.time);
            for (index, _) in self.exemptions.iter().enumerate().filter(|(_, e)| excuses(e)) {
                ledger.use_exemption(index, CheckKind::StrutLoad);
            }
            ledger.note(words(found, "bears"));
        }
        if self.samples > 0 {
            ledger.check(CheckKind::StrutLoad, Status::Sampled(self.samples));
        }
    }
}

/// Returns a node in the air whose struts lie in one plane, or on one line, with its name; none if there is none.
fn without_hold(judgement: &Judgement, x: &[Vec3]) -> (Option<String>, Vec<String>) {
    let flat = |node: &usize| {
        let along = judgement.struts.iter().filter_map(|&(a, b)| {
            let other = if a == *node {
                b
            } else if b == *node {
                a
            } else {
                return None;
            };
            Some((x[other] - x[*node]).normalize())
        });
        let matrix = along.fold(nalgebra::Matrix3::zeros(), |sum, e| sum + e * e.transpose());
        let least = matrix.symmetric_eigenvalues().min();
        least < judgement.tolerances.flat
    };
    let found = (0..x.len()).filter(|n| x[*n].z > 0.0).find(flat).map(|node| judgement.node_name(node));
    (found.clone(), found.into_iter().collect())
}

/// Returns what the truss is made of in a world.
fn model(judgement: &Judgement, world: World) -> ForceModel {
    let strut = judgement.strut;
    let weight = |mass: f64| Vec3::new(0.0, 0.0, -mass * world.gravity);
    // A node weighs as much as those that ride along with it, too.
    let mut loads: Vec<Vec3> =
        judgement.carried.iter().map(|count| weight(strut.node_mass.unwrap_or(0.0) * count)).collect();
    for &(a, b) in &judgement.struts {
        loads[a] += weight(strut.mass / 2.0);
        loads[b] += weight(strut.mass / 2.0);
    }
    let friction = FRICTION * world.friction;
    ForceModel { loads, friction, force_max: strut.force, buckling: strut.euler() }
}

/// Returns the model with the inertia of the nodes in the loads (d'Alembert), while the progress of a step accelerates, 1/s².
fn accelerating(judgement: &Judgement, model: &ForceModel, step: &Step, rate: f64) -> ForceModel {
    let Judgement { struts, strut, carried, .. } = judgement;
    let node_mass = strut.node_mass.unwrap_or(0.0);
    let masses = strut.node_masses(carried.len(), struts);
    let masses = masses.into_iter().zip(carried).map(|(mass, count)| mass + node_mass * (count - 1.0));
    let moved = step.from.iter().zip(&step.to).zip(masses);
    let felt = model.loads.iter().zip(moved).map(|(load, ((p, q), mass))| load - (q - p) * rate * mass);
    ForceModel { loads: felt.collect(), ..model.clone() }
}

/// Returns the moments of a step at which forces are looked for, each as (progress, acceleration of progress in 1/s²): at
/// rest at both ends and in the middle, and where the truss accelerates at the start, brakes at the end unless it tips, and
/// does either in the middle.
fn moments(step: &Step, tips: bool) -> Vec<(f64, f64)> {
    let progress = step.progress();
    let [up, down] = progress.accelerations();
    let (rises, brakes, middle) = (up > 0.0, down > 0.0 && !tips, !progress.coasts());
    let all = [
        (0.0, 0.0, true),
        (0.0, up, rises),
        (0.5, 0.0, true),
        (0.5, up, rises && middle),
        (0.5, -down, brakes && middle),
        (1.0, 0.0, true),
        (1.0, -down, brakes),
    ];
    all.into_iter().filter(|(.., looked_at)| *looked_at).map(|(part, rate, _)| (part, rate)).collect()
}

/// Returns true if an exemption excuses struts that bear too much at a time, s.
fn is_overload(exemption: &Exemption, time: f64) -> bool {
    matches!(exemption.kind, ExemptionKind::Overload(None)) && exemption.covers(time)
}

/// Returns true if a step to the keyframe of this index is looked at: all of small trusses, some of large ones.
pub(super) fn looked_at(judgement: &Judgement, keyframe: usize) -> bool {
    let count = judgement.paths.keyframes.len();
    let every = count.div_ceil(KEYFRAMES_LARGE).max(1);
    judgement.paths.node_names.len() <= NODES_ALL || keyframe.is_multiple_of(every) || keyframe + 1 == count
}

/// Returns the distribution of forces whose greatest, as a part of what a strut bears, is least, in equilibrium and
/// within the friction pyramids, as checked here to `balance`, a part of the whole load; `None` if there is none. Forces of
/// the LP are in parts of the whole load.
fn best(
    struts: &[(usize, usize)],
    x: &[Vec3],
    contacts: &[Contact],
    (model, balance): (&ForceModel, f64),
) -> Option<Best> {
    let whole: f64 = model.loads.iter().map(Vec3::norm).sum();
    let greatest = struts.len() + EDGES * contacts.len();
    let mut rows: Vec<Row> =
        model.loads.iter().flat_map(|load| (0..3).map(move |k| (Vec::new(), -load[k] / whole))).collect();
    let mut lengths = Vec::with_capacity(struts.len());
    for (strut, &(a, b)) in struts.iter().enumerate() {
        let d = x[b] - x[a];
        lengths.push(d.norm());
        for k in 0..3 {
            rows[3 * a + k].0.push((strut, d[k] / d.norm()));
            rows[3 * b + k].0.push((strut, -d[k] / d.norm()));
        }
    }
    let directions: Vec<Vec3> =
        contacts.iter().flat_map(|contact| pyramid(contact, model.friction)).collect();
    for (edge, direction) in directions.iter().enumerate() {
        let node = contacts[edge / EDGES].node;
        (0..3).for_each(|k| rows[3 * node + k].0.push((struts.len() + edge, direction[k])));
    }
    let mut problem = LinearProgram { costs: vec![0.0; greatest + 1], ..LinearProgram::default() };
    problem.costs[greatest] = 1.0;
    problem.equal = rows;
    for (strut, &length) in lengths.iter().enumerate() {
        let (pull, push) = model.limits(length);
        problem.at_most.push((vec![(strut, whole / pull), (greatest, -1.0)], 0.0));
        problem.at_most.push((vec![(strut, -whole / push), (greatest, -1.0)], 0.0));
    }
    problem.at_most.extend((struts.len()..greatest).map(|at| (vec![(at, -1.0)], 0.0)));
    let found = solve_linear_program(&problem).ok()?.x;
    // The check: pushes of contacts are made what they may be, then equilibrium is looked at.
    let value = |at: usize| if at < struts.len() { found[at] } else { found[at].max(0.0) };
    let rest = |(terms, right): &Row| terms.iter().map(|&(at, part)| part * value(at)).sum::<f64>() - right;
    let off = problem.equal.iter().map(|row| rest(row).abs()).fold(0.0, f64::max);
    if off > balance {
        return None;
    }
    let ratios =
        lengths.iter().enumerate().map(|(strut, &length)| (model.ratio(found[strut] * whole, length), strut));
    let (ratio, strut) = ratios.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Best { ratio, strut, force: found[strut] * whole })
}

/// Returns the edges of a pyramid inside the friction cone of a contact.
fn pyramid(contact: &Contact, friction: f64) -> impl Iterator<Item = Vec3> {
    let normal = contact.normal;
    let across = if normal.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
    let u = normal.cross(&across).normalize();
    let v = normal.cross(&u);
    (0..EDGES).map(move |edge| {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * edge as f64 / EDGES as f64);
        normal + (u * cosine + v * sine) * friction
    })
}
