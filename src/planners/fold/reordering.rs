//! Other orders than the one asked for, where that lets no layout pass: iterative deepening over layouts in
//! order of their energy, with a depth-first search for a collision-free order in each.

use super::branch_and_bound::{self, Decision};
use super::collision_free_order::OrderSearch;
use super::energy_order;
use super::layout::Layout;
use super::load_limits::LoadLimits;
use super::proposals::Proposals;
use super::refusal::{Refusal, TorqueNeed};
use super::steps;
use super::task::{Outcome, Task};
use crate::plan::Failure;

/// The number of panels that are put before the judge, summed over layouts; but at least [`JUDGED_MIN`] layouts.
const JUDGED_PANELS_MAX: usize = 3_000;
/// The least number of layouts that may be put before the judge.
const JUDGED_MIN: usize = 16;

/// The greatest number of layouts that are tried.
const LAYOUTS_MAX: usize = 4096;

/// The number of orders of one layout that are searched after the judge has refused one.
const RETRIES: usize = 3;

/// Iterative deepening: sampled steps per panel in the search for the order of one layout. Layouts whose search
/// was cut off are tried again with the next number.
const DEPTHS: [usize; 3] = [4, 32, 256];

/// Pairs of panels that are sampled in all.
const PAIRS_MAX: usize = 10_000_000;

/// The least increase of the torque limit that is tried next, as a fraction of it.
const LIMIT_STEP: f64 = 0.02;

/// The factors on the torque limit with which orders are searched, one after the other: hinges that fold at the same time, and
/// panels that rest on the ground, may need less than samples of one hinge at a time show, and the judge knows the limit.
const TORQUE_FACTORS: [f64; 4] = [1.0, 1.04, 1.08, 1.16];

/// The search for a layout that folds in some order of its hinges, whatever order the settings ask for.
pub(super) struct Reordering<'t> {
    task: &'t Task<'t>,
    limits: Option<LoadLimits>,
    /// The factor on the torque limit with which orders are searched, one of [`TORQUE_FACTORS`].
    factor: f64,
    judged: usize,
    /// The number of steps that may still be sampled.
    samples_left: usize,
}

/// The outcome of a layout.
enum Evaluated {
    Accepted(Box<Outcome>),
    /// It folds in no order, or the judge has refused some.
    Refused,
    /// The search for an order was cut off.
    Open,
    /// No more may be sampled, or put before the judge.
    Exhausted,
}

/// The end of a search, with its outcome if there is one; `None` while it goes on.
type Ended = Option<Option<Outcome>>;

