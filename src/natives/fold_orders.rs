//! Other orders than the one that was asked for, where that lets no layout pass.

use super::fold_method::{Found, Question};
use super::fold_plan::{Outcome, Task};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::plan::Failure;
use crate::planners::fold::branch_and_bound::{self, Decision};
use crate::planners::fold::collision_free_order::OrderSearch;
use crate::planners::fold::load_limits::LoadLimits;
use crate::planners::fold::{Layout, energy_order, steps};

/// Panels that are put before the judge in all layouts, but at least some layouts.
const JUDGED_MAX: usize = 3_000;
const JUDGED_MIN: usize = 16;

/// Layouts that are tried.
const LAYOUTS_MAX: usize = 4096;

/// Orders of one layout that are sought after the judge has refused one.
const RETRIES: usize = 3;

/// How often each panel of a layout may be opened in the search for its order. Where that led nowhere for
/// all layouts, but might, they are tried again with the next number.
const TURNS: [usize; 3] = [4, 32, 256];

/// Pairs of panels at which is looked in all.
const PAIRS_MAX: usize = 10_000_000;

/// A limit that is tried next is greater than the last by this part of it, at least.
const LIMIT_STEP: f64 = 0.02;

/// The search for a layout that folds in any order.
pub struct Reordering<'t> {
    task: &'t Task<'t>,
    burden: Option<LoadLimits>,
    judged: usize,
    /// Steps that may still be looked at.
    left: usize,
}

/// What came of a layout.
enum Heard {
    Passed(Box<Outcome>),
    /// It folds in no order, or the judge has refused some.
    Refused,
    /// The search for an order did not end.
    Open,
    /// No more may be looked at, or put before the judge.
    Stop,
}

/// The least limit of the hinges under which an order was found, and the panels on the hinge that
/// needs it.
pub struct Need {
    /// N·m
    pub torque: f64,
    pub faces: [usize; 2],
}

