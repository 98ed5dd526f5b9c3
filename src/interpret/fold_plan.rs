//! From a layout to a plan that the judge lets through.

use super::call::Call;
use super::fold_panel::Panel;
use super::fold_sheet::{NoSheet, Pieces, Sheet};
use super::folding::{FlatPattern, Folded};
use super::interpreter::Interpreter;
use super::planning::Planned;
use super::record::Record;
use super::stop::Eval;
use super::value::Value;
use crate::behavior::{self, Problem};
use crate::plan::{CauseId, World};
use crate::planners::fold::weights::Inertia;
use crate::planners::fold::{Layout, Target, Weights, count, exact, order_energy, steps};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

/// Layouts of the same energy that are tried until one folds without collision.
const TIES_TRIED: u64 = 6;

/// A layout that may be what is wanted, with what is known about it.
pub struct Choice {
    pub layout: Layout,
    pub bound: f64,
    pub proved: bool,
    pub ties: Vec<usize>,
}

/// A choice with an order that was judged.
struct Outcome {
    planned: Planned,
    steps: Vec<Vec<usize>>,
    /// N·m
    energy: f64,
    step: f64,
}

/// What is to be folded.
pub struct Task<'c> {
    pub call: &'c Call<'c>,
    pub panel: Panel,
    pub target: Target,
    pub weights: Weights,
    pub settings: exact::Settings,
}

impl Task<'_> {
    /// The first choice that the judge lets through: with the leaves first, then others of the same
    /// energy, then in other orders.
    pub fn plan(self, interpreter: &mut Interpreter, first: Choice) -> Eval<Value> {
        let mut tried: Vec<Vec<usize>> = Vec::new();
        for tie in 0..=TIES_TRIED {
            let layout = match tie {
                0 => first.layout.clone(),
                // A choice that need not be the best has no ties to look for.
                _ if !first.proved => break,
                _ => {
                    let seed = self.settings.seed.wrapping_add(tie);
                    let settings = exact::Settings { seed, root: Some(first.layout.root), ..self.settings };
                    match exact::optimum(&self.target, &self.weights, &settings) {
                        Ok(other) => other.layout,
                        Err(_) => break,
                    }
                }
            };
            if tried.contains(&layout.hinges()) {
                continue;
            }
            tried.push(layout.hinges());
            let least = first.layout.energy(&self.weights) * (1.0 + exact::TOL_TIE);
            if layout.energy(&self.weights) > least {
                continue;
            }
            let order = steps::leaves_first(&layout);
            if let Some(outcome) = self.judged(interpreter, &layout, order)? {
                return Ok(self.answer(layout, outcome, &first, first.proved));
            }
        }
        let masses = vec![self.panel.mass; self.target.faces.len()];
        let cheap = order_energy::least_energy(&self.target, &first.layout, &masses, Inertia::Lamina);
        let cheap = cheap.map(|(order, _)| steps::of_order(&first.layout, &order));
        for order in cheap.into_iter().chain([steps::root_first(&first.layout)]) {
            if let Some(outcome) = self.judged(interpreter, &first.layout, order)? {
                return Ok(self.answer(first.layout.clone(), outcome, &first, false));
            }
        }
        let message = "no order of folding was found in which no panels meet";
        Err(Diagnostic::error(code::NOT_COVERED, message)
            .label(self.call.at(0), "panels meet on the way")
            .hint("another `root` or `seed` leads to other patterns")
            .into())
    }

    fn answer(&self, layout: Layout, outcome: Outcome, first: &Choice, optimal: bool) -> Value {
        let Outcome { planned, steps, energy, step } = outcome;
        let layouts = count::layouts(&self.target);
        let pattern = FlatPattern { target: self.target.clone(), layout };
        let bound = first.bound / (step * step);
        let ties = first.ties.clone();
        let folded = Folded { pattern, layouts, energy, bound, optimal, ties, steps };
        Value::Record(Rc::new(Record::Plan(Rc::new(planned.with_folded(folded)))))
    }

    /// The plan of an order, if the judge lets it through.
    fn judged(
        &self,
        interpreter: &mut Interpreter,
        layout: &Layout,
        order: Vec<Vec<usize>>,
    ) -> Eval<Option<Outcome>> {
        let panels = vec![self.panel.design.clone(); self.target.faces.len()];
        let pieces = Pieces { target: &self.target, layout, panels: &panels, span: self.call.span };
        let Sheet { design, robot, flat } = pieces.sheet(interpreter)?.map_err(|why| {
            let why = match why {
                NoSheet::Unsound => "its module is not sound",
                NoSheet::NoHinge => "its edges have no hinge",
            };
            self.call.refuse(1, format!("no triangular panel: {why}"))
        })?;
        let step = match self.call.arg(4) {
            Value::Word(_) => pieces.shortest_step(&robot),
            _ => self.call.positive(4, "the time of a step")?,
        };
        let causes = interpreter.planner_causes(self.call.span);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start: flat,
            program: pieces.program(&robot, &order, step),
            start_causes: Vec::new(),
            bond_causes: (0..robot.assembly.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        };
        let scheduled = behavior::schedule(problem)
            .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, self.call.span))?;
        let (mut planned, issues) = interpreter.assemble_plan(design, robot, scheduled, &causes, World::FREE);
        if !issues.is_empty() {
            return Err(self.call.refuse(4, "the hinges can't fold as fast as that"));
        }
        planned.plan.provenance.planner = "fold".into();
        planned.plan.provenance.seed = Some(self.settings.seed);
        let settings = interpreter.judge_settings();
        if !interpreter.judge(&planned, settings, None).ok() {
            return Ok(None);
        }
        let masses = vec![self.panel.mass; self.target.faces.len()];
        let sequence = order.concat();
        let energy = order_energy::energy(&self.target, layout, &masses, Inertia::Lamina, &sequence);
        Ok(Some(Outcome { planned, steps: order, energy: energy / (step * step), step }))
    }
}
