//! `refold`: from shape to shape through a flat sheet.

use super::fold_design::Joined;
use super::fold_refusal::too_short;
use super::fold_supply::{Sheet, Supply};
use super::{Native, fold_surface};
use crate::interpret::argument::{Auto, Positive, WordOr, arguments};
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::plan::{CauseId, Plan, World};
use crate::planners::refold::{self, Problem, Refusal, Report, Settings};
use crate::planners::{RequestedProgress, Solution};
use crate::source::{Diagnostic, code};
use crate::units::Dimension;
use std::rc::Rc;

/// The arguments that diagnostics of `refold` are about.
const FROM: &str = "from";
const TO: &str = "to";
const MODULE: &str = "module";
const STEP: &str = "step";

arguments! {
    /// The arguments of `refold`.
    struct Arguments<'c> {
        from: &'c Value,
        to: &'c Value,
        module: &'c Rc<Instance>,
        step: WordOr<Auto, Positive> as "the time of a step",
        seed: WordOr<Auto, usize> as "a seed",
        budget: usize as "a budget",
    }
}

/// The built-in `refold`: its key with its parameters and its Rust function.
pub const TABLE: &[Native] = &[Native::on_run("refold", Arguments::PARAMETERS, refold)];

impl ReportFields for Report {
    const FIELDS: &'static [ReportField<Report>] = &[
        ("changes", |_, _, report| Value::count(report.changes)),
        ("bound", |_, _, report| Value::count(report.bound)),
        ("gap", |_, _, report| Value::number(report.gap())),
        ("why", |_, _, report| Value::text(report.why())),
        ("flat", |_, _, report| Value::count(report.flat)),
        ("becomes", |_, _, report| {
            Value::list(report.becomes.iter().map(|face| Value::count(*face)).collect())
        }),
        ("energy", |_, _, report| Value::Quantity(report.energy, Dimension::ENERGY)),
    ];
}

/// Runs `refold`: reads both shapes and the panel, plans, and returns the plan with the planner's report and
/// verdict.
fn refold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let arguments = Arguments::read(call)?;
    let module = Value::Instance(arguments.module.clone());
    let mut supply = Supply::of(interpreter, call, MODULE, &module)?;
    let from = fold_surface::target(call, FROM, arguments.from)?;
    let to = fold_surface::target(call, TO, arguments.to)?;
    let panel = supply.panel(interpreter, FROM, &from, 0)?;
    if panel.panel.sides.len() != 3 {
        return Err(call.refuse(MODULE, "panels change places on a lattice of triangles: these are none"));
    }
    for (shape, target) in [(FROM, &from), (TO, &to)] {
        let faces = 0..target.faces.len();
        faces.into_iter().try_for_each(|face| supply.check_face(shape, target, face, &panel.panel))?;
    }
    let flat = from.faces.len().abs_diff(to.faces.len());
    let [from, to] =
        refold::with_equal_counts(&from, &to).map_err(|why| fold_surface::unfoldable(call, TO, &why))?;
    let designs = vec![panel.design.clone(); from.faces.len()];
    let sheet = Sheet::of(interpreter, call, MODULE, designs)?;
    let settings = Settings {
        step: match arguments.step {
            WordOr::Word(Auto) => None,
            WordOr::Value(Positive(step)) => Some(step),
        },
        seed: interpreter.seed(arguments.seed),
        budget: arguments.budget as u64,
        judge: interpreter.judge_settings(),
    };
    let causes = interpreter.planner_causes(call.span);
    let problem = Problem { from, to, panels: sheet.panels, flat };
    let Solution { body, program, report } = refold::plan(&problem, &settings, &mut RequestedProgress)
        .map_err(|refusal| diagnostic(interpreter, call, &causes.ids, &refusal))?;
    let joined =
        Joined { target: &problem.from, layout: &report.layout, designs: &sheet.designs, span: call.span };
    // Connections come and go during the motion: the configuration is that of the beginning.
    let (design, robot) = joined.design(&problem.panels);
    let bare = interpreter.bare_plan("refold", body, problem.panels.library, World::FREE, &causes);
    let mut plan = Plan { program, ..bare };
    plan.provenance.seed = Some(settings.seed);
    let words = |name| {
        interpreter.shared.sources.text(call.at(name)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    plan.provenance.shapes = Some((words(FROM), words(TO)));
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids.clone(), report.actions);
    planned.remember_verdict(report.verdict.clone());
    let planned = planned.with_report(report);
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

/// Returns the fault of a refusal; `causes`: the run's number of each cause of the plan.
fn diagnostic(interpreter: &Interpreter, call: &Call, causes: &[CauseId], refusal: &Refusal) -> Stop {
    let message = refusal.to_string();
    let error = |code| Diagnostic::error(code, message.clone());
    match refusal {
        Refusal::Counts { faces: [a, b] } => error(code::BAD_VALUE)
            .label(call.at(TO), format!("{b} faces"))
            .label(call.at(FROM), format!("{a} faces"))
            .hint("panels are neither added nor taken away")
            .into(),
        Refusal::NoWay { apart, bound } => {
            let said = error(code::NOT_COVERED)
                .label(call.span, "every pair of sheets that was tried got stuck")
                .hint("a greater `budget` or another `seed` may find one");
            match apart {
                Some(apart) => said.hint(format!(
                    "the nearest two sheets differ in {apart} cells and connections; no way takes fewer \
                     than {bound} changes"
                )),
                None => said.hint(format!("no way takes fewer than {bound} changes")),
            }
            .into()
        }
        Refusal::Collides => error(code::NOT_COVERED)
            .label(call.span, "panels meet on the way")
            .hint("another `seed` or a greater `budget` leads to other sheets")
            .into(),
        Refusal::NoHinge => call.refuse(MODULE, message),
        Refusal::StepTooShort { least } => too_short(call, STEP, message, *least),
        Refusal::Schedule(refusal) => interpreter.refused(refusal, causes, call.span),
    }
}
