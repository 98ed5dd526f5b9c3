//! `fold`: the planner of folding, as it is called.

use super::call::Call;
use super::fold_panel::{self, Panel};
use super::fold_plan::{Choice, Task};
use super::interpreter::Interpreter;
use super::natives::{Native, on_run};
use super::stop::{Eval, Stop, fault};
use super::value::Value;
use crate::planners::fold::enumerate::{self, TooManyFaces};
use crate::planners::fold::exact::{self, NoLayout};
use crate::planners::fold::heuristic::{self, Measure};
use crate::planners::fold::{Proof, Target, Weights};
use crate::source::{Diagnostic, code};

pub const TABLE: &[Native] = &[on_run("fold", 7, fold)];

fn fold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let panel = Panel::of(call, 1)?;
    let target = fold_panel::target(call, 0, 1, &panel)?;
    let root = match call.arg(2) {
        Value::Word(_) => None,
        _ => Some(call.count(2, "a face")?).filter(|root| *root < target.faces.len()).map_or_else(
            || Err(call.refuse(2, format!("there is no such face: there are {}", target.faces.len()))),
            |root| Ok(Some(root)),
        )?,
    };
    let seed = call.count(5, "a seed")? as u64;
    let budget = call.count(6, "a budget")? as u64;
    interpreter.stage.progress(format!("folding {} panels", target.faces.len()));
    let weights = Weights::uniform(&target, panel.mass);
    let settings = exact::Settings { root, flat: true, budget, seed };
    let first = match call.word(3) {
        Some("enumerate") => enumerated(&target, &weights, &settings, call)?,
        Some("heuristic") => preferred(&target, &panel, &settings, call)?,
        _ => proved(&target, &weights, &settings, call)?,
    };
    let folding = Task { call, panel, target, weights, settings };
    folding.plan(interpreter, first)
}
fn proved(target: &Target, weights: &Weights, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let found = exact::optimum(target, weights, settings).map_err(|why| match why {
        NoLayout::AllOverlap => Stop::from(
            Diagnostic::error(code::NO_WAY, "every flat pattern of this shape overlaps itself")
                .label(call.at(0), "can't lie flat in one piece"),
        ),
        NoLayout::Budget => fault(
            code::NOT_COVERED,
            call.span,
            "the budget ended before any pattern was found that does not overlap",
            "a greater `budget` may find one",
        ),
    })?;
    let proved = found.proof == Proof::Optimal;
    Ok(Choice { layout: found.layout, bound: found.bound, proved, ties: found.roots })
}

fn too_many<'a>(call: &'a Call<'a>) -> impl Fn(TooManyFaces) -> Stop + 'a {
    |TooManyFaces| {
        let limit = enumerate::FACES_MAX;
        let message = format!("shapes of more than {limit} faces have too many layouts to look at each");
        Diagnostic::error(code::NOT_COVERED, message)
            .label(call.at(0), "too many faces")
            .hint("`method: exact` proves its answer without looking at every layout")
            .into()
    }
}

fn enumerated(target: &Target, weights: &Weights, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let asked = enumerate::Settings { root: settings.root, spectrum: false, budget: settings.budget };
    let found = enumerate::census(target, weights, &asked).map_err(too_many(call))?;
    let tie = found.least * (1.0 + exact::TOL_TIE);
    let ties = (0..found.by_root.len()).filter(|root| found.by_root[*root] <= tie).collect();
    let bound = if found.complete { found.least } else { 0.0 };
    Ok(Choice { layout: found.best, bound, proved: found.complete, ties })
}

fn preferred(target: &Target, panel: &Panel, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let measure = Measure::of_panels(panel.mass, panel.side);
    let found =
        heuristic::preferred(target, &measure, settings.root, settings.budget).map_err(too_many(call))?;
    let ties = vec![found.layout.root];
    Ok(Choice { layout: found.layout, bound: 0.0, proved: false, ties })
}
