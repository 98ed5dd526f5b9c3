//! The planner itself: shapes to candidates, and the fastest that the model allows.

use super::anchor::{self, AnchorFault};
use super::candidates::{Candidate, MELT_MAX, anchored_candidates, candidates, spun};
use super::compression::compressed;
use super::motion::{Motion, PlanHeader, PlanLimits};
use super::retime::retime;
use super::shape::Shape;
use super::tolerances::TOLERANCES;
use super::tunnel;
use super::{Method, ModelChoice, Norm, Problem, Refusal, Report, Settings};
use crate::plan::lattice::{end_shapes, time_lower_bound};
use crate::plan::{Anchor, Body, CellLimits, Model, Ratio, Stages};
use crate::planners::push::Bounds;
use crate::planners::{Progress, Solution};
use crate::robot::Cell;
use crate::units::{Dimension, quantity};

/// The greatest squared speed limit, in units: no plan reaches greater ones.
const SPEED_SQUARED_MAX: f64 = 1e6;

/// Plans a motion from one shape to the other, after [Reif and Slee](super): the fastest candidate that the model
/// allows. The body is lattice stages, in exact rational numbers of cells and units of time. If `progress` ends the
/// search, the result is the fastest candidate so far. The lattice sites of the shapes are not checked to be different
/// and connected. `problem`: the two shapes and the cell; `settings`: the method and the limits.
///
/// # Errors
/// A [`Refusal`]: [`Counts`](Refusal::Counts) for shapes of different numbers of cells; [`Stiff`](Refusal::Stiff),
/// [`Solid`](Refusal::Solid) or [`Method`](Refusal::Method) if no construction asked for applies;
/// [`Docked`](Refusal::Docked), [`Blocks`](Refusal::Blocks) or [`TooMany`](Refusal::TooMany) for cells that do not slide, or
/// the method for them, and shapes that it does not take; [`Anchor`](Refusal::Anchor) for fixed cells or obstacles that do not fit the shapes, or leave no way that is found;
/// [`Unbalanced`](Refusal::Unbalanced) if the model allows none of the motions; [`TooLarge`](Refusal::TooLarge) for
/// numbers that do not fit 64 bits; [`Cancelled`](Refusal::Cancelled) if `progress` ends the search before the first
/// candidate. [`Defect`](Refusal::Defect) alone is a failure of the planner, not of the problem.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    if problem.start.len() != problem.goal.len() {
        return Err(Refusal::Counts { from: problem.start.len(), to: problem.goal.len() });
    }
    anchor::check(problem, settings).map_err(Refusal::Anchor)?;
    let anchored = !problem.fixed.is_empty();
    let sides = end_sides(problem)?;
    let shape: fn(&[[i64; 3]]) -> Shape = if anchored { Shape::standing } else { Shape::of };
    let (from, to) = (shape(&problem.start), shape(&problem.goal));
    let anchor = anchor::of(problem, &from);
    let units = Units::of(&problem.cell, settings)?;
    // All candidates that the model allows, the fastest first.
    let euclidean = settings.norm == Norm::Euclidean;
    let slides = problem.cell.slides;
    let limits = PlanLimits { cell: units.cell, profile: settings.profile, euclidean, anchored, slides };
    if from.positions != to.positions && settings.method.tunnels(slides) {
        check_docked(problem, settings, units.cell)?;
    }
    let mut candidates = if anchored {
        let bounds = Bounds { fixed: &problem.fixed, obstacles: &problem.obstacles };
        anchored_candidates(limits, &from, &to, (bounds, settings.method))?
    } else {
        candidates(limits, &from, &to, settings.method)?
    };
    // The slow way that is always balanced, where the quick ones are not.
    let is_asked = settings.method == Method::Auto && settings.model == ModelChoice::Balanced;
    let quick = candidates.iter().any(|candidate| candidate.motion.is_balanced());
    if is_asked && !quick && !anchored && from.positions != to.positions {
        candidates.extend(spun(limits, &from, &to)?);
    }
    if candidates.is_empty() {
        if anchored {
            return Err(Refusal::Anchor(AnchorFault::NoWay));
        }
        return Err(not_covered(settings, &from, units.cell));
    }
    let candidates = candidates
        .into_iter()
        .map(|c| Ok(Candidate { motion: compressed(c.motion, limits, &to, sides)?, ..c }))
        .collect::<Result<_, Refusal>>()?;
    let candidates = allowed(candidates, settings)?;
    let (method, balanced, stages) = fastest(candidates, &units, (settings, anchor, slides), progress)?;
    // The plan begins and ends as it should, exactly.
    check_ends(&stages, &Shape::of(&problem.start), &Shape::of(&problem.goal), sides)?;
    let lower_bound =
        time_lower_bound(&stages, slides).map_err(|fault| Refusal::Defect(fault.to_string()))?;
    let way = if slides || method != Method::Tunnel || settings.method != Method::Auto {
        why(settings, method, balanced, anchored)
    } else {
        "tunnel: the way of cells that do not slide".to_owned()
    };
    let why = match (sides == [Ratio::ONE; 3], from.positions == to.positions) {
        (true, _) => way,
        (false, true) => "all cells shrink at once: nothing has to go from place to place".to_owned(),
        (false, false) => format!("{way}; at the end all cells shrink"),
    };
    let named = stages.stages.iter().map(|stage| (stage.name.clone(), stage.duration() * stages.time_unit));
    let report = Report { lower_bound, method, balanced, why, stages: named.collect() };
    Ok(Solution { body: Body::Stages(stages), program: None, report })
}

