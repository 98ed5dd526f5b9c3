//! The forces of struts and contacts under the weight of a truss, as a constraint of its steps.

use super::structure::Structure;
use super::support_polygon;
use crate::geometry::Vec3;
use crate::robot::truss_statics::{Contact, ForceModel, Forces, ForcesError, Weights};
use std::mem;

/// The number of times that the weights of struts are levelled where nothing is known of nearby positions.
const LEVELLINGS: usize = 60;
/// The number of times that weights are levelled at the end of a step.
const LEVELLINGS_STEP: usize = 15;
/// The number of levellings after which the greatest force must have become less, and the part of it that must be left at
/// most.
const PATIENCE: usize = 3;
const GETS_BETTER: f64 = 0.98;

/// The forces that were found last, from which the next search begins.
#[derive(Clone, Debug, Default)]
pub(in crate::planners) struct Known {
    weights: Weights,
    last: Option<Last>,
    /// The forces at the end of the last step that was made; none where they are not known.
    stood: Option<Stood>,
    /// True for the start and the end of a step if contacts let go or slid there under the accelerations of the last step.
    shifts: [bool; 2],
}

/// Forces at the end of a step, with the decomposition by which they were found.
#[derive(Clone, Debug)]
struct Stood {
    x: Vec<Vec3>,
    contacts: Vec<Contact>,
    forces: Forces,
    weights: Weights,
}

/// The part of the limit that the greatest force may leave at the start of a step so that it has a row in the next.
pub(super) const NEAR: f64 = 0.2;

/// Forces with what they were found for.
#[derive(Clone, Debug)]
struct Last {
    x: Vec<Vec3>,
    contacts: Vec<Contact>,
    forces: Result<Forces, ForcesError>,
}

impl Known {
    /// Returns forces with the nodes at `x` (m) on `feet` whose greatest is within the limit, if levelling finds some, else
    /// the least found.
    ///
    /// # Errors
    /// [`ForcesError`] if none hold the truss.
    pub(in crate::planners) fn at(
        &mut self,
        truss: &Structure,
        x: &[Vec3],
        feet: &[usize],
    ) -> Result<Forces, ForcesError> {
        let contacts = contacts(truss, x, feet);
        if let Some(last) = self.last.as_ref().filter(|last| last.x == x && last.contacts == contacts) {
            return last.forces.clone();
        }
        let forces = within(truss, x, &contacts, (&mut self.weights, LEVELLINGS_STEP));
        // Far from the limit there is nothing to level.
        if let Some(found) = forces.as_ref().ok().filter(|found| found.ratio > truss.tolerances.force_near) {
            level(truss, x, found, &mut self.weights);
        }
        self.last = Some(Last { x: x.to_vec(), contacts, forces: forces.clone() });
        forces
    }

    /// Returns true for the accelerations of the nodes (m/s²) at the start and at the end of a step from `x` to `y` (m) under all of
    /// which forces hold the truss, with the inertia of the nodes, as those show that the search found there. To be called once for
    /// each step that is made.
    pub(super) fn bear(
        &mut self,
        truss: &Structure,
        (x, y): (&[Vec3], &[Vec3]),
        [start, end]: [&[Vec3]; 2],
    ) -> [bool; 2] {
        let feet = support_polygon::staying(truss, x, y);
        let [at_start, at_end] = &mut self.shifts;
        let rises =
            self.stood.take().is_some_and(|mut stood| stood.bears(truss, (x, &feet), start, at_start));
        self.stood = self.last.as_ref().and_then(|last| {
            let forces = last.forces.clone().ok()?;
            let (x, contacts) = (last.x.clone(), last.contacts.clone());
            // The next search is at other positions, and decomposes anew.
            Some(Stood { x, contacts, forces, weights: self.weights.with_decomposition_moved() })
        });
        let brakes = self.stood.as_mut().is_some_and(|stood| stood.bears(truss, (y, &feet), end, at_end));
        if let Some(stood) = &self.stood {
            self.weights.stand_as(&stood.weights, &stood.contacts);
        }
        [rises, brakes]
    }

    /// Returns true if the forces found last leave so much of what struts bear that they are looked at only at the end of the next
    /// step.
    pub(super) fn leave_much(&self) -> bool {
        let forces = self.last.as_ref().and_then(|last| last.forces.as_ref().ok());
        forces.is_some_and(|forces| forces.ratio <= RATIO_EASY)
    }
}

