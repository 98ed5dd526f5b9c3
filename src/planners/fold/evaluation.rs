//! Best-first search for a layout that the judge lets through in the order that the settings ask for.

use super::branch_and_bound::{self, Decision};
use super::layout::Layout;
use super::order_bounds::Orders;
use super::proposals::Proposals;
use super::refusal::{Refusal, Rejection};
use super::settings::Sequence;
use super::steps;
use super::strip_layouts::StripSearch;
use super::sweep_collision::{Collision, first_collision};
use super::task::{Outcome, Task};

/// Panels that are put before the judge, summed over layouts; but at least [`LAYOUTS_MIN`] layouts.
const JUDGED_PANELS_MAX: usize = 1_600;

/// Pairs of panels that are sampled for collisions, summed over layouts; but at least [`LAYOUTS_MIN`] layouts.
const SAMPLED_PAIRS_MAX: usize = 400_000;

/// Layouts that are evaluated at least.
const LAYOUTS_MIN: usize = 8;

/// Thin panels are shrunk by this fraction in collision samples, so that nothing is refused that the judge may let
/// through.
const SHRINKAGE: f64 = 0.02;

/// Layouts of strips that are put before the judge.
const STRIP_LAYOUTS_MAX: usize = 8;

/// States of pairs of panels that the search for layouts of strips samples.
const STRIP_STATES_MAX: usize = 1_500_000_000;

/// The state of an evaluation of layouts one after the other: those that the judge let through, the first refusal, and
/// the numbers of layouts sampled and judged.
pub(super) struct Candidates {
    /// The order in which the layouts fold.
    sequence: Sequence,
    /// The minimised quantity from which on a layout is of no use, N·m or steps: the evaluation ends where one that is
    /// not less folds without a collision in samples.
    cutoff: f64,
    /// True once a layout has ended the evaluation in that way.
    pub is_cut_off: bool,
    /// True where no layout was let through with the leaves first, so that panels are in each other's way so.
    pub is_barred: bool,
    /// Those that the judge let through.
    accepted: Vec<Outcome>,
    /// The reason for which the first layout that the judge refused was refused; `None` while none was.
    pub first: Option<Rejection>,
    /// The number of layouts sampled for collisions.
    sampled: usize,
    /// The number of layouts put before the judge.
    judged: usize,
}

impl Candidates {
    /// Returns the state before any layout was evaluated; `sequence`: the order in which they fold; `cutoff`: the
    /// minimised quantity from which on a layout is of no use, N·m or steps.
    pub(super) fn new(sequence: Sequence, cutoff: f64) -> Candidates {
        Candidates {
            sequence,
            cutoff,
            is_cut_off: false,
            is_barred: false,
            accepted: Vec::new(),
            first: None,
            sampled: 0,
            judged: 0,
        }
    }
}

/// The best layout that the judge let through, with a lower bound for all layouts that it was chosen from.
pub(super) struct Chosen {
    /// The layout with its steps, its plan and its verdict.
    pub outcome: Outcome,
    /// The lower bound for all layouts that lie flat and pass the judge: on the peak torque where that is minimised,
    /// else on the energy; N·m.
    pub bound: f64,
    /// The orders of folding for which the bound holds.
    pub orders: Orders,
    /// True if it is known that no layout that lies flat and passes the judge takes fewer steps.
    pub is_fewest: bool,
}

