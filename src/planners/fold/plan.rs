//! The entry of the planner: from a problem to a folding that the judge lets through.

use super::evaluation::{Candidates, Chosen};
use super::objective::Minimise;
use super::observer::Observer;
use super::order_bounds::Orders;
use super::proposals::Proposals;
use super::refusal::{BestPattern, NoFolding, Refusal, Rejection};
use super::reordering::Reordering;
use super::report::{Report, gap};
use super::settings::{Problem, Sequence, Settings};
use super::task::{Outcome, Task};
use super::tolerances::TOLERANCES;
use super::turns::turns;
use super::{spanning_trees, steps, thickness, work_order};
use crate::interrupt;
use crate::planners::{Progress, Solution};

/// Plans the folding of a sheet of panels into a target, after [Yao et al.](super), for the least energy (or peak
/// torque, or steps) that the budget allows to find, and lets the judge decide about every layout in order of that
/// quantity. `progress` receives reports and may end the search.
///
/// If the judge refuses the order that the settings ask for in every layout tried, and the problem gives no layout,
/// layouts made of strips and other orders are tried, and the lesser of the two results is the answer: then
/// `report.bound` is a bound for all orders, unless the leaves were asked to fold first, and do. If there is no such result either, orders in which hinges stop on their way
/// and go on later are tried (`report.stops`), and the bound is one for all of these. All actions of the program have cause 0.
///
/// # Errors
/// A [`Refusal`]: a root that is not a face, settings that do not go together, a shape that does not fold, a search
/// that ended without an answer.
///
/// # Example
/// A tetrahedron with edges of 80 mm, of uniform bevelled plates:
///
/// ```
/// use modl::geometry::Vec3;
/// use modl::planners::{NoProgress, fold};
///
/// let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
/// let vertices = corners.map(|p| Vec3::from(p) * (0.08 / 8.0_f64.sqrt())).to_vec();
/// let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|face| face.to_vec());
/// let target = fold::Target::new(vertices, &faces)?;
/// let panels = fold::Plate::default().panels(&target)?;
///
/// let problem = fold::Problem::new(target, panels);
/// let solution = fold::plan(&problem, &fold::Settings::default(), &mut NoProgress)?;
/// let report = &solution.report;
/// assert!(report.optimal && report.verdict.ok());
/// assert_eq!(report.layouts, 16.into());
/// assert_eq!(report.steps.len(), 1);
/// assert!(solution.body.duration() > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let observer = Observer::new(progress);
    let task = Task::new(problem, settings, &observer)?;
    interrupt::start_task(format!("folding {} panels", task.target.faces.len()));
    // Layouts in order of their value, until the judge accepts one in the order asked for.
    let mut found = task.proposals()?;
    let mut candidates = Candidates::new(settings.sequence, f64::INFINITY);
    let accepted = if task.is_joint() {
        task.best_of_all_orders(&mut candidates, &mut found)?
    } else {
        task.best_accepted(&mut candidates, &found)?
    };
    if let Some(mut chosen) = accepted {
        // Strips and other orders, which take less at times than what was accepted where the leaves can not fold first.
        if candidates.is_barred {
            let others = task.lesser(task.of_strips(&found)?, Reordering::new(&task).first(&found)?);
            chosen.outcome = task.lesser(Some(chosen.outcome), others).expect("one is given");
        }
        return Ok(answer(&task, chosen, &found));
    }
    if problem.hinges.is_some() {
        return Err(given(candidates.first));
    }
    // Layouts made so that nothing collides, and other orders.
    let strips = task.of_strips(&found)?;
    let mut reordering = Reordering::new(&task);
    let reordered = reordering.first(&found)?;
    if let Some(outcome) = task.lesser(strips, reordered) {
        // The proof with the leaves first holds for what folds so, where that was asked for.
        let as_asked = settings.sequence == Sequence::LeavesFirst
            && settings.minimise != Minimise::Steps
            && steps::are_leaves_first(&outcome.layout, &outcome.steps);
        let orders = if as_asked { Orders::LeavesFirst } else { Orders::Any };
        let bound = if as_asked { found.bound } else { task.objective.lower_bound(&task.roots, orders) };
        return Ok(answer(&task, Chosen { outcome, bound, orders, is_fewest: false }, &found));
    }
    // Hinges that stop on their way; not where stronger hinges would do, and panels are not in each other's way.
    let need = reordering.torque_need(&found)?;
    if need.is_none()
        && let Some(outcome) = task.with_stops(&found)?
    {
        let orders = Orders::WithStops;
        let bound = task.objective.lower_bound(&task.roots, orders);
        return Ok(answer(&task, Chosen { outcome, bound, orders, is_fewest: false }, &found));
    }
    Err(Refusal::NoFolding(Box::new(NoFolding {
        first: candidates.first,
        best: best_pattern(&task, &found),
        need,
        torque: task.panels.weakest.torque,
        is_under_gravity: problem.gravity != 0.0,
    })))
}

