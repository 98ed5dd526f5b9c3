//! `modl simulate`: plays plan files by rigid bodies, from nothing but the files.

use super::arguments::Globals;
use super::judge;
use super::report::{self, JsonExtreme, JsonSimulation, Report};
use super::terminal::{cancelled, listen_for_cancel, print};
use super::{CallError, Ending};
use crate::interrupt;
use crate::plan::Plan;
use crate::simulate::{Extreme, Refusal, Settings, Simulation, simulate};
use crate::source::{Diagnostic, Sources, code};
use std::path::PathBuf;

/// Runs the command `modl simulate`, which plays plan files with a time step and with half of it. All are read before
/// the first is played.
///
/// # Errors
/// A message if a file can't be read or is too large, or a setting is out of range.
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
    let texts = files.iter().map(|file| judge::read(file)).collect::<Result<Vec<_>, CallError>>()?;
    listen_for_cancel();
    let mut report = Report::default();
    report.simulations = Some(Vec::new());
    let mut ok = true;
    for (file, bytes) in files.iter().zip(texts) {
        let name = file.to_string_lossy().into_owned();
        let fault = match judge::parsed(&name, bytes) {
            Ok(plan) => match played(&plan, &settings) {
                Ok((outcome, finer)) => {
                    ok &= told(&name, &plan, &outcome, &finer, &mut report, globals);
                    None
                }
                Err(refusal) => {
                    let message = format!("`{name}` can't be simulated: {refusal}");
                    Some((Sources::default(), Diagnostic::error(code::BAD_PLAN_FILE, message)))
                }
            },
            Err(fault) => Some(*fault),
        };
        if let Some((sources, diagnostic)) = fault {
            report.add(&sources, &[diagnostic], &report::style(globals, ""), globals);
            ok = false;
        }
        if cancelled() {
            report.finish(false, globals);
            return Ok(Ending::Cancelled);
        }
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// Plays a plan with a time step, and with half of it.
fn played(plan: &Plan, settings: &Settings) -> Result<(Simulation, Simulation), Refusal> {
    let halved = Settings { step: settings.step / 2.0, ..*settings };
    let (outcome, finer) = interrupt::join(|| simulate(plan, settings), || simulate(plan, &halved));
    Ok((outcome?, finer?))
}

/// Prints a simulation; returns true if nothing failed.
fn told(
    name: &str,
    plan: &Plan,
    outcome: &Simulation,
    finer: &Simulation,
    report: &mut Report,
    globals: &Globals,
) -> bool {
    let Some(tracks) = plan.body.tracks() else { return false };
    let failures = outcome.failures(&tracks.robot);
    let notes = vec![outcome.halving(finer)];
    if !globals.json {
        let mut lines = outcome.in_words(&tracks.robot);
        lines.extend(notes.iter().map(|note| format!("note: {note}")));
        print(&format!("{name}: {}\n", lines.join("\n  ")));
    }
    let ok = failures.is_empty();
    let of_joint = |extreme: Option<Extreme>| {
        let named = |e: Extreme| JsonExtreme { value: e.value, at: e.joint(&tracks.robot), time: e.time };
        extreme.map(named)
    };
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
        bond_load: outcome.bond_load.map(|e| JsonExtreme {
            value: e.value,
            at: tracks.robot.bond_name(e.of),
            time: e.time,
        }),
        impact: outcome.impact,
        energy: outcome.work,
        failures,
        notes,
    });
    ok
}