impl Stood {
    /// Returns true if forces within the limits hold the truss under some accelerations of the nodes (m/s²) with the nodes at `x` (m) on
    /// `feet` (their indices), as [`bearable_part`] has it: these, with what the inertia adds to them while contacts hold as they do, or
    /// those of the search that goes on from them. False where these are the forces of other positions or feet, and where forces at
    /// rest leave so little that the search would seldom end soon. `shifts`: true if contacts will hardly hold as they do; becomes
    /// true if they did not.
    fn bears(
        &mut self,
        truss: &Structure,
        (x, feet): (&[Vec3], &[usize]),
        accelerations: &[Vec3],
        shifts: &mut bool,
    ) -> bool {
        let Some(model) = &truss.limits.forces else { return true };
        if self.x != x || self.contacts != contacts(truss, x, feet) {
            return false;
        }
        let inertia = |node: usize| accelerations[node] * -(truss.mass * truss.mass_fractions[node]);
        let loads: Vec<Vec3> = (0..truss.nodes).map(inertia).collect();
        let (model, strength) = (within_pyramid(model), truss.tolerances.strength_moving);
        let hard = self.forces.ratio > RATIO_HARD;
        if !*shifts || hard {
            let change = self.weights.response(&truss.layout, x, &truss.struts, &self.contacts, &loads);
            let (strong, length) = (model.clone().with_strength(strength), |strut| truss.length(x, strut));
            let enough = |change| self.forces.borne_multiple(&change, length, &self.contacts, &strong) >= 1.0;
            let borne = change.is_some_and(enough);
            *shifts = !borne;
            if borne || hard {
                return borne;
            }
        }
        let loads: Vec<Vec3> = model.loads.iter().zip(&loads).map(|(load, inertia)| load + inertia).collect();
        // The search for forces takes long where none hold the truss.
        if tips(truss, x, feet, &loads) {
            return false;
        }
        let moving = ForceModel { loads, ..model };
        let held = self.weights.springs().to_vec();
        let found = self.weights.forces(&truss.layout, x, &truss.struts, &self.contacts, &moving);
        *shifts = self.weights.springs() != held;
        found.is_ok_and(|found| found.ratio <= strength)
    }
}

/// Returns the model with cones of friction within the pyramids of eight edges that are within its own.
fn within_pyramid(model: &ForceModel) -> ForceModel {
    ForceModel { friction: model.friction * libm::cos(std::f64::consts::FRAC_PI_8), ..model.clone() }
}

/// The greatest force at the start of a step, as a part of what a strut bears, up to which forces leave much: steps are so short that
/// they have not been seen to reach the limit half-way and keep it at the end. A rule of thumb: the judge looks all the way.
const RATIO_EASY: f64 = 0.7;
/// The greatest force at rest, as a part of what a strut bears, up to which those in motion are looked for as soon as a step is made.
const RATIO_HARD: f64 = 0.7;

/// Returns the contacts of nodes on the ground, given by their indices, with the normals of the ground there.
fn contacts(truss: &Structure, x: &[Vec3], nodes: &[usize]) -> Vec<Contact> {
    let contact = |&node: &usize| Contact { node, normal: truss.surroundings.normal(x[node]) };
    nodes.iter().map(contact).collect()
}

/// Returns the forces with the nodes at `x` (m) on `contacts` by the weights so far.
///
/// # Errors
/// [`ForcesError`] if none hold the truss.
fn found(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[Contact],
    weights: &mut Weights,
) -> Result<Forces, ForcesError> {
    let Some(model) = &truss.limits.forces else { return Err(ForcesError::Falls) };
    weights.forces(&truss.layout, x, &truss.struts, contacts, model)
}

/// Returns forces with the nodes at `x` (m) on `contacts` whose greatest is within the limit, if levelling finds some,
/// else the last found.
///
/// # Errors
/// [`ForcesError`] if none hold the truss.
fn within(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[Contact],
    (weights, levellings): (&mut Weights, usize),
) -> Result<Forces, ForcesError> {
    let first = found(truss, x, contacts, weights).or_else(|_| {
        *weights = Weights::default();
        found(truss, x, contacts, weights)
    })?;
    let mut before = f64::INFINITY;
    // A force that no longer gets less does not get within the limit.
    let enough = |levelling: usize, best: f64| {
        best <= 1.0
            || levelling.is_multiple_of(PATIENCE) && best > GETS_BETTER * mem::replace(&mut before, best)
    };
    Ok(lessened(truss, x, contacts, (weights, levellings), first, enough))
}

