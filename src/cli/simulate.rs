//! `modl simulate`: plays plan files by rigid bodies, from nothing but the files, or the plans of a program.

use super::arguments::{Globals, SimulateArguments};
use super::judge::{PlanFileFault, judged};
use super::program;
use super::report::{JsonExtreme, JsonRuns, JsonSimulation, Report};
use super::terminal::print;
use super::{CallError, Ending};
use crate::plan::Plan;
use crate::simulate::{
    Extreme, FailureCounts, Played, Refusal, Run, Settings, Spread, is_judged, simulate_halving, study,
};
use crate::source::{Diagnostic, Sources, code};

/// Runs the command `modl simulate`, which plays plan files, or the plans that a program emits, with a time step and with
/// half of it, and then with what spreads draw. All files are read before the first plan is played.
///
/// # Errors
/// A message if a file can't be read or is too large, a setting is out of range, or a program emits no plan or stands among
/// other files.
pub(super) fn run(arguments: &SimulateArguments, globals: &Globals) -> Result<Ending, CallError> {
    let (settings, spread) = settings(arguments)?;
    let mut report = Report::default();
    report.simulations = Some(Vec::new());
    let played = |name: &str, plan: &Plan, report: &mut Report| -> Result<bool, PlanFileFault> {
        let refused = |refusal: Refusal| {
            let code = match refusal {
                Refusal::Invalid(_) | Refusal::Unfaithful(_) | Refusal::Shape(_) => code::BAD_PLAN_FILE,
                _ => code::BAD_VALUE,
            };
            let message = format!("`{name}` can't be simulated: {refusal}");
            Box::new((Sources::default(), Diagnostic::error(code, message)))
        };
        let (outcome, halving) = simulate_halving(plan, &settings).map_err(refused)?;
        let runs = study(plan, &settings, &spread, arguments.runs, globals.seed).map_err(refused)?;
        let verdict = is_judged(plan, &settings).then(|| judged(plan));
        let played = Played {
            plan,
            settings: &settings,
            outcome: &outcome,
            halving: &halving,
            verdict: verdict.as_ref(),
            runs: (&spread, &runs),
        };
        Ok(told(name, &played, report, globals))
    };
    program::each_plan(&arguments.files, ("simulate", "plays"), report, globals, played)
}

/// Returns the settings and the spread of the arguments.
///
/// # Errors
/// A message if one is out of range.
fn settings(arguments: &SimulateArguments) -> Result<(Settings, Spread), CallError> {
    let mut settings = Settings::default();
    settings.step = arguments.step.map_or(settings.step, |milliseconds| milliseconds * 1e-3);
    settings.friction = arguments.friction.unwrap_or(settings.friction);
    if !(settings.friction >= 0.0 && settings.friction.is_finite()) {
        return Err(CallError("`--friction` must not be negative".to_owned()));
    }
    if !(Settings::STEP_MIN..=Settings::STEP_MAX).contains(&settings.step) {
        return Err(CallError(format!("`--step`: {}", Refusal::Step)));
    }
    if arguments.runs > Spread::RUNS_MAX {
        return Err(CallError(format!("`--runs`: at most {} runs", Spread::RUNS_MAX)));
    }
    let spread = Spread {
        friction: arguments.friction_spread,
        mass: arguments.mass_spread,
        effort: arguments.torque_spread,
        stiffness: arguments.stiffness_spread,
        zero: arguments.joint_spread.to_radians(),
    };
    if let Some((name, _)) = spread.parts().iter().find(|(_, part)| !(0.0..1.0).contains(part)) {
        return Err(CallError(format!("`--{name}-spread` is a part of what is stated, from 0 to below 1")));
    }
    if !(0.0..=180.0).contains(&arguments.joint_spread) {
        return Err(CallError("`--joint-spread` is an angle from 0 to 180 degrees".to_owned()));
    }
    Ok((settings, spread))
}

/// Prints a simulation; returns true if nothing failed, in the further runs either.
fn told(name: &str, played: &Played, report: &mut Report, globals: &Globals) -> bool {
    let Some(tracks) = played.plan.body.tracks() else { return false };
    let (outcome, runs) = (played.outcome, played.runs.1);
    let failures = outcome.failures(&tracks.robot);
    let notes = played.notes();
    if !globals.json {
        let mut lines = outcome.in_words(&tracks.robot);
        lines.extend(notes.iter().map(|note| format!("note: {note}")));
        print(&format!("{name}: {}\n", lines.join("\n  ")));
    }
    let ok = failures.is_empty() && !runs.iter().any(|run| run.outcome.fails());
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
        runs: (!runs.is_empty()).then(|| of_runs(runs)),
    });
    ok
}

/// Returns how many of some runs fail in each way, and how far they go.
fn of_runs(runs: &[Run]) -> JsonRuns {
    let FailureCounts { fails, falls, breaks, misses, stops } = FailureCounts::of(runs);
    JsonRuns {
        count: runs.len(),
        fails,
        falls,
        breaks,
        misses,
        stops,
        travels: runs.iter().map(|run| run.outcome.travel.into()).collect(),
    }
}
