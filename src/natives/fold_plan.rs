//! From a layout to a plan that the judge lets through.

use super::fold_method::{Found, Question};
use super::fold_options::{HINGES, MODULE, SEQUENCE, STEP, Sequence, TARGET, shortest_step, too_fast};
use super::fold_orders::{Need, Reordering};
use super::fold_sheet::{NoSheet, Pieces, Sheet};
use super::fold_supply::Panels;
use super::folding::{FlatPattern, Folded};
use crate::behavior::{self, Problem};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::interpret::verdicts::failure_line;
use crate::plan::{Bound, CauseId, Failure, World};
use crate::planners::fold::branch_and_bound::{self, Decision};
use crate::planners::fold::objective::Minimise;
use crate::planners::fold::sweep_collision::{Collision, meeting};
use crate::planners::fold::{Layout, Proof, energy_order, spanning_trees, steps, thickness, work_order};
use crate::robot::State;
use crate::source::{Diagnostic, code};
use crate::units::number;
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// Panels that are put before the judge, in all layouts, and pairs of panels at which a quick look is
/// taken; but at least some layouts.
const JUDGED_MAX: usize = 1_600;
const LOOKED_AT_MAX: usize = 400_000;
const LAYOUTS_MIN: usize = 8;

/// In a quick look panels are so much smaller, so that it refuses nothing that the judge may let
/// through.
const SHRUNK: f64 = 0.02;

/// A layout with an order that the judge lets through.
pub struct Outcome {
    pub planned: Planned,
    pub layout: Layout,
    pub steps: Vec<Vec<usize>>,
}

/// Layouts before the judge, one after the other.
struct Hearing {
    /// What was let through.
    passed: Vec<Outcome>,
    /// Why the first was not.
    why: Option<String>,
    looks: usize,
    judged: usize,
}

/// What is to be folded of what.
pub struct Task<'t> {
    pub question: Question<'t>,
    pub panels: &'t Panels,
    /// Hinges that every layout has to have.
    pub must: Vec<usize>,
}

