//! `modl verify`: verifies plan files again, from nothing but the files.

use super::arguments::Globals;
use super::disk;
use super::report::{self, Declaration, JsonPlan, Report};
use super::terminal::{cancelled, listen_for_cancel, print};
use super::verdict;
use super::{CallError, Ending};
use crate::behavior::unfaithful;
use crate::execute::standard;
use crate::plan::facts::{self, Declared};
use crate::plan::{self, CheckKind, Plan, Status, Verdict, WORST_VALUES};
use crate::source::{Diagnostic, Sources, Span, code};
use std::mem::discriminant;
use std::path::{Path, PathBuf};

/// The greatest size of a plan file, in bytes.
const PLAN_BYTES_MAX: usize = 1 << 30;

/// Runs the command `modl verify`, which judges plan files again, from nothing but the files. All are read before the
/// first is judged.
///
/// # Errors
/// A message if a file can't be read or is larger than `PLAN_BYTES_MAX`.
pub(super) fn run(files: &[PathBuf], globals: &Globals) -> Result<Ending, CallError> {
    let mut report = Report::default();
    report.plans = Some(Vec::new());
    each_plan(files, report, globals, |name, plan, report| Ok(report_verdict(name, plan, report, globals)))
}

/// A mistake in a plan file, with the text that its span refers to.
pub(super) type PlanFileFault = Box<(Sources, Diagnostic)>;

