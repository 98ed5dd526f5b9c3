//! The forces of struts and contacts under the weight of a truss, as a constraint of its steps.

use super::structure::Structure;
use super::support_polygon;
use crate::geometry::Vec3;
use crate::robot::truss_statics::{Contact, Forces, ForcesError, Weights};

/// The number of times that the weights of struts are levelled where nothing is known of nearby positions.
const LEVELLINGS: usize = 60;

/// Returns the contacts of nodes on the ground, given by their indices, with the normals of the ground there.
pub(super) fn contacts(truss: &Structure, x: &[Vec3], nodes: &[usize]) -> Vec<Contact> {
    let contact = |&node: &usize| Contact { node, normal: truss.surroundings.normal(x[node]) };
    nodes.iter().map(contact).collect()
}

/// Returns the forces with the nodes at `x` (m) on `contacts` by the weights so far.
///
/// # Errors
/// [`ForcesError`] if none hold the truss.
pub(super) fn found(
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
pub(super) fn within(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[Contact],
    weights: &mut Weights,
) -> Result<Forces, ForcesError> {
    let mut best = found(truss, x, contacts, weights).or_else(|_| {
        *weights = Weights::default();
        found(truss, x, contacts, weights)
    })?;
    for _ in 0..LEVELLINGS_STEP {
        if best.ratio <= 1.0 {
            break;
        }
        level(truss, x, &best, weights);
        let next = found(truss, x, contacts, weights)?;
        if next.ratio < best.ratio {
            best = next;
        }
    }
    Ok(best)
}

/// The number of times that weights are levelled at the end of a step.
const LEVELLINGS_STEP: usize = 15;

/// Changes the weights so that the greatest of some forces becomes less the next time.
pub(super) fn level(truss: &Structure, x: &[Vec3], forces: &Forces, weights: &mut Weights) {
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
    let mut last = found(truss, x, &contacts, &mut weights)?;
    for _ in 0..LEVELLINGS {
        level(truss, x, &last, &mut weights);
        last = found(truss, x, &contacts, &mut weights)?;
    }
    Ok(last)
}

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
    levelled(truss, x).is_ok_and(|found| found.ratio <= 1.0)
}
