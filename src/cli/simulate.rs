//! `modl simulate`: plays plan files by rigid bodies, from nothing but the files, or the plans of a program.

use super::arguments::Globals;
use super::judge::PlanFileFault;
use super::program;
use super::report::{JsonExtreme, JsonSimulation, Report};
use super::terminal::print;
use super::{CallError, Ending};
use crate::plan::Plan;
use crate::simulate::{Extreme, Refusal, Settings, Simulation, simulate_halving};
use crate::source::{Diagnostic, Sources, code};
use std::path::PathBuf;

/// Runs the command `modl simulate`, which plays plan files, or the plans that a program emits, with a time step and with
/// half of it. All files are read before the first plan is played.
///
/// # Errors
/// A message if a file can't be read or is too large, a setting is out of range, or a program emits no plan or stands among
/// other files.
pub(super) fn run(
    files: &[PathBuf],
    step: Option<f64>,
    friction: Option<f64>,
    globals: &Globals,
) -> Result<Ending, CallError> {
    let mut settings = Settings::default();
    settings.step = step.map_or(settings.step, |milliseconds| milliseconds * 1e-3);
    settings.friction = friction.unwrap_or(settings.friction);
    if !(settings.friction >= 0.0 && settings.friction.is_finite()) {
        return Err(CallError("`--friction` must not be negative".to_owned()));
    }
    if !(Settings::STEP_MIN..=Settings::STEP_MAX).contains(&settings.step) {
        return Err(CallError(format!("`--step`: {}", Refusal::Step)));
    }
    let mut report = Report::default();
    report.simulations = Some(Vec::new());
    let played = |name: &str, plan: &Plan, report: &mut Report| -> Result<bool, PlanFileFault> {
        let (outcome, halving) = simulate_halving(plan, &settings).map_err(|refusal| {
            let message = format!("`{name}` can't be simulated: {refusal}");
            Box::new((Sources::default(), Diagnostic::error(code::BAD_PLAN_FILE, message)))
        })?;
        Ok(told(name, plan, &outcome, halving, report, globals))
    };
    program::each_plan(files, ("simulate", "plays"), report, globals, played)
}

/// Prints a simulation; returns true if nothing failed.
fn told(
    name: &str,
    plan: &Plan,
    outcome: &Simulation,
    halving: String,
    report: &mut Report,
    globals: &Globals,
) -> bool {
    let Some(tracks) = plan.body.tracks() else { return false };
    let failures = outcome.failures(&tracks.robot);
    let notes = vec![halving];
    if !globals.json {
        let mut lines = outcome.in_words(&tracks.robot);
        lines.extend(notes.iter().map(|note| format!("note: {note}")));
        print(&format!("{name}: {}\n", lines.join("\n  ")));
    }
    let ok = failures.is_empty();
    let json = |e: Extreme, at: String| JsonExtreme { value: e.value, at, time: e.time };
    let of_joint = |extreme: Option<Extreme>| extreme.map(|e| json(e, e.joint(&tracks.robot)));
    let of_bond = |extreme: Option<Extreme>| extreme.map(|e| json(e, e.bond(&tracks.robot)));
    report.simulations.get_or_insert_default().push(JsonSimulation {
        file: name.to_owned(),
        ok,
        step: outcome.step,
        duration: outcome.duration,
        travel: outcome.travel.into(),
        heading: outcome.heading,
        lean: outcome.lean,
        lean_max: outcome.lean_max,
        fall: outcome.fall,
        lag: of_joint(outcome.lag),
        slide_lag: of_joint(outcome.lag_length),
        torque: of_joint(outcome.effort),
        saturated: of_joint(outcome.saturated),
        bond_load: of_bond(outcome.bond_load),
        dock_error: of_bond(outcome.dock_error()),
        dock_angle: of_bond(outcome.dock_angle()),
        slip: outcome.slip,
        impact: outcome.impact,
        energy: outcome.work,
        failures,
        notes,
    });
    ok
}