/// Returns the forces whose greatest is least of those that so many levellings lead to from the first, or fewer once `enough` of
/// the number so far and the least ratio. Forces that were found hold the truss, whatever other weights lead to.
fn lessened(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[Contact],
    (weights, levellings): (&mut Weights, usize),
    first: Forces,
    mut enough: impl FnMut(usize, f64) -> bool,
) -> Forces {
    let (mut best, mut last) = (first.clone(), first);
    for levelling in 0..levellings {
        if enough(levelling, best.ratio) {
            break;
        }
        level(truss, x, &last, weights);
        let Ok(next) = found(truss, x, contacts, weights) else { break };
        last = next;
        if last.ratio < best.ratio {
            best = last.clone();
        }
    }
    best
}

/// Changes the weights so that the greatest of some forces becomes less the next time.
fn level(truss: &Structure, x: &[Vec3], forces: &Forces, weights: &mut Weights) {
    if let Some(model) = &truss.limits.forces {
        weights.levelled(forces, |strut| truss.length(x, strut), model);
    }
}

/// Returns the forces with the nodes at `x` (m), on all that are on the ground, so that the greatest is nearly least.
///
/// # Errors
/// [`ForcesError`] if none hold the truss.
pub(in crate::planners) fn levelled(truss: &Structure, x: &[Vec3]) -> Result<Forces, ForcesError> {
    let contacts = contacts(truss, x, &support_polygon::contacts(truss, x));
    let mut weights = Weights::default();
    let first = found(truss, x, &contacts, &mut weights)?;
    Ok(lessened(truss, x, &contacts, (&mut weights, LEVELLINGS), first, |_, _| false))
}