/// Returns the refusal for a given layout, from the reason why it was refused.
fn given(first: Option<Rejection>) -> Refusal {
    // Nothing but the observer ends an evaluation before its first layout was judged.
    first.map_or(Refusal::NothingFlat, Refusal::GivenLayout)
}

/// Returns the value, bound and gap of the best flat layout, for a refusal.
fn best_pattern(task: &Task, found: &Proposals) -> BestPattern {
    let layout = &found.layouts[0];
    let effort = task.objective.effort(layout, &steps::leaves_first(layout));
    let minimise = task.settings.minimise;
    let reached = effort.minimised(minimise);
    // Rounding aside, nothing is below its bound.
    let bound = found.bound.min(reached);
    BestPattern { minimise, reached, bound, gap: gap(reached, bound) }
}

/// Returns the solution of an accepted outcome, with its report.
fn answer(task: &Task, chosen: Chosen, found: &Proposals) -> Solution<Report> {
    let Chosen { outcome: Outcome { solution, layout, steps, stops }, bound, orders, is_fewest } = chosen;
    let Task { target, objective, panels, problem, settings, .. } = task;
    let loads = task.loads();
    let opening =
        settings.hinge_radius.map(|radius| thickness::least_opening(panels.weakest.thickness, radius));
    let effort = objective.effort_with_stops(&layout, &steps, &stops);
    let value = task.value_of(&effort, &steps);
    let fewest_steps = objective.fewest_steps(problem.root);
    let minimised = effort.minimised(settings.minimise);
    // Rounding aside, nothing is below its bound.
    let bound = bound.min(minimised);
    let is_fewest = is_fewest || settings.minimise != Minimise::Steps || steps.len() == fewest_steps;
    let lifting = if stops.is_empty() {
        work_order::work(target, &layout, &loads, &steps.concat())
    } else {
        work_order::work_of_turns(target, &layout, &loads, &turns(target, &layout, &steps, &stops))
    };
    let report = Report {
        layouts: spanning_trees::layouts(target),
        effort,
        bound,
        orders,
        fewest_steps,
        price: if found.least > 0.0 { value / found.least } else { 1.0 },
        optimal: is_fewest && TOLERANCES.prove(minimised, bound),
        ties: found.ties.clone(),
        tied: found.tied,
        lifting,
        lifting_bound: work_order::bound(target, &layout, &loads).min(lifting),
        too_thick: opening.map_or_else(Vec::new, |opening| thickness::too_thick(target, &layout, opening)),
        masses: panels.masses.clone(),
        conventions: task.conventions,
        minimise: settings.minimise,
        world: task.world(),
        actions: solution.report.actions,
        verdict: solution.report.verdict,
        target: (*target).clone(),
        layout,
        steps,
        stops,
    };
    Solution { body: solution.body, program: solution.program, report }
}
