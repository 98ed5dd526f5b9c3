//! A verdict as text: every check with its status, worst values, failures and their causes.

use super::report::Declaration;
use crate::plan::facts::Facts;
use crate::plan::{
    self, Cause, DynamicsModel, Exemption, Failure, Ground, Measure, Plan, Stability, Status, Verdict,
};
use crate::units::Dimension;
use crate::units::{number, quantity};
use std::fmt::Write;

/// Returns the verdict on a plan as text of several lines; `name` is the name of the plan file, for the first line.
pub(super) fn text(name: &str, plan: &Plan, verdict: &Verdict) -> String {
    let headline = if verdict.ok() { plan::headline(plan, verdict) } else { "NOT verified".to_owned() };
    let mut out = format!("{name}: {headline}\n");
    line(&mut out, &summary(verdict));
    for world in &plan.worlds {
        let ground = match world.world.ground {
            Ground::Settle if world.world.is_sloped() => {
                &format!("settling on a slope of {}", quantity(world.world.slope_angle(), Dimension::ANGLE))
            }
            Ground::Settle => "settling on the ground",
            Ground::Fixed => "with its base kept on the ground",
            Ground::Held => "with its base held fast, and no ground",
            Ground::Off => "without a ground",
        };
        let (from, gravity) = (quantity(world.from, Dimension::TIME), number(world.world.gravity));
        line(
            &mut out,
            &format!(
                "from {from}: gravity {gravity}m/s^2, {ground}, friction x {}, {}",
                number(world.world.friction),
                assumption(plan.body.dynamics(&world.world))
            ),
        );
    }
    line(&mut out, &settings(plan));
    out.push('\n');
    for check in &verdict.checks {
        line(&mut out, &format!("{:<14} {}", check.kind.name(), status(&check.status)));
    }
    out.push('\n');
    worst_lines(&mut out, verdict);
    if let Some(dynamics) = &verdict.dynamics {
        for (name, words) in dynamics.in_words(verdict.duration) {
            line(&mut out, &format!("{name:<14} {words}"));
        }
    }
    for (time, words) in &verdict.events {
        line(&mut out, &format!("at {}: {words}", quantity(*time, Dimension::TIME)));
    }
    verdict.notes.iter().for_each(|note| line(&mut out, &format!("note: {note}")));
    for (i, exemption) in plan.exemptions.iter().enumerate() {
        let unneeded = if verdict.unneeded_exemptions.contains(&i) { " (not needed)" } else { "" };
        line(&mut out, &format!("{}{unneeded}", exemption_line(exemption, plan)));
    }
    verdict.failures.iter().for_each(|failure| failure_lines(&mut out, failure, plan));
    out
}

/// Returns what a model of dynamics assumes.
fn assumption(dynamics: DynamicsModel) -> &'static str {
    match dynamics {
        DynamicsModel::Statics => "statics: at rest at every instant",
        DynamicsModel::Full => "full dynamics",
        DynamicsModel::Kinodynamic => "cells that accelerate within their force",
    }
}

/// The most differences of one declaration that are listed; the rest are counted.
const DIFFERENCES_MAX: usize = 20;

/// Returns the facts that a verdict rests on as text, one line for each declaration, with the differences from the
/// standard library where that has a declaration of the same name.
pub(super) fn rests_on(declarations: &[Declaration]) -> String {
    let mut out = String::new();
    for Declaration { facts: Facts { kind, name, words, digest }, standard, differences } in declarations {
        let as_there = match standard {
            Some(path) if differences.is_empty() => format!(", as {path}"),
            Some(_) | None => String::new(),
        };
        line(&mut out, &format!("rests on {kind} {name}{as_there} ({digest}): {words}"));
        for difference in differences.iter().take(DIFFERENCES_MAX) {
            let path = standard.as_deref().unwrap_or_default();
            line(&mut out, &format!("  differs from {path}: {difference}"));
        }
        if differences.len() > DIFFERENCES_MAX {
            line(&mut out, &format!("  and {} more differences", differences.len() - DIFFERENCES_MAX));
        }
    }
    out
}

/// Adds an indented line.
fn line(out: &mut String, text: &str) {
    out.push_str("  ");
    out.push_str(text);
    out.push('\n');
}