/// Returns the least coefficient of friction with which forces hold the truss with the nodes at `x` (m), to a tolerance;
/// `None` if none up to ten does.
pub(in crate::planners) fn friction_needed(truss: &Structure, x: &[Vec3]) -> Option<f64> {
    let contacts = contacts(truss, x, &support_polygon::contacts(truss, x));
    let model = truss.limits.forces.as_ref()?;
    let holds = |friction: f64| {
        let model = ForceModel { friction, ..model.clone() };
        Weights::default().forces(&truss.layout, x, &truss.struts, &contacts, &model).is_ok()
    };
    let (mut low, mut high) = (model.friction, FRICTION_MAX);
    if !holds(high) {
        return None;
    }
    while high - low > truss.tolerances.friction_step {
        let middle = (low + high) / 2.0;
        if holds(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

/// The greatest coefficient of friction that is tried.
const FRICTION_MAX: f64 = 10.0;

/// Returns the part of a strut's force that the greatest leaves, times the unit length of the truss, m; what is far
/// below 0 if nothing holds the truss.
pub(super) fn spare(truss: &Structure, forces: &Result<Forces, ForcesError>) -> f64 {
    let ratio = forces.as_ref().map_or(UNHELD, |forces| forces.ratio);
    (1.0 - ratio) * truss.unit
}

/// The ratio that stands for no hold at all.
const UNHELD: f64 = 2.0;

/// Returns the gradient of [`spare`], as (index of a node, derivative by its position), without unit.
pub(super) fn gradient(truss: &Structure, x: &[Vec3], forces: &Forces) -> Vec<(usize, Vec3)> {
    let gradient = forces.gradient(x, &truss.struts);
    gradient.into_iter().map(|g| g * -truss.unit).enumerate().collect()
}

/// Returns true if forces within the limits hold the truss with the nodes at `x` (m), or none are limited; also where
/// it does not stand.
pub(in crate::planners) fn holds(truss: &Structure, x: &[Vec3]) -> bool {
    let standing = support_polygon::stability_margin(truss, x, &support_polygon::contacts(truss, x));
    if truss.limits.forces.is_none() || standing.is_none_or(|(inside, _)| inside < 0.0) {
        return true;
    }
    let contacts = contacts(truss, x, &support_polygon::contacts(truss, x));
    let found = within(truss, x, &contacts, (&mut Weights::default(), LEVELLINGS));
    found.is_ok_and(|found| found.ratio <= 1.0)
}

/// Returns the part, at most 1, of some accelerations of the nodes (m/s²) under which forces within the limits hold the truss
/// with the nodes at `x` (m) on `feet` (their indices), with the inertia of the nodes (d'Alembert). Forces at rest and forces
/// under all of the accelerations, mixed, are in equilibrium with the same mixture of loads, and within the same cones: what
/// they bear is no more than the mixture. The tolerance `acceleration_part_min` where forces at rest leave nothing.
pub(super) fn bearable_part(
    truss: &Structure,
    x: &[Vec3],
    feet: &[usize],
    accelerations: &[Vec3],
    weights: &mut Weights,
) -> f64 {
    let Some(model) = &truss.limits.forces else { return 1.0 };
    let model = &within_pyramid(model);
    let contacts = contacts(truss, x, feet);
    let (part_min, strength) = (truss.tolerances.acceleration_part_min, truss.tolerances.strength_moving);
    let mut part = 1.0;
    while part > part_min {
        let inertia = |(node, load): (usize, &Vec3)| {
            load - accelerations[node] * (part * truss.mass * truss.mass_fractions[node])
        };
        let loads: Vec<Vec3> = model.loads.iter().enumerate().map(inertia).collect();
        // The search for forces takes long where none hold the truss.
        if tips(truss, x, feet, &loads) {
            part /= 2.0;
            continue;
        }
        let moving = ForceModel { loads, ..model.clone() };
        match least_ratio(truss, x, &contacts, (&moving, strength), weights) {
            Some(moving) if moving <= strength => return part,
            Some(moving) => {
                let rest = least_ratio(truss, x, &contacts, (model, RATIO_ENOUGH), weights).unwrap_or(1.0);
                let borne = if rest < strength { (strength - rest) / (moving - rest) } else { 0.0 };
                return (part * borne).max(part_min);
            }
            // A contact slides or lifts.
            None => part /= 2.0,
        }
    }
    part_min
}

/// Returns true if loads on the nodes at `x` (m) tip the truss over an edge of its `feet` (their indices), whatever holds it: if
/// the point of flat ground about which they have no moment across it is outside the support polygon, by more than feet may be
/// above the ground. False on uneven ground, where that point does not tell.
fn tips(truss: &Structure, x: &[Vec3], feet: &[usize], loads: &[Vec3]) -> bool {
    let weight: f64 = loads.iter().map(|load| -load.z).sum();
    if truss.surroundings.terrain.is_some() || weight <= 0.0 {
        return false;
    }
    let moments: Vec3 = x.iter().zip(loads).map(|(p, load)| load * p.z - p * load.z).sum();
    let margin = support_polygon::margin(x, &support_polygon::hull(x, feet), moments / weight);
    margin.is_some_and(|(inside, _)| inside < -truss.tolerances.contact_height * truss.unit)
}

/// Returns the least greatest force that levelling finds, as a part of the limit, at once where it is at most `enough`;
/// `None` if nothing holds the truss.
fn least_ratio(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[Contact],
    (model, enough): (&ForceModel, f64),
    weights: &mut Weights,
) -> Option<f64> {
    let mut least: Option<f64> = None;
    for _ in 0..LEVELLINGS_STEP {
        let Ok(found) = weights.forces(&truss.layout, x, &truss.struts, contacts, model) else {
            *weights = Weights::restless();
            break;
        };
        least = Some(least.map_or(found.ratio, |least| least.min(found.ratio)));
        if least.is_some_and(|least| least <= enough) {
            break;
        }
        weights.levelled(&found, |strut| truss.length(x, strut), model);
    }
    least
}

/// The greatest force at rest, as a part of the limit, from which on no less one is looked for.
const RATIO_ENOUGH: f64 = 0.95;

/// Returns what a step has to add to its linear cost, by coordinate, so that the greatest force becomes less; the greatest
/// displacement that it asks of a free node is a part of a step. None far from the limit.
/// `forces`: those found for the nodes at `x`, m; `pinned`: the nodes that do not move.
pub(in crate::planners) fn descent(
    truss: &Structure,
    x: &[Vec3],
    forces: &Forces,
    pinned: &[usize],
) -> Option<Vec<Vec3>> {
    let tolerances = &truss.tolerances;
    let near = (forces.ratio - tolerances.force_near) / (1.0 - tolerances.force_near);
    if near <= 0.0 {
        return None;
    }
    let gradient = gradient(truss, x, forces);
    let free = gradient.iter().filter(|(node, _)| !pinned.contains(node));
    let steepest = free.map(|(_, g)| g.norm()).fold(f64::MIN_POSITIVE, f64::max);
    // Near a singular shape the gradient is so steep that the step would lead anywhere.
    let size =
        near.min(1.0) * tolerances.force_descent.min(tolerances.force_descent_max / steepest) * truss.unit;
    Some(gradient.into_iter().map(|(_, g)| g * -size).collect())
}