/// The limits of a cell in units of its size, mass and greatest acceleration.
struct Units {
    /// The unit of time, s: √(size · mass / force).
    time: f64,
    cell: CellLimits,
    contact_force: Option<Ratio>,
}

impl Units {
    /// Computes the units of a kind of cell, and its limits in them as short rational numbers, to the safe side.
    fn of(cell: &Cell, settings: &Settings) -> Result<Units, Refusal> {
        let time = libm::sqrt(cell.size * cell.mass / cell.force);
        let unit_speed = cell.size / time;
        let above = |x: f64| Ratio::simplest(x, x * (1.0 + TOLERANCES.limits)).ok_or(Refusal::TooLarge);
        let below = |x: f64| Ratio::simplest(x * (1.0 - TOLERANCES.limits), x).ok_or(Refusal::TooLarge);
        let speed = cell.speed / unit_speed;
        let limits = CellLimits {
            smallest: above(cell.shrinks_to / cell.size)?,
            speed_squared: below((speed * speed).min(SPEED_SQUARED_MAX))?,
        };
        let unit_force = cell.mass * cell.size / time / time;
        let contact_force = settings.max_force.map(|force| below(force / unit_force)).transpose()?;
        Ok(Units { time, cell: limits, contact_force })
    }
}

/// Returns the candidates that the model of angular momentum allows, sorted by duration.
fn allowed(candidates: Vec<Candidate>, settings: &Settings) -> Result<Vec<Candidate>, Refusal> {
    let any_balanced = candidates.iter().any(|candidate| candidate.motion.is_balanced());
    if settings.model == ModelChoice::Balanced && !any_balanced {
        return Err(Refusal::Unbalanced { method: settings.method });
    }
    let allowed = |candidate: &Candidate| match settings.model {
        ModelChoice::Paper => true,
        ModelChoice::Auto | ModelChoice::Balanced if any_balanced => candidate.motion.is_balanced(),
        // A shear turns the whole robot by a quarter; the others do so by a little.
        ModelChoice::Auto | ModelChoice::Balanced => {
            candidate.method != Method::Shear || settings.method == Method::Shear
        }
    };
    let mut candidates: Vec<Candidate> = candidates.into_iter().filter(allowed).collect();
    candidates.sort_by(|a, b| a.motion.duration().total_cmp(&b.motion.duration()));
    Ok(candidates)
}