impl Task<'_> {
    /// The best layout that the judge lets through in the order that is asked for; else the first of
    /// all in another order.
    pub fn plan(self, interpreter: &mut Interpreter, found: &Found) -> Eval<Value> {
        let call = self.question.call;
        let mut hearing = Hearing { passed: Vec::new(), why: None, looks: 0, judged: 0 };
        let is_proved = found.proved && self.question.options.sequence == Sequence::LeavesFirst;
        for (place, layout) in found.layouts.iter().enumerate() {
            match self.heard(interpreter, &mut hearing, layout)? {
                Decision::Accept => {
                    let is_proved = is_proved && (found.listed || place == 0);
                    return Ok(self.answer(hearing.passed.remove(0), found, is_proved));
                }
                Decision::Refuse => {}
                Decision::Stop => break,
            }
        }
        if let Some((outcome, proved)) = self.next_best(interpreter, &mut hearing, found)? {
            return Ok(self.answer(outcome, found, is_proved && proved));
        }
        let why = hearing.why.unwrap_or_default();
        if !call.is_missing(HINGES) {
            return Err(Diagnostic::error(code::NO_WAY, format!("this layout does not fold so: {why}"))
                .label(call.at(HINGES), "the layout")
                .hint("another `sequence` or `root` may let it fold")
                .into());
        }
        let cleared = self.cleared(interpreter, found)?;
        let mut reordering = Reordering::new(&self);
        let reordered = reordering.first(interpreter, found)?;
        if let Some(outcome) = self.lesser(cleared, reordered) {
            return Ok(self.answer(outcome, found, false));
        }
        let message = format!("no order of folding was found that the judge lets through: {why}");
        let said = Diagnostic::error(code::NOT_COVERED, message)
            .label(call.at(TARGET), "was not folded")
            .hint("another `root` or `seed` leads to other patterns")
            .hint(self.found_so_far(found));
        let torque = |torque: f64| quantity(torque, Dimension::TORQUE);
        let (need, holds) = (reordering.need(found)?, self.question.panel.torque);
        Err(match (need, holds) {
            (Some(Need { torque: needed, faces: [a, b] }), Some(holds)) => {
                let lighter = number(100.0 * (1.0 - holds / needed));
                let (needed, holds) = (torque(needed), torque(holds));
                said.hint(format!(
                    "the hinge between panels {a} and {b} binds: an order was found if it holds {needed}, \
                     and the module states {holds}"
                ))
                .hint(format!("panels lighter by {lighter}% would do, too, or `gravity: off`"))
            }
            (None, _) if self.question.options.conventions.gravity != 0.0 => {
                said.hint("`gravity: off` folds where nothing weighs, and where there is no ground")
            }
            _ => said,
        }
        .into())
    }

    /// What is known of the layout that would have been the answer.
    fn found_so_far(&self, found: &Found) -> String {
        let Question { objective, options, .. } = self.question;
        let (layout, torque) = (&found.layouts[0], |x: f64| quantity(x, Dimension::TORQUE));
        let effort = objective.effort(layout, &steps::leaves_first(layout));
        let (what, reached) = match options.minimise {
            Minimise::PeakTorque => ("needs a torque of", effort.peak),
            _ => ("spends", effort.energy),
        };
        let open = if found.proved { 0.0 } else { (100.0 * (1.0 - found.bound / reached)).max(0.0) };
        let (reached, bound) = (torque(reached), torque(found.bound));
        format!(
            "the best flat pattern {what} {reached} with the leaves folded first, and none less than \
             {bound}: a gap of {}%",
            number(open)
        )
    }

    /// Layouts in order of their energy until one is let through; with whether none before it can be.
    fn next_best(
        &self,
        interpreter: &mut Interpreter,
        hearing: &mut Hearing,
        found: &Found,
    ) -> Eval<Option<(Outcome, bool)>> {
        let Some(settings) = found.next_best() else { return Ok(None) };
        let Question { target, objective, .. } = self.question;
        let refused: Vec<Vec<usize>> = found.layouts.iter().map(Layout::hinges).collect();
        let mut fault = None;
        let best = branch_and_bound::optimum_among(target, &objective.weights, &settings, &mut |layout| {
            if refused.contains(&layout.hinges()) && layout.root == found.layouts[0].root {
                return Decision::Refuse;
            }
            self.heard(interpreter, hearing, layout).unwrap_or_else(|stop| {
                fault = Some(stop);
                Decision::Stop
            })
        });
        if let Some(stop) = fault {
            return Err(stop);
        }
        let Ok(best) = best else { return Ok(None) };
        let passed = std::mem::take(&mut hearing.passed).into_iter();
        let outcome = passed.into_iter().find(|outcome| outcome.layout == best.layout);
        Ok(outcome.map(|outcome| (outcome, best.proof == Proof::Optimal)))
    }

    /// What is said of a layout in the order that is asked for.
    fn heard(&self, interpreter: &mut Interpreter, hearing: &mut Hearing, layout: &Layout) -> Eval<Decision> {
        let Question { target, call, .. } = self.question;
        let steps = self.steps(layout)?;
        let faces = target.faces.len();
        let [looks_max, judged_max] =
            [LOOKED_AT_MAX / (faces * faces), JUDGED_MAX / faces].map(|most| most.max(LAYOUTS_MIN));
        if hearing.looks == looks_max || hearing.judged == judged_max {
            return Ok(Decision::Stop);
        }
        hearing.looks += 1;
        // A given layout is refused in the judge's words.
        let look = call.is_missing(HINGES).then(|| meeting(target, layout, &steps, SHRUNK)).flatten();
        if let Some(Collision { step, faces: [a, b] }) = look {
            hearing.why.get_or_insert_with(|| format!("panels {a} and {b} meet in step {}", step + 1));
            return Ok(Decision::Refuse);
        }
        hearing.judged += 1;
        Ok(match self.judged(interpreter, layout, &steps)? {
            Ok(planned) => {
                hearing.passed.push(Outcome { planned, layout: layout.clone(), steps });
                Decision::Accept
            }
            Err(failure) => {
                hearing.why.get_or_insert_with(|| failure_line(&failure));
                Decision::Refuse
            }
        })
    }

    /// By face: its weight under the standard gravity, N.
    pub fn loads(&self) -> Vec<f64> {
        self.panels.masses.iter().map(|mass| mass * World::default().gravity).collect()
    }

    /// The order that is asked for, in steps.
    pub fn steps(&self, layout: &Layout) -> Eval<Vec<Vec<usize>>> {
        let Question { target, options, call, .. } = self.question;
        Ok(match options.sequence {
            Sequence::LeavesFirst => steps::leaves_first(layout),
            Sequence::RootFirst => steps::root_first(layout),
            Sequence::LeastWork => {
                steps::of_order(layout, &work_order::least_work(target, layout, &self.loads()).order)
            }
            Sequence::LeastEnergy => {
                let inertia = options.conventions.inertia;
                let Some((order, _)) =
                    energy_order::least_energy(target, layout, &self.panels.masses, inertia)
                else {
                    let limit = energy_order::HEIGHT_MAX;
                    let message =
                        format!("this order is sought in layouts of at most {limit} hinges on a path");
                    return Err(call.refuse(SEQUENCE, message));
                };
                steps::of_order(layout, &order)
            }
        })
    }

    /// What is to be small of a way to fold.
    pub fn value(&self, layout: &Layout, steps: &[Vec<usize>]) -> f64 {
        let effort = self.question.objective.effort(layout, steps);
        match self.question.options.minimise {
            Minimise::Energy => effort.energy,
            Minimise::PeakTorque => effort.peak,
            Minimise::Steps => steps.len() as f64,
        }
    }

    fn answer(&self, outcome: Outcome, found: &Found, optimal: bool) -> Value {
        let Outcome { mut planned, layout, steps } = outcome;
        let Question { target, objective, options, .. } = self.question;
        let energetic = matches!(options.minimise, Minimise::Energy) && found.bound > 0.0;
        planned.plan.provenance.bound = energetic.then_some(Bound::FoldingEnergy(found.bound));
        let effort = objective.effort(&layout, &steps);
        let value = self.value(&layout, &steps);
        let folded = Folded {
            layouts: spanning_trees::layouts(target),
            effort,
            bound: found.bound,
            fewest_steps: objective.fewest_steps(options.root),
            price: if found.least > 0.0 { value / found.least } else { 1.0 },
            optimal,
            ties: found.ties.clone(),
            tied: found.tied,
            lifting: work_order::work(target, &layout, &self.loads(), &steps.concat()),
            lifting_bound: work_order::bound(target, &layout, &self.loads()),
            too_thick: options
                .opening
                .map_or_else(Vec::new, |opening| thickness::too_thick(target, &layout, opening)),
            masses: self.panels.masses.clone(),
            conventions: options.conventions,
            minimise: options.minimise,
            steps,
            pattern: FlatPattern { target: target.clone(), layout },
        };
        Value::Record(Rc::new(Record::Plan(Rc::new(planned.with_folded(folded)))))
    }

    /// The plan of an order, if the judge lets it through; else what it finds first.
    pub fn judged(
        &self,
        interpreter: &mut Interpreter,
        layout: &Layout,
        order: &[Vec<usize>],
    ) -> Eval<Result<Planned, Failure>> {
        let Question { target, options, call, panel, .. } = self.question;
        let pieces = Pieces { target, layout, panels: &self.panels.designs, span: call.span };
        let Sheet { design, robot, flat } = pieces.sheet(interpreter)?.map_err(|why| {
            let why = match why {
                NoSheet::Unsound => "its module is not sound",
                NoSheet::NoHinge => "its edges have no hinge",
            };
            call.refuse(MODULE, format!("no triangular panel: {why}"))
        })?;
        let causes = interpreter.planner_causes(call.span);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start: State { base: options.base(self.panels.thickness[layout.root]), ..flat },
            program: pieces.program(&robot, order, options.conventions.step),
            start_causes: Vec::new(),
            bond_causes: (0..robot.assembly.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        };
        let scheduled = behavior::schedule(problem)
            .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, call.span))?;
        let (mut planned, issues) =
            interpreter.assemble_plan(design, robot, scheduled, &causes, options.world());
        if !issues.is_empty() {
            return Err(too_fast(call, STEP, shortest_step(target, panel)));
        }
        planned.plan.provenance.planner = "fold".into();
        planned.plan.provenance.seed = Some(options.seed);
        let settings = interpreter.judge_settings();
        let verdict = interpreter.judge(&planned, settings, None);
        if verdict.ok() {
            return Ok(Ok(planned));
        }
        let first = verdict.failures.iter().min_by(|a, b| a.time.total_cmp(&b.time)).cloned();
        Ok(Err(first.unwrap_or_else(|| Failure::form("the plan can't be judged".to_owned()))))
    }
}