impl<'t> Reordering<'t> {
    /// Sets up the search with its whole budget of collision samples; with gravity, ground and hinge torques limit the
    /// orders.
    pub(super) fn new(task: &'t Task<'t>) -> Reordering<'t> {
        let limits = task.load_limits();
        Reordering { task, limits, factor: 1.0, judged: 0, samples_left: samples_max(task) }
    }

    /// Returns the first layout, in order of the minimised quantity, for which the judge lets some order of folding
    /// through; `None` if there is none within the budget, which each of [`TORQUE_FACTORS`] has anew. `found`: the layouts
    /// known so far, and the search for more.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout, as [`Task::judged`] says.
    pub(super) fn first(&mut self, found: &Proposals) -> Result<Option<Outcome>, Refusal> {
        let has_limit = self.limits.as_ref().is_some_and(|limits| limits.torque.is_finite());
        for factor in TORQUE_FACTORS.into_iter().take(if has_limit { TORQUE_FACTORS.len() } else { 1 }) {
            (self.factor, self.judged, self.samples_left) = (factor, 0, samples_max(self.task));
            if let Some(outcome) = self.deepened(found)? {
                return Ok(Some(outcome));
            }
        }
        Ok(None)
    }

    /// Returns the first layout as [`first`](Self::first) does, with the present factor on the torque limit. Iterative
    /// deepening: what one pass leaves open is tried again with more samples.
    fn deepened(&mut self, found: &Proposals) -> Result<Option<Outcome>, Refusal> {
        let mut open = Vec::new();
        let mut ended = match found.next_best() {
            None => self.of_list(&found.layouts, 0, &mut open)?,
            Some(settings) => self.of_next_best(&settings, &mut open)?,
        };
        for pass in 1..DEPTHS.len() {
            if let Some(ended) = ended {
                return Ok(ended);
            }
            let again = std::mem::take(&mut open);
            ended = self.of_list(&again, pass, &mut open)?;
        }
        Ok(ended.flatten())
    }

    /// Tries the layouts of a list.
    fn of_list(&mut self, layouts: &[Layout], pass: usize, open: &mut Vec<Layout>) -> Result<Ended, Refusal> {
        for layout in layouts {
            match self.of_layout(layout, pass)? {
                Evaluated::Accepted(outcome) => return Ok(Some(Some(*outcome))),
                Evaluated::Exhausted => return Ok(Some(None)),
                Evaluated::Open => open.push(layout.clone()),
                Evaluated::Refused => {}
            }
        }
        Ok(None)
    }

    /// Tries layouts in order of their energy.
    fn of_next_best(
        &mut self,
        settings: &branch_and_bound::Settings,
        open: &mut Vec<Layout>,
    ) -> Result<Ended, Refusal> {
        let mut ended: Option<Result<Option<Outcome>, Refusal>> = None;
        let task = self.task;
        let mut layouts = 0;
        let mut decide = |layout: &Layout| {
            layouts += 1;
            ended = match self.of_layout(layout, 0) {
                Ok(Evaluated::Accepted(outcome)) => Some(Ok(Some(*outcome))),
                Ok(Evaluated::Exhausted) => Some(Ok(None)),
                Ok(Evaluated::Open) => {
                    open.push(layout.clone());
                    None
                }
                Ok(Evaluated::Refused) => None,
                Err(refusal) => Some(Err(refusal)),
            };
            if ended.is_some() || layouts == LAYOUTS_MAX { Decision::Stop } else { Decision::Refuse }
        };
        // The accepted order is kept in `ended`, with its plan: the search's own result is empty.
        let weights = &task.objective.weights;
        let _ = branch_and_bound::search(task.target, weights, settings, Some(&mut decide), task.observer);
        ended.transpose()
    }

    /// Tries the usual orders of a layout, then orders from the depth-first search to the depth of this pass.
    fn of_layout(&mut self, layout: &Layout, pass: usize) -> Result<Evaluated, Refusal> {
        let task = self.task;
        if self.samples_left == 0 || !task.observer.should_continue() {
            return Ok(Evaluated::Exhausted);
        }
        let target = task.target;
        let samples = (DEPTHS[pass] * target.faces.len()).min(self.samples_left);
        let limits = self.limits.clone();
        let limits = limits.map(|limits| LoadLimits { torque: limits.torque * self.factor, ..limits });
        let mut search = OrderSearch::new(target, layout, &task.panels.solids, limits.as_ref(), samples);
        // The usual orders first.
        for steps in self.usual(layout).into_iter().filter(|_| pass == 0) {
            if search.is_collision_free(&steps)
                && let Ok(outcome) = self.evaluate(layout, steps)?
            {
                return Ok(Evaluated::Accepted(Box::new(outcome)));
            }
        }
        // Then orders from the depth-first search, in few steps or one hinge at a time; what the judge refuses
        // is forbidden to the search.
        let preferred = task.steps(layout)?.concat();
        let mut evaluated = Evaluated::Refused;
        for _ in 0..=RETRIES {
            let Some(order) = search.order(&preferred) else {
                if search.samples_left == 0 {
                    evaluated = Evaluated::Open;
                }
                break;
            };
            let together = search.steps(&order);
            let alone: Vec<Vec<usize>> = order.iter().map(|face| vec![*face]).collect();
            if together.len() < alone.len()
                && let Ok(outcome) = self.evaluate(layout, together)?
            {
                return Ok(Evaluated::Accepted(Box::new(outcome)));
            }
            match self.evaluate(layout, alone)? {
                Ok(outcome) => return Ok(Evaluated::Accepted(Box::new(outcome))),
                Err(Some(failure)) => search.forbid(&order, self.step_at(layout, &order, failure.time)),
                Err(None) => {
                    evaluated = Evaluated::Exhausted;
                    break;
                }
            }
        }
        self.samples_left -= samples - search.samples_left;
        Ok(evaluated)
    }

    /// Returns the least hinge torque limit (N·m) with which samples show an order under gravity for one of the layouts
    /// in `found`; `None` without gravity, and if no order was found for stronger hinges either.
    ///
    /// # Errors
    /// [`Refusal::SequenceTooHigh`], as [`Task::steps`] says.
    pub(super) fn torque_need(&self, found: &Proposals) -> Result<Option<TorqueNeed>, Refusal> {
        let Some(limits) = &self.limits else { return Ok(None) };
        let (target, solids) = (self.task.target, &self.task.panels.solids);
        let mut least: Option<TorqueNeed> = None;
        let faces = target.faces.len();
        let mut samples_left = samples_max(self.task);
        for layout in &found.layouts {
            let preferred = self.task.steps(layout)?.concat();
            let mut limits = limits.clone();
            let mut at = None;
            while samples_left > 0 && least.as_ref().is_none_or(|least| limits.torque < least.torque) {
                let samples = samples_left.min(DEPTHS[0] * faces);
                let mut search = OrderSearch::new(target, layout, solids, Some(&limits), samples);
                let order = search.order(&preferred);
                samples_left -= samples - search.samples_left;
                if let (Some(_), Some(face)) = (&order, at) {
                    least = Some(TorqueNeed { torque: limits.torque, faces: [face, layout.parent[face]] });
                    break;
                }
                // Without an overload something else stands against the layout.
                let Some((torque, face)) = search.overload.filter(|_| order.is_none()) else { break };
                at = Some(face);
                limits.torque = torque.max(limits.torque * (1.0 + LIMIT_STEP));
            }
        }
        Ok(least)
    }

    /// Puts a layout in steps before the judge; the inner error is its first failure, or `None` where no more
    /// is put before it.
    fn evaluate(
        &mut self,
        layout: &Layout,
        steps: Vec<Vec<usize>>,
    ) -> Result<Result<Outcome, Option<Failure>>, Refusal> {
        let faces = layout.parent.len();
        if self.judged == (JUDGED_PANELS_MAX / faces).max(JUDGED_MIN) {
            return Ok(Err(None));
        }
        self.judged += 1;
        Ok(match self.task.judged(layout, &steps)? {
            Ok(solution) => Ok(Outcome { solution, layout: layout.clone(), steps, stops: Vec::new() }),
            Err(failure) => Err(Some(failure)),
        })
    }

    /// Returns the orders in which most layouts fold: of least energy, root first, leaves first.
    fn usual(&self, layout: &Layout) -> Vec<Vec<Vec<usize>>> {
        let (target, masses) = (self.task.target, &self.task.panels.masses);
        let cheap = energy_order::least_energy(target, layout, masses, self.task.conventions.inertia);
        let cheap = cheap.map(|(order, _)| steps::of_order(layout, &order));
        cheap.into_iter().chain([steps::root_first(layout), steps::leaves_first(layout)]).collect()
    }

    /// Returns the index, in an order of one hinge at a time, of the hinge that folds at a time (s). Level
    /// hinges take no time.
    fn step_at(&self, layout: &Layout, order: &[usize], time: f64) -> usize {
        let bent = |face: usize| layout.angle(self.task.target, face) != 0.0;
        let number = (time / self.task.conventions.step) as usize;
        let mut folds = (0..order.len()).filter(|i| bent(order[*i]));
        folds.clone().nth(number).or(folds.next_back()).unwrap_or(0)
    }
}

/// Returns the number of steps that may be sampled in all.
fn samples_max(task: &Task) -> usize {
    let faces = task.panels.masses.len();
    PAIRS_MAX / (faces * faces)
}
