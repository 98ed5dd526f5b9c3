//! Refusals of the folding planner as diagnostics at the arguments that they are about.

use super::fold::{HINGES, METHOD, MODULE, ROOT, SEQUENCE, STEP, TARGET};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Stop, fault};
use crate::plan::CauseId;
use crate::planners::fold::{BestPattern, Minimise, NoFolding, Refusal, TorqueNeed};
use crate::source::{Diagnostic, code};
use crate::units::number;
use crate::units::{Dimension, quantity};

/// Returns the fault for a refusal of the planner `fold`, labelled at the arguments that it is about; `causes`: the
/// run's number of each cause, indexed by the plan's number.
pub(super) fn diagnostic(
    interpreter: &Interpreter,
    call: &Call,
    causes: &[CauseId],
    refusal: &Refusal,
) -> Stop {
    let message = refusal.to_string();
    let error = |code| Diagnostic::error(code, message.clone());
    match refusal {
        Refusal::NoSuchRoot { .. } => call.refuse(ROOT, message),
        Refusal::HeuristicObjective | Refusal::HeuristicMasses | Refusal::HeuristicSides => {
            call.refuse(METHOD, message)
        }
        Refusal::SequenceUnderGravity | Refusal::SequenceTooHigh => call.refuse(SEQUENCE, message),
        Refusal::NoSuchHinge { .. } | Refusal::NotSpanning { .. } => call.refuse(HINGES, message),
        Refusal::NoHinge => call.refuse(MODULE, message),
        Refusal::Schedule(refusal) => interpreter.refused(refusal, causes, call.span),
        Refusal::OffGround { is_root_given, .. } => error(code::NO_WAY)
            .label(call.at(if *is_root_given { ROOT } else { TARGET }), "can't lie on the ground so")
            .hint("`gravity: off` folds where there is no ground")
            .into(),
        Refusal::Interpenetrating { .. } => error(code::UNFOLDABLE)
            .label(call.at(TARGET), "does not fold")
            .label(call.at(MODULE), "too thick")
            .hint("thinner panels, or larger faces, leave room")
            .into(),
        Refusal::AllOverlap => {
            error(code::NO_WAY).label(call.at(TARGET), "can't lie flat in one piece").into()
        }
        Refusal::NothingFlat => {
            fault(code::NOT_COVERED, call.span, message, "a greater `budget` may find one")
        }
        Refusal::TooManyFaces { .. } | Refusal::TooManyLayouts { .. } => error(code::NOT_COVERED)
            .label(call.at(TARGET), "too many layouts")
            .hint("`method: exact` proves its answer without looking at every layout, where it can")
            .into(),
        Refusal::StepTooShort { least } => too_short(call, STEP, message, *least),
        Refusal::GivenLayout(_) => error(code::NO_WAY)
            .label(call.at(HINGES), "the layout")
            .hint("another `sequence` or `root` may let it fold")
            .into(),
        Refusal::NoFolding(found) => with_hints(error(code::NOT_COVERED), call, found).into(),
    }
}

/// Returns the fault for a step time, the argument `key`, that is shorter than the slowest hinge needs; `least`: the
/// time that it needs, s.
pub(super) fn too_short(call: &Call, key: &'static str, message: String, least: f64) -> Stop {
    let least = quantity(least, Dimension::TIME);
    Diagnostic::error(code::BAD_VALUE, message)
        .label(call.at(key), "too short for the widest angle")
        .hint(format!("steps of {least} are long enough; without `step` they are as short as they can be"))
        .into()
}

/// Returns the diagnostic of a search without result, with what it found out and what may help.
fn with_hints(diagnostic: Diagnostic, call: &Call, found: &NoFolding) -> Diagnostic {
    let said = diagnostic
        .label(call.at(TARGET), "was not folded")
        .hint("another `root` or `seed` leads to other patterns")
        .hint(best(&found.best));
    let said = match found.need {
        None => said.hint("orders in which hinges stop on their way were tried, too"),
        Some(_) => said,
    };
    match (&found.need, found.torque) {
        (Some(TorqueNeed { torque: needed, faces: [a, b] }), Some(holds)) => {
            let lighter = number(100.0 * (1.0 - holds / needed));
            let [needed, holds] = [*needed, holds].map(|torque| quantity(torque, Dimension::TORQUE));
            said.hint(format!(
                "the hinge between panels {a} and {b} binds: an order was found if it holds {needed}, \
                 and the module states {holds}"
            ))
            .hint(format!("panels lighter by {lighter}% would do, too, or `gravity: off`"))
        }
        (None, _) if found.is_under_gravity => {
            said.hint("`gravity: off` folds where nothing weighs, and where there is no ground")
        }
        (Some(_), None) | (None, _) => said,
    }
}

/// Returns the value, bound and gap of the best flat layout, in words.
fn best(BestPattern { minimise, reached, bound, gap }: &BestPattern) -> String {
    let what = match minimise {
        Minimise::PeakTorque => "needs a torque of",
        Minimise::Energy | Minimise::Steps => "spends",
    };
    let [reached, bound] = [*reached, *bound].map(|value| quantity(value, minimise.dimension()));
    let open = number(100.0 * gap);
    format!(
        "the best flat pattern {what} {reached} with the leaves folded first, and none less than \
         {bound}: a gap of {open}%"
    )
}
