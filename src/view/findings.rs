//! The findings of the judge as a page shows them.

use super::input::RenderInput;
use super::number::{number, vector};
use super::tolerances::TOLERANCES;
use super::truss;
use crate::geometry::Vec3;
use crate::plan::verify::articulated::collision_point;
use crate::plan::{Cause, CheckKind, Failure, Measure, Plan, Verdict, Worst, WorstKind, headline};
use crate::units::{self, Dimension, counted, quantity};
use serde_json::{Value, json};

/// Returns the time in seconds at which playing ends: that of the first failure, but for one of the plan's form, or
/// else the duration.
pub(super) fn end(plan: &Plan) -> f64 {
    let duration = plan.body.duration();
    let failures = plan.verdict.iter().flat_map(|verdict| &verdict.failures);
    // A plan whose form is wrong has no time of failure.
    let failures = failures.filter(|failure| failure.kind != CheckKind::Form);
    failures.map(|failure| failure.time).fold(duration, f64::min).clamp(0.0, duration.max(0.0))
}

/// Returns the verdict as JSON: stamp and headline, checks, worst values, failures, notes and events, and the
/// greatest part of a joint's limit that the judge found to be needed.
pub(super) fn verdict(plan: &Plan) -> Value {
    let Some(verdict) = &plan.verdict else {
        return json!({
            "stamp": "not judged", "headline": "not judged", "checks": [], "worst": [], "failures": [], "notes": [], "events": [],
        });
    };
    // Nodes that merge and split are marks of the motion.
    let marked = plan.body.node_paths().map_or_else(Vec::new, truss::events);
    let is_marked = |words: &String| marked.iter().any(|event| event["text"] == **words);
    let events = verdict.events.iter().filter(|(_, words)| !is_marked(words));
    let events = events.map(|(time, words)| json!([number(*time), words]));
    let headline = headline(plan, verdict);
    let stamp = match (verdict.ok(), headline == "verified") {
        (true, true) => "verified",
        (true, false) => "excepted",
        (false, _) => "failed",
    };
    json!({
        "stamp": stamp,
        "headline": headline,
        "load": verdict.torque_margin.as_ref().map(|worst| number(1.0 - worst.value)),
        "checks": verdict.checks.iter().map(|c| [c.kind.name().to_owned(), c.status.to_string()]).collect::<Vec<_>>(),
        "worst": worst(verdict),
        "failures": verdict.failures.iter().map(|f| failure(f, plan)).collect::<Vec<_>>(),
        "notes": verdict.notes,
        "events": events.collect::<Vec<_>>(),
    })
}

/// Returns one failure as JSON, with the indices of the modules that it names.
fn failure(failure: &Failure, plan: &Plan) -> Value {
    let modules = modules(&failure.at, plan);
    json!({
        "time": number(failure.time),
        "until": failure.until.map(number),
        "kind": failure.kind.name(),
        "message": failure.message,
        "point": meeting(failure, &modules, plan).as_ref().map(vector),
        "modules": modules,
        "blame": failure.blame.iter().map(|cause| cause.0).collect::<Vec<_>>(),
    })
}

/// Returns the point where two modules of a collision touch, in the world frame, in metres; `None` for
/// other failures.
fn meeting(failure: &Failure, modules: &[usize], plan: &Plan) -> Option<Vec3> {
    if failure.kind != CheckKind::Collision {
        return None;
    }
    let (first, last) = (*modules.first()?, *modules.last()?);
    collision_point(plan, (first, last), failure.time)
}

/// Returns the indices, in the robot's order, of the modules that the first failure names; empty if `time` (s) is not
/// the time of that failure.
pub(super) fn failed_modules(plan: &Plan, time: f64) -> Vec<usize> {
    let first = plan.verdict.as_ref().and_then(|verdict| verdict.failures.first());
    first
        .filter(|failure| (failure.time - time).abs() <= TOLERANCES.picture_time)
        .map_or_else(Vec::new, |f| modules(&f.at, plan))
}

/// Returns the indices of the modules with these names, or with links, joints or ports of these names.
fn modules(names: &[String], plan: &Plan) -> Vec<usize> {
    let Some(tracks) = plan.body.tracks() else { return vec![] };
    let mut found = Vec::new();
    for name in names {
        let belongs =
            |own: &str| name.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        let modules = tracks.robot.modules.iter().enumerate();
        let longest = modules.filter(|(_, m)| belongs(&m.name)).max_by_key(|(_, m)| m.name.len());
        found.extend(longest.map(|(index, _)| index));
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns `[time, text]` of each worst value.
fn worst(verdict: &Verdict) -> Vec<Value> {
    let line = |(kind, worst): (WorstKind, &Worst)| {
        let title = kind.title?;
        let value = match kind.measure {
            Measure::Length => quantity(short_length(worst.value), Dimension::LENGTH),
            Measure::Fraction => format!("{}%", units::number(libm::round(worst.value * 1e4) / 1e2)),
            Measure::Angle => quantity(worst.value, Dimension::ANGLE),
            Measure::Speed => quantity(worst.value, Dimension::SPEED),
            Measure::Number => units::number(worst.value),
        };
        let at = if worst.at.is_empty() { String::new() } else { format!(", {}", worst.at.join(" and ")) };
        Some(json!([number(worst.time), format!("least {title} {value}{at}")]))
    };
    verdict.worst_values().filter_map(line).collect()
}

/// Rounds a length in metres to a hundredth of a millimetre.
pub(super) fn short_length(x: f64) -> f64 {
    libm::round(x * 1e5) / 1e5
}

/// Returns the summary line below the title of a page: the number of modules, cells or struts, the duration (s) of what it
/// plays, and the distance that the plan travels over the ground.
pub(super) fn summary(input: &RenderInput, duration: f64) -> String {
    let plan = input.plan;
    let (count, what) = plan.body.units();
    let mut parts = vec![counted(count, what)];
    if duration > 0.0 {
        parts.push(quantity(libm::round(duration * 1e2) / 1e2, Dimension::TIME));
    }
    if let Some(verdict) = plan.verdict.as_ref().filter(|v| v.ok() && duration > 0.0) {
        let [x, y, _] = verdict.travel;
        let travel = libm::round(libm::hypot(x, y) * 1e3) / 1e3;
        if travel > 0.0 {
            let [within, _] = verdict.bounds_in_words();
            parts.push(format!("travels {}{within}", quantity(travel, Dimension::LENGTH)));
        }
    }
    parts.join(", ")
}

/// Returns the causes in their order, as JSON objects with file, line (from 1) and text of the source.
pub(super) fn causes(causes: &[Cause]) -> Vec<Value> {
    let place = |c: &Cause| json!({ "file": c.file, "line": c.line, "text": c.text });
    let cause = |c: &Cause| {
        let caller = c.caller.as_deref().map(place);
        json!({ "file": c.file, "line": c.line, "text": c.text, "instance": c.instance, "caller": caller })
    };
    causes.iter().map(cause).collect()
}
