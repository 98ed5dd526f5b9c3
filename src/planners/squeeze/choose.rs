//! The whole problem: shapes to candidates, and the fastest that the model allows.

use super::retime::retime;
use super::shape::Shape;
use super::way::{Frame, Terms, Way};
use super::ways::{Candidate, MELT_MAX, ways};
use super::{Demand, Found, Method, Refusal, Task};
use crate::interrupt;
use crate::plan::lattice::{end_shapes, time_lower_bound};
use crate::plan::{CellLimits, Model, Ratio, Stages};
use crate::robot::Cell;
use crate::units::{Dimension, quantity};

/// How far limits may be rounded, relative, so that they are short rational numbers.
const ROUNDING: f64 = 1e-12;
/// Speeds beyond this, squared, in units: no plan reaches them.
const SPEED_SQUARED_MAX: f64 = 1e6;

/// A plan for cells of a kind, the one at `index` of the library; its one cause is 0.
pub fn squeeze(cell: &Cell, index: usize, task: &Task) -> Result<Found, Refusal> {
    if task.from.len() != task.to.len() {
        return Err(Refusal::Counts { from: task.from.len(), to: task.to.len() });
    }
    let (from, to) = (Shape::of(task.from), Shape::of(task.to));
    let time_unit = libm::sqrt(cell.size * cell.mass / cell.force);
    let unit_speed = cell.size / time_unit;
    let above = |x: f64| Ratio::simplest(x, x * (1.0 + ROUNDING)).ok_or(Refusal::TooLarge);
    let below = |x: f64| Ratio::simplest(x * (1.0 - ROUNDING), x).ok_or(Refusal::TooLarge);
    let speed = cell.speed / unit_speed;
    let limits = CellLimits {
        smallest: above(cell.shrinks_to / cell.size)?,
        speed_squared: below((speed * speed).min(SPEED_SQUARED_MAX))?,
    };
    let unit_force = cell.mass * cell.size / time_unit / time_unit;
    let contact_force = task.max_force.map(|force| below(force / unit_force)).transpose()?;
    let terms = Terms { limits, profile: task.profile, euclidean: task.euclidean };
    let candidates = ways(terms, &from, &to, task.method)?;
    if candidates.is_empty() {
        return Err(lacking(task, &from, limits));
    }
    let fill = |way: Way, balanced: bool| {
        let model = Model { balanced, contact_force, euclidean: task.euclidean };
        way.into_stages(Frame { cell: index, time_unit, limits, model })
    };
    let any_balanced = candidates.iter().any(|candidate| candidate.way.is_balanced());
    if task.demand == Demand::Balanced && !any_balanced {
        return Err(Refusal::Unbalanced { method: task.method });
    }
    let allowed = |candidate: &Candidate| match task.demand {
        Demand::Paper => true,
        Demand::Auto | Demand::Balanced if any_balanced => candidate.way.is_balanced(),
        // A shear turns the whole robot by a quarter; the others do so by a little.
        _ => candidate.method != Method::Shear || task.method == Method::Shear,
    };
    let mut candidates: Vec<Candidate> = candidates.into_iter().filter(allowed).collect();
    candidates.sort_by(|a, b| a.way.duration().total_cmp(&b.way.duration()));
    let mut best: Option<(Method, bool, Stages)> = None;
    for candidate in candidates {
        interrupt::progress_checkpoint(|| match &best {
            Some((method, _, stages)) => {
                format!("{} takes {}", method.name(), quantity(stages.duration(), Dimension::TIME))
            }
            None => format!("trying {}", candidate.method.name()),
        });
        let time = |stages: &Stages| stages.duration() / time_unit;
        // A bound on forces only slows a plan down.
        if best.as_ref().is_some_and(|(_, _, stages)| time(stages) <= candidate.way.duration()) {
            break;
        }
        let balanced = candidate.way.is_balanced();
        // What the paper's model allows is not held to more.
        let mut stages = fill(candidate.way, balanced && task.demand != Demand::Paper);
        if let Some(force) = contact_force {
            retime(&mut stages, force)?;
        }
        if best.as_ref().is_none_or(|(_, _, least)| time(&stages) < time(least)) {
            best = Some((candidate.method, balanced, stages));
        }
    }
    let (method, balanced, stages) = best.ok_or(Refusal::Method { method: task.method })?;
    check_ends(&stages, &from, &to)?;
    let lower_bound = time_lower_bound(&stages).map_err(|fault| Refusal::Defect(fault.to_string()))?;
    Ok(Found { why: why(task, method, balanced), stages, lower_bound, method, balanced })
}

/// Why no construction applies.
fn lacking(task: &Task, from: &Shape, limits: CellLimits) -> Refusal {
    if limits.smallest.order(Ratio(1, 2)).is_gt() && task.method != Method::Accordion {
        return Refusal::Stiff { smallest: limits.smallest };
    }
    let covered = |shape: &Shape| shape.is_box() || (0..3).any(|axis| shape.is_flat_across(axis));
    if task.method == Method::Auto {
        return Refusal::Solid { first: !covered(from), most: MELT_MAX };
    }
    Refusal::Method { method: task.method }
}

/// The plan begins and ends as was asked: exactly, up to a translation.
fn check_ends(stages: &Stages, from: &Shape, to: &Shape) -> Result<(), Refusal> {
    let (start, end) = end_shapes(stages).map_err(|fault| Refusal::Defect(fault.to_string()))?;
    if start != from.places || end != to.places {
        return Err(Refusal::Defect("the plan does not lead from the one shape to the other".into()));
    }
    Ok(())
}

fn why(task: &Task, method: Method, balanced: bool) -> String {
    let name = method.name();
    match (task.method, task.demand, balanced) {
        (Method::Auto, Demand::Paper, _) => format!("{name}: the fastest way in the paper's model"),
        (Method::Auto, _, true) => format!("{name}: the fastest way that nothing outside has to turn"),
        (Method::Auto, _, false) => {
            format!("{name}: no way is known that keeps the angular momentum at zero; this one turns little")
        }
        (_, _, true) => format!("{name}, as asked for; its angular momentum stays zero"),
        (_, _, false) => {
            format!("{name}, as asked for; something outside has to hold the robot from turning")
        }
    }
}