/// Returns the fastest of the candidates, which are sorted by duration, once a limit on contact forces has
/// slowed them down.
fn fastest(
    candidates: Vec<Candidate>,
    units: &Units,
    (settings, anchor, slides): (&Settings, Option<Anchor>, bool),
    progress: &mut dyn Progress,
) -> Result<(Method, bool, Stages), Refusal> {
    let stages_of = |motion: Motion, balanced: bool| {
        let euclidean = settings.norm == Norm::Euclidean;
        let model = Model { balanced, contact_force: units.contact_force, euclidean };
        let header = PlanHeader { cell: 0, time_unit: units.time, limits: units.cell, model };
        Stages { anchor: anchor.clone(), ..motion.into_stages(header) }
    };
    let mut best: Option<(Method, bool, Stages)> = None;
    for candidate in candidates {
        progress.report(&|| match &best {
            Some((method, _, stages)) => {
                format!("{} takes {}", method.name(), quantity(stages.duration(), Dimension::TIME))
            }
            None => format!("trying {}", candidate.method.name()),
        });
        if !progress.should_continue() {
            return best.ok_or(Refusal::Cancelled);
        }
        let time = |stages: &Stages| stages.duration() / units.time;
        // A limit on forces only slows a plan down: no later candidate is faster.
        if best.as_ref().is_some_and(|(_, _, stages)| time(stages) <= candidate.motion.duration()) {
            break;
        }
        // A robot that is held is not balanced by itself, not even at rest.
        let balanced = candidate.motion.is_balanced() && anchor.is_none();
        // In the paper's model the judge does not ask for balance.
        let mut stages = stages_of(candidate.motion, balanced && settings.model != ModelChoice::Paper);
        if let Some(force) = units.contact_force {
            retime(&mut stages, force, slides)?;
        }
        if best.as_ref().is_none_or(|(_, _, least)| time(&stages) < time(least)) {
            best = Some((candidate.method, balanced, stages));
        }
    }
    best.ok_or(Refusal::Method { method: settings.method })
}

/// Checks that a problem of cells that do not slide, or whose blocks are to tunnel, is one for that method.
fn check_docked(problem: &Problem, settings: &Settings, limits: CellLimits) -> Result<(), Refusal> {
    if settings.method != Method::Auto && settings.method != Method::Tunnel {
        return Err(Refusal::Docked { method: settings.method });
    }
    if limits.smallest.order(Ratio(1, 2)).is_gt() {
        return Err(Refusal::Stiff { smallest: limits.smallest });
    }
    tunnel::check(problem)
}

/// Returns the reason why no construction applies.
fn not_covered(settings: &Settings, from: &Shape, limits: CellLimits) -> Refusal {
    if limits.smallest.order(Ratio(1, 2)).is_gt() && settings.method != Method::Accordion {
        return Refusal::Stiff { smallest: limits.smallest };
    }
    let covered = |shape: &Shape| shape.is_box() || (0..3).any(|axis| shape.is_flat_across(axis));
    if settings.method == Method::Auto {
        return Refusal::Solid { first: !covered(from), most: MELT_MAX };
    }
    Refusal::Method { method: settings.method }
}

/// Checks that the plan begins and ends in the two shapes: exactly, up to a translation. A last stage that squeezes cells
/// to `sides` follows the second.
fn check_ends(stages: &Stages, from: &Shape, to: &Shape, sides: [Ratio; 3]) -> Result<(), Refusal> {
    let unsqueezed;
    let whole = if sides == [Ratio::ONE; 3] {
        stages
    } else {
        let (_, before) = stages.stages.split_last().expect("it ends with the stage that squeezes");
        unsqueezed = Stages { stages: before.to_vec(), ..stages.clone() };
        &unsqueezed
    };
    let (start, end) = end_shapes(whole).map_err(|fault| Refusal::Defect(fault.to_string()))?;
    if start != from.positions || end != to.positions {
        return Err(Refusal::Defect("the plan does not lead from the one shape to the other".into()));
    }
    Ok(())
}

/// Returns the sides that cells are to have at the end, as short rational numbers.
fn end_sides(problem: &Problem) -> Result<[Ratio; 3], Refusal> {
    let smallest = problem.cell.shrinks_to / problem.cell.size;
    let mut sides = [Ratio::ONE; 3];
    for (axis, &side) in problem.sides.iter().enumerate() {
        let (low, high) = (side * (1.0 - TOLERANCES.limits), side * (1.0 + TOLERANCES.limits));
        let ratio = Ratio::simplest(low, high).filter(|_| high >= smallest && low <= 1.0);
        sides[axis] = ratio.ok_or(Refusal::Side { axis, smallest })?;
    }
    if sides != [Ratio::ONE; 3] && !problem.fixed.is_empty() {
        return Err(Refusal::FixedSides);
    }
    Ok(sides)
}

/// Returns the reason for a method, in words.
fn why(settings: &Settings, method: Method, balanced: bool, anchored: bool) -> String {
    let name = method.name();
    if anchored {
        return format!("{name}: the way on which the fixed cells stay");
    }
    match (settings.method, settings.model, balanced) {
        (Method::Auto, ModelChoice::Paper, _) => format!("{name}: the fastest way in the paper's model"),
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