/// Returns the nearest multiple of `step`; smaller differences mean nothing to a reader.
fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

/// Returns a length in metres as text, to a hundredth of a millimetre.
fn length(value: f64) -> String {
    quantity(rounded(value, 1e-5), Dimension::LENGTH)
}

/// Returns duration, travel, heading and energy in words.
fn summary(verdict: &Verdict) -> String {
    let [x, y, z] = verdict.travel.map(length);
    let (duration, energy) = (quantity(verdict.duration, Dimension::TIME), number(verdict.energy));
    let heading = quantity(rounded(verdict.heading.to_degrees(), 0.01).to_radians(), Dimension::ANGLE);
    let [within, heading_within] = verdict.bounds_in_words();
    format!(
        "lasts {duration}, travels [{x}, {y}, {z}]{within}, turns {heading}{heading_within}, {energy}J, {} samples",
        verdict.samples
    )
}

/// Returns the settings of verification in words.
fn settings(plan: &Plan) -> String {
    let time = |v| quantity(v, Dimension::TIME);
    let settings = &plan.settings;
    let rule = match settings.stability {
        Stability::Footprint => "contacts with the ground",
        Stability::Centres => "centres of the lowest modules",
    };
    let (sample, unstable) = (time(settings.sample), time(settings.unstable_for));
    let mut words = format!("sampled every {sample}, unstable for {unstable} at most, support by {rule}");
    if settings.reserve > 0.0 {
        words += &format!(", with a reserve of {} %", number(100.0 * settings.reserve));
    }
    if let Some(slip) = settings.slip_max {
        words += &format!(", slip of {} at most", quantity(slip, Dimension::LENGTH));
    }
    words
}

/// Returns the status of a check in words.
fn status(status: &Status) -> String {
    match status {
        Status::Proved => "proved".to_owned(),
        Status::WithinTolerance => "within tolerance".to_owned(),
        Status::Sampled(n) => format!("holds at {n} samples"),
        Status::NotChecked(why) => format!("NOT CHECKED: {why}"),
        Status::NoLimit => "no limit stated".to_owned(),
        Status::Exempt => "exempt".to_owned(),
        Status::Failed => "FAILED".to_owned(),
    }
}

/// Adds a line for each worst value.
fn worst_lines(out: &mut String, verdict: &Verdict) {
    for (kind, worst) in verdict.worst_values() {
        let value = match kind.measure {
            Measure::Length => length(worst.value),
            Measure::Fraction => format!("{}%", number(rounded(worst.value * 100.0, 0.01))),
            Measure::Angle => quantity(worst.value, Dimension::ANGLE),
            Measure::Speed => quantity(worst.value, Dimension::SPEED),
            Measure::Number => number(rounded(worst.value, 1e-4)),
        };
        let at = if worst.at.is_empty() { String::new() } else { format!(" at {}", worst.at.join(", ")) };
        let time = quantity(worst.time, Dimension::TIME);
        line(out, &format!("{:<14} {value}, worst after {time}{at}", kind.name));
    }
}

/// Returns an exemption in words.
fn exemption_line(exemption: &Exemption, plan: &Plan) -> String {
    let kind = exemption.kind.name();
    let time = |v| quantity(v, Dimension::TIME);
    let (from, to) = (time(exemption.from), time(exemption.to));
    let cause = plan
        .causes
        .get(exemption.cause.0 as usize)
        .map_or_else(String::new, |c| format!(", by {}", cause(c)));
    format!("allows {kind} from {from} to {to}{cause}")
}

/// Adds the lines of a failure and its causes.
fn failure_lines(out: &mut String, failure: &Failure, plan: &Plan) {
    let time = quantity(failure.time, Dimension::TIME);
    line(out, &format!("failed after {time}: {}", failure.message));
    for id in &failure.blame {
        if let Some(found) = plan.causes.get(id.0 as usize) {
            line(out, &format!("  because of {}", cause(found)));
        }
    }
}

/// Returns a cause: "walkbot.mod:12: `leg[a].lift()` (a = 0)".
fn cause(cause: &Cause) -> String {
    let mut out = format!("{}:{}: `{}`", cause.file, cause.line, cause.text);
    if !cause.instance.is_empty() {
        write!(out, " ({})", cause.instance).expect("writing to a String cannot fail");
    }
    out
}
