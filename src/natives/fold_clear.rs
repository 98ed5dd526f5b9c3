//! What panels are in each other's way of, whatever the layout; and layouts made so that nothing is.

use super::fold_method::{Found, Question};
use super::fold_options::{HINGES, MODULE, TARGET};
use super::fold_plan::{Outcome, Task};
use super::fold_supply::Panels;
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop};
use crate::planners::fold::strip_layouts::{Pieces, StripSearch};
use crate::planners::fold::{Target, steps, sweep_collision};
use crate::source::{Diagnostic, code};

/// Layouts that are put before the judge.
const JUDGED_MAX: usize = 8;

/// States of pairs of panels at which is looked in all.
const STATES_MAX: usize = 1_500_000_000;

/// Hinges without which panels meet in the target: they close farther than their thickness leaves room.
/// Where no layout can have them all, or the panels share no edge, the shape is refused.
pub fn must_hinge(call: &Call, target: &Target, panels: &Panels) -> Eval<Vec<usize>> {
    let mut hinges = Vec::new();
    let mut pieces = Pieces::new(target.faces.len());
    let refuse = |message: String| -> Stop {
        Diagnostic::error(code::UNFOLDABLE, message)
            .label(call.at(TARGET), "does not fold")
            .label(call.at(MODULE), "too thick")
            .hint("thinner panels, or larger faces, leave room")
            .into()
    };
    for [a, b] in sweep_collision::target_collisions(target, &panels.solids) {
        let Some(hinge) = target.hinge_between(a, b) else {
            return Err(refuse(format!("in the folded shape panels {a} and {b} are in each other")));
        };
        if !pieces.join([a, b]) {
            let message = format!(
                "around a ring of panels, {a} and {b} of it, edges close farther than the thickness leaves room: \
                 only hinges do, and one edge of a ring is none"
            );
            return Err(refuse(message));
        }
        hinges.push(hinge);
    }
    Ok(hinges)
}

impl Task<'_> {
    /// A layout that was made so that it folds with the leaves first and nothing in the way.
    pub fn cleared(&self, interpreter: &mut Interpreter, found: &Found) -> Eval<Option<Outcome>> {
        let Question { call, target, objective, options, .. } = self.question;
        if !call.is_missing(HINGES) {
            return Ok(None);
        }
        let mut clearing = StripSearch {
            target,
            weights: &objective.weights,
            solids: &self.panels.solids,
            must: &self.must,
            roots: &options.roots,
            cheap: &found.layouts,
            seed: options.seed,
            left: STATES_MAX,
        };
        for layout in clearing.layouts().into_iter().take(JUDGED_MAX) {
            let steps = steps::leaves_first(&layout);
            if let Ok(planned) = self.judged(interpreter, &layout, &steps)? {
                return Ok(Some(Outcome { planned, layout, steps }));
            }
        }
        Ok(None)
    }

    /// Of two ways to fold the one of which less is had that is to be small.
    pub fn lesser(&self, a: Option<Outcome>, b: Option<Outcome>) -> Option<Outcome> {
        let value = |outcome: &Outcome| self.value(&outcome.layout, &outcome.steps);
        a.into_iter().chain(b).min_by(|a, b| value(a).total_cmp(&value(b)))
    }
}