impl<'t> Reordering<'t> {
    pub fn new(task: &'t Task<'t>) -> Reordering<'t> {
        let panel = task.question.panel;
        let is_pulled = task.question.options.conventions.gravity != 0.0;
        let burden = is_pulled.then(|| LoadLimits {
            weights: task.loads(),
            torque: panel.torque.unwrap_or(f64::INFINITY),
            depth: panel.thickness / 2.0 + panel.touch,
            touch: panel.contact,
        });
        let faces = task.panels.masses.len();
        Reordering { task, burden, judged: 0, left: PAIRS_MAX / (faces * faces) }
    }

    /// The best layout of those that are known or can be sought which folds in some order.
    pub fn first(&mut self, interpreter: &mut Interpreter, found: &Found) -> Eval<Option<Outcome>> {
        let mut open = Vec::new();
        let mut ended = match found.next_best() {
            None => self.of_all(interpreter, &found.layouts, 0, &mut open)?,
            Some(settings) => self.of_next(interpreter, &settings, &mut open)?,
        };
        for pass in 1..TURNS.len() {
            if let Some(ended) = ended {
                return Ok(ended);
            }
            let again = std::mem::take(&mut open);
            ended = self.of_all(interpreter, &again, pass, &mut open)?;
        }
        Ok(ended.flatten())
    }

    /// Layouts of a list: `Some` where the search is at its end.
    fn of_all(
        &mut self,
        interpreter: &mut Interpreter,
        layouts: &[Layout],
        pass: usize,
        open: &mut Vec<Layout>,
    ) -> Eval<Option<Option<Outcome>>> {
        for layout in layouts {
            match self.of_layout(interpreter, layout, pass)? {
                Heard::Passed(outcome) => return Ok(Some(Some(*outcome))),
                Heard::Stop => return Ok(Some(None)),
                Heard::Open => open.push(layout.clone()),
                Heard::Refused => {}
            }
        }
        Ok(None)
    }

    /// Layouts in order of their energy.
    fn of_next(
        &mut self,
        interpreter: &mut Interpreter,
        settings: &branch_and_bound::Settings,
        open: &mut Vec<Layout>,
    ) -> Eval<Option<Option<Outcome>>> {
        let mut ended: Option<Eval<Option<Outcome>>> = None;
        let Question { target, objective, .. } = self.task.question;
        let mut layouts = 0;
        // What is accepted is kept here, with its plan.
        let _ = branch_and_bound::optimum_among(target, &objective.weights, settings, &mut |layout| {
            layouts += 1;
            ended = match self.of_layout(interpreter, layout, 0) {
                Ok(Heard::Passed(outcome)) => Some(Ok(Some(*outcome))),
                Ok(Heard::Stop) => Some(Ok(None)),
                Ok(Heard::Open) => {
                    open.push(layout.clone());
                    None
                }
                Ok(Heard::Refused) => None,
                Err(stop) => Some(Err(stop)),
            };
            if ended.is_some() || layouts == LAYOUTS_MAX { Decision::Stop } else { Decision::Refuse }
        });
        ended.transpose()
    }

    fn of_layout(&mut self, interpreter: &mut Interpreter, layout: &Layout, pass: usize) -> Eval<Heard> {
        if self.left == 0 {
            return Ok(Heard::Stop);
        }
        let task = self.task;
        let target = task.question.target;
        let looks = (TURNS[pass] * target.faces.len()).min(self.left);
        let burden = self.burden.clone();
        let mut passages = OrderSearch::new(target, layout, &task.panels.solids, burden.as_ref(), looks);
        for steps in self.usual(layout).into_iter().filter(|_| pass == 0) {
            if passages.is_collision_free(&steps)
                && let Ok(outcome) = self.heard(interpreter, layout, steps)?
            {
                return Ok(Heard::Passed(Box::new(outcome)));
            }
        }
        let wished = task.steps(layout)?.concat();
        let mut heard = Heard::Refused;
        for _ in 0..=RETRIES {
            let Some(order) = passages.order(&wished) else {
                if passages.left == 0 {
                    heard = Heard::Open;
                }
                break;
            };
            let together = passages.steps(&order);
            let alone: Vec<Vec<usize>> = order.iter().map(|face| vec![*face]).collect();
            if together.len() < alone.len()
                && let Ok(outcome) = self.heard(interpreter, layout, together)?
            {
                return Ok(Heard::Passed(Box::new(outcome)));
            }
            match self.heard(interpreter, layout, alone)? {
                Ok(outcome) => return Ok(Heard::Passed(Box::new(outcome))),
                Err(Some(failure)) => passages.refuse(&order, self.step_of(layout, &order, failure.time)),
                Err(None) => {
                    heard = Heard::Stop;
                    break;
                }
            }
        }
        self.left -= looks - passages.left;
        Ok(heard)
    }

    /// What hinges would have to hold under gravity for one of the layouts to fold, where an order is
    /// found for stronger ones only.
    pub fn need(&self, found: &Found) -> Eval<Option<Need>> {
        let Some(burden) = &self.burden else { return Ok(None) };
        let (target, solids) = (self.task.question.target, &self.task.panels.solids);
        let mut least: Option<Need> = None;
        let faces = target.faces.len();
        let mut left = PAIRS_MAX / (faces * faces);
        for layout in &found.layouts {
            let wished = self.task.steps(layout)?.concat();
            let mut burden = burden.clone();
            let mut at = None;
            while left > 0 && least.as_ref().is_none_or(|least| burden.torque < least.torque) {
                let mut passages =
                    OrderSearch::new(target, layout, solids, Some(&burden), left.min(TURNS[0] * faces));
                let order = passages.order(&wished);
                left -= left.min(TURNS[0] * faces) - passages.left;
                if let (Some(_), Some(face)) = (&order, at) {
                    least = Some(Need { torque: burden.torque, faces: [face, layout.parent[face]] });
                    break;
                }
                // Without an overload it is something else that stands against it.
                let Some((torque, face)) = passages.overload.filter(|_| order.is_none()) else { break };
                at = Some(face);
                burden.torque = torque.max(burden.torque * (1.0 + LIMIT_STEP));
            }
        }
        Ok(least)
    }

    /// What the judge says; `None` where no more is put before it.
    fn heard(
        &mut self,
        interpreter: &mut Interpreter,
        layout: &Layout,
        steps: Vec<Vec<usize>>,
    ) -> Eval<Result<Outcome, Option<Failure>>> {
        let faces = layout.parent.len();
        if self.judged == (JUDGED_MAX / faces).max(JUDGED_MIN) {
            return Ok(Err(None));
        }
        self.judged += 1;
        Ok(match self.task.judged(interpreter, layout, &steps)? {
            Ok(planned) => Ok(Outcome { planned, layout: layout.clone(), steps }),
            Err(failure) => Err(Some(failure)),
        })
    }

    /// The orders that most layouts fold in.
    fn usual(&self, layout: &Layout) -> Vec<Vec<Vec<usize>>> {
        let (target, masses) = (self.task.question.target, &self.task.panels.masses);
        let inertia = self.task.question.options.conventions.inertia;
        let cheap = energy_order::least_energy(target, layout, masses, inertia);
        let cheap = cheap.map(|(order, _)| steps::of_order(layout, &order));
        cheap.into_iter().chain([steps::root_first(layout), steps::leaves_first(layout)]).collect()
    }

    /// Which hinge of an order, one after the other, folds at a time, s. Level hinges take none.
    fn step_of(&self, layout: &Layout, order: &[usize], time: f64) -> usize {
        let question = &self.task.question;
        let bent =
            |face: usize| layout.hinge[face].is_some_and(|hinge| question.target.hinges[hinge].angle != 0.0);
        let number = (time / question.options.conventions.step) as usize;
        let mut folds = (0..order.len()).filter(|i| bent(order[*i]));
        folds.clone().nth(number).or(folds.next_back()).unwrap_or(0)
    }
}