impl Task<'_> {
    /// Returns the first layout, in order of the minimised quantity, that the judge lets through in the order of
    /// folding that the settings ask for; `None` if it lets none through of those proposed in `found` and then searched
    /// by branch and bound. `candidates` collects the layouts evaluated.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout, as [`Task::judged`] says.
    pub(super) fn best_accepted(
        &self,
        candidates: &mut Candidates,
        found: &Proposals,
    ) -> Result<Option<Chosen>, Refusal> {
        for (place, layout) in found.layouts.iter().enumerate() {
            match self.evaluate(candidates, layout)? {
                Decision::Accept => {
                    let bound = found.bound_from(place, self.settings.minimise);
                    return Ok(Some(self.chosen(candidates.accepted.remove(0), bound, found)));
                }
                Decision::Refuse => {}
                Decision::Stop => break,
            }
        }
        let next = if candidates.is_cut_off { None } else { self.next_best(candidates, found)? };
        Ok(next.map(|(outcome, bound)| self.chosen(outcome, found.bound.max(bound), found)))
    }

    /// Returns an outcome in the order asked for; `bound`: that of the proposals, which fold with the leaves first.
    fn chosen(&self, outcome: Outcome, bound: f64, found: &Proposals) -> Chosen {
        let orders = match self.settings.sequence {
            Sequence::Auto | Sequence::LeavesFirst => Orders::LeavesFirst,
            Sequence::RootFirst => Orders::RootFirst,
            Sequence::LeastWork | Sequence::LeastEnergy => Orders::Any,
        };
        let as_proposed = orders == Orders::LeavesFirst;
        let bound = if as_proposed { bound } else { self.objective.lower_bound(&self.roots, orders) };
        Chosen { outcome, bound, orders, is_fewest: as_proposed && found.is_gapless() }
    }

    /// Returns the next layout in order of energy that is accepted by branch and bound, with the bound for those
    /// that can be, N·m.
    fn next_best(
        &self,
        candidates: &mut Candidates,
        found: &Proposals,
    ) -> Result<Option<(Outcome, f64)>, Refusal> {
        let Some(settings) = found.next_best() else { return Ok(None) };
        let refused: Vec<Vec<usize>> = found.layouts.iter().map(Layout::hinges).collect();
        let mut fault = None;
        let mut decide = |layout: &Layout| {
            if refused.contains(&layout.hinges()) && layout.root == found.layouts[0].root {
                return Decision::Refuse;
            }
            self.evaluate(candidates, layout).unwrap_or_else(|refusal| {
                fault = Some(refusal);
                Decision::Stop
            })
        };
        let weights = &self.objective.weights;
        let best =
            branch_and_bound::search(self.target, weights, &settings, Some(&mut decide), self.observer);
        if let Some(refusal) = fault {
            return Err(refusal);
        }
        let Ok(best) = best else { return Ok(None) };
        let accepted = std::mem::take(&mut candidates.accepted).into_iter();
        let outcome = accepted.into_iter().find(|outcome| outcome.layout == best.layout);
        Ok(outcome.map(|outcome| (outcome, self.scaled(best.bound))))
    }

    /// Evaluates a layout in the order asked for: collision samples of thin panels spare the judge those that
    /// it would refuse; it decides on those that pass.
    fn evaluate(&self, candidates: &mut Candidates, layout: &Layout) -> Result<Decision, Refusal> {
        let steps = self.steps_in(layout, candidates.sequence)?;
        let faces = self.target.faces.len();
        let [sampled_max, judged_max] = [SAMPLED_PAIRS_MAX / (faces * faces), JUDGED_PANELS_MAX / faces]
            .map(|most| most.max(LAYOUTS_MIN));
        if candidates.sampled == sampled_max || candidates.judged == judged_max {
            return Ok(Decision::Stop);
        }
        if candidates.judged > 0 && !self.observer.should_continue() {
            return Ok(Decision::Stop);
        }
        candidates.sampled += 1;
        // A given layout is refused in the judge's words.
        let samples = self.problem.hinges.is_none();
        let collision = samples.then(|| first_collision(self.target, layout, &steps, SHRINKAGE)).flatten();
        if let Some(Collision { step, faces }) = collision {
            candidates.first.get_or_insert(Rejection::Meet { faces, step });
            return Ok(Decision::Refuse);
        }
        if candidates.cutoff.is_finite() && self.value(layout, &steps) >= candidates.cutoff {
            candidates.is_cut_off = true;
            return Ok(Decision::Stop);
        }
        candidates.judged += 1;
        Ok(match self.judged(layout, &steps)? {
            Ok(solution) => {
                candidates.accepted.push(Outcome {
                    solution,
                    layout: layout.clone(),
                    steps,
                    stops: Vec::new(),
                });
                Decision::Accept
            }
            Err(failure) => {
                candidates.first.get_or_insert(Rejection::Judged(failure));
                Decision::Refuse
            }
        })
    }

    /// Returns a layout of strips ([`StripSearch`]) that folds with the leaves first without collisions and that the
    /// judge lets through; `None` if the problem gives the layout, the observer has ended the call, or none was found.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout, as [`Task::judged`] says.
    pub(super) fn of_strips(&self, found: &Proposals) -> Result<Option<Outcome>, Refusal> {
        if self.problem.hinges.is_some() || !self.observer.should_continue() {
            return Ok(None);
        }
        let mut search = StripSearch {
            target: self.target,
            weights: &self.objective.weights,
            solids: &self.panels.solids,
            roots: &self.roots,
            cheap: &found.layouts,
            seed: self.settings.seed,
            states_left: STRIP_STATES_MAX,
        };
        for layout in search.layouts().into_iter().take(STRIP_LAYOUTS_MAX) {
            let steps = steps::leaves_first(&layout);
            if let Ok(solution) = self.judged(&layout, &steps)? {
                return Ok(Some(Outcome { solution, layout, steps, stops: Vec::new() }));
            }
        }
        Ok(None)
    }

    /// Returns the outcome with the lesser minimised value of two, `a` if they are equal; `None` if there is neither.
    pub(super) fn lesser(&self, a: Option<Outcome>, b: Option<Outcome>) -> Option<Outcome> {
        let value = |outcome: &Outcome| self.value(&outcome.layout, &outcome.steps);
        a.into_iter().chain(b).min_by(|a, b| value(a).total_cmp(&value(b)))
    }
}