/// Does the same with each of some plan files, adds the mistakes of those that are not sound to a report, and finishes it.
/// All files are read before the first is used, so that a wrong call does nothing. `work` gets the name of a file, its plan
/// and the report, and returns true if all is well with it.
///
/// # Errors
/// A message if a file can't be read or is larger than `PLAN_BYTES_MAX`.
pub(super) fn each_plan(
    files: &[PathBuf],
    mut report: Report,
    globals: &Globals,
    mut work: impl FnMut(&str, &Plan, &mut Report) -> Result<bool, PlanFileFault>,
) -> Result<Ending, CallError> {
    let texts = files.iter().map(|file| read(file)).collect::<Result<Vec<_>, CallError>>()?;
    listen_for_cancel();
    let mut ok = true;
    for (file, bytes) in files.iter().zip(texts) {
        let name = file.to_string_lossy().into_owned();
        let found = parsed(&name, bytes).and_then(|plan| work(&name, &plan, &mut report));
        ok &= noted(found, &mut report, globals);
        if cancelled() {
            report.finish(false, globals);
            return Ok(Ending::Cancelled);
        }
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// Adds the fault of a plan file to a report; returns true if there is none and all is well.
pub(super) fn noted(found: Result<bool, PlanFileFault>, report: &mut Report, globals: &Globals) -> bool {
    found.unwrap_or_else(|fault| {
        let (sources, diagnostic) = *fault;
        report.add(&sources, &[diagnostic], &report::style(globals, ""), globals);
        false
    })
}

/// Returns the plan that the bytes of a plan file hold; `name`: the file's name in the diagnostic.
///
/// # Errors
/// (texts, diagnostic): the diagnostic of the mistake, with the text that its span refers to.
pub(super) fn parsed(name: &str, bytes: Vec<u8>) -> Result<Plan, PlanFileFault> {
    let mut sources = Sources::default();
    let Ok(text) = String::from_utf8(bytes) else {
        return Err(Box::new((
            sources,
            Diagnostic::error(code::BAD_PLAN_FILE, format!("`{name}` is not UTF-8 text")),
        )));
    };
    plan::file::read(&text).map_err(|fault| {
        let message = format!("`{name}` is no sound plan file: {}", fault.message);
        let mut diagnostic = Diagnostic::error(code::BAD_PLAN_FILE, message);
        if fault.line > 0 {
            let id = sources.add(name, &text, false);
            let file = sources.file(id);
            let line = file.line(fault.line);
            // The reader's position is after the faulty character.
            let at = file.line_start(fault.line) + fault.column.saturating_sub(1).min(line.len());
            diagnostic = diagnostic.label(Span::new(id, at, at), "");
        }
        Box::new((sources, diagnostic))
    })
}

/// Returns the judge's verdict on a plan file, which includes the check that the plan's program makes its motion.
pub(super) fn judged(plan: &Plan) -> Verdict {
    let mut verdict = plan::verify::verify(plan);
    // A plan whose form is wrong has no program that could be scheduled.
    if !verdict.failures.iter().any(|f| f.kind == CheckKind::Form)
        && let Some(failure) = unfaithful(plan)
    {
        verdict.failures.push(failure);
        verdict
            .checks
            .iter_mut()
            .filter(|c| c.kind == CheckKind::Form)
            .for_each(|c| c.status = Status::Failed);
    }
    if plan.verdict.as_ref().is_some_and(|stated| differs(stated, &verdict)) {
        verdict
            .notes
            .push("the verdict that the file brings along is another, and was not believed".to_owned());
    }
    if plan.program.is_none() && plan.body.tracks().is_some() {
        verdict.notes.push("there is no program: a robot has to follow the positions themselves".to_owned());
    }
    verdict
}

/// Verifies a plan and prints the verdict; returns true if it is good.
fn report_verdict(name: &str, plan: &Plan, report: &mut Report, globals: &Globals) -> bool {
    let verdict = judged(plan);
    let rests_on = declarations(plan);
    if !globals.json {
        print(&verdict::text(name, plan, &verdict));
        print(&verdict::rests_on(&rests_on));
    }
    let ok = verdict.ok();
    let dynamics = plan::judged_under(plan, &plan.worlds);
    let file = name.to_owned();
    report.plans.get_or_insert_default().push(JsonPlan { file, ok, dynamics, verdict, rests_on });
    ok
}

/// Returns the declarations that a verdict rests on, each beside that of the same name in the standard library.
fn declarations(plan: &Plan) -> Vec<Declaration> {
    let library = &plan.library;
    let beside = |declared: Declared| {
        let facts = facts::facts(library, declared);
        let found = standard(&facts.name);
        let standard = found.as_ref().map(|standard| standard.path.clone());
        let differences = found.map(|standard| {
            let there = standard.library.as_ref();
            let counterpart = there.and_then(|there| {
                let of_kind = |d: &Declared| discriminant(d) == discriminant(&declared);
                Some((there, facts::declarations(there).into_iter().find(of_kind)?))
            });
            counterpart.map_or_else(
                || vec![format!("there is no such {} there", facts.kind)],
                |there| facts::differences((library, declared), there, standard.tolerance),
            )
        });
        Declaration { facts, standard, differences: differences.unwrap_or_default() }
    };
    facts::declarations(library).into_iter().map(beside).collect()
}

/// Returns the bytes of a plan file; `-` is standard input.
///
/// # Errors
/// A message if it can't be read or is larger than `PLAN_BYTES_MAX`.
pub(super) fn read(file: &Path) -> Result<Vec<u8>, CallError> {
    disk::read(file, PLAN_BYTES_MAX)
}

/// Threshold: the difference up to which values of two verdicts are equal, in SI units: the rounding of numbers in
/// files.
const TOL_VERDICT: f64 = 1e-6;

/// Returns true if the stated verdict differs from the one found.
fn differs(stated: &Verdict, found: &Verdict) -> bool {
    let worst = |v: &Verdict| WORST_VALUES.map(|kind| (kind.of)(v).as_ref().map(|w| w.value));
    let near = |a: f64, b: f64| (a - b).abs() <= TOL_VERDICT;
    let same = |(a, b): (Option<f64>, Option<f64>)| match (a, b) {
        (Some(a), Some(b)) => near(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let all = worst(stated).into_iter().zip(worst(found)).all(same);
    let travel = stated.travel.iter().zip(&found.travel).all(|(a, b)| near(*a, *b));
    // A plan file from before there were bounds states none.
    let bounds = [(stated.travel_within, found.travel_within), (stated.heading_within, found.heading_within)];
    let kept = bounds.into_iter().all(|(a, b)| a.is_none() || same((a, b)));
    stated.failures.len() != found.failures.len() || !all || !travel || !kept
}
