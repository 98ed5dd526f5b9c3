//! What the judge found, as a page tells it.

use super::RenderInput;
use super::number::{number, vector};
use crate::geometry::Vec3;
use crate::plan::verify::articulated::collision_point;
use crate::plan::{Body, Cause, CheckKind, Failure, Plan, Verdict, Worst};
use crate::units::{Dimension, display, quantity};
use serde_json::{Value, json};

/// A picture within this of a failure shows it, s.
const TOL_TIME: f64 = 1e-3;

/// Until when a plan is played: a failed one up to its first failure, s.
pub(super) fn end(plan: &Plan) -> f64 {
    let duration = plan.body.duration();
    let failures = plan.verdict.iter().flat_map(|verdict| &verdict.failures);
    // What could not be judged at all failed at no time.
    let failures = failures.filter(|failure| failure.kind != CheckKind::Form);
    failures.map(|failure| failure.time).fold(duration, f64::min).clamp(0.0, duration.max(0.0))
}

pub(super) fn verdict(plan: &Plan) -> Value {
    let Some(verdict) = &plan.verdict else {
        return json!({
            "stamp": "not judged", "checks": [], "worst": [], "failures": [], "notes": [], "events": [],
        });
    };
    let events = verdict.events.iter().map(|(time, words)| json!([number(*time), words]));
    json!({
        "stamp": if verdict.ok() { "verified" } else { "failed" },
        "checks": verdict.checks.iter().map(|c| [c.kind.name().to_owned(), c.status.to_string()]).collect::<Vec<_>>(),
        "worst": worst(verdict),
        "failures": verdict.failures.iter().map(|f| failure(f, plan)).collect::<Vec<_>>(),
        "notes": verdict.notes,
        "events": events.collect::<Vec<_>>(),
    })
}

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

/// Where two modules of a collision meet, in the world, m.
fn meeting(failure: &Failure, modules: &[usize], plan: &Plan) -> Option<Vec3> {
    if failure.kind != CheckKind::Collision {
        return None;
    }
    let (first, last) = (*modules.first()?, *modules.last()?);
    collision_point(plan, (first, last), failure.time)
}

/// The modules that the first failure names, if a time is its own.
pub(super) fn failed_modules(plan: &Plan, time: f64) -> Vec<usize> {
    let first = plan.verdict.as_ref().and_then(|verdict| verdict.failures.first());
    first
        .filter(|failure| (failure.time - time).abs() <= TOL_TIME)
        .map_or_else(Vec::new, |f| modules(&f.at, plan))
}

/// The modules that are named, or whose links, joints or ports are.
fn modules(names: &[String], plan: &Plan) -> Vec<usize> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
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

/// `[time, words]` of each worst value.
fn worst(verdict: &Verdict) -> Vec<Value> {
    let length = |x: f64| quantity(short_length(x), Dimension::LENGTH);
    let percent = |x: f64| format!("{}%", display::number(libm::round(x * 1e4) / 1e2));
    let line = |name: &str, worst: &Option<Worst>, words: &dyn Fn(f64) -> String| {
        worst.as_ref().map(|w| {
            let at = if w.at.is_empty() { String::new() } else { format!(", {}", w.at.join(" and ")) };
            json!([number(w.time), format!("least {name} {}{at}", words(w.value))])
        })
    };
    let lines = [
        line("clearance", &verdict.clearance, &length),
        line("margin of stability", &verdict.margin, &length),
        line("torque margin", &verdict.torque_margin, &percent),
        line("bond margin", &verdict.bond_margin, &percent),
        line("speed margin", &verdict.speed_margin, &percent),
        line("angle", &verdict.angle, &|v| quantity(v, Dimension::ANGLE)),
        line("rigidity", &verdict.rigidity, &|v| display::number(v)),
    ];
    lines.into_iter().flatten().collect()
}

/// To a hundredth of a millimetre.
fn short_length(x: f64) -> f64 {
    libm::round(x * 1e5) / 1e5
}

/// One line below the title.
pub(super) fn summary(input: &RenderInput) -> String {
    let plan = input.plan;
    let (count, what) = match &plan.body {
        Body::Tracks(tracks) => (tracks.robot.modules.len() as u64, "module"),
        Body::Stages(stages) => (stages.count, "cell"),
        Body::NodePaths(paths) => (paths.struts.len() as u64, "strut"),
    };
    let mut parts = vec![format!("{count} {what}{}", if count == 1 { "" } else { "s" })];
    let duration = plan.body.duration();
    if duration > 0.0 {
        parts.push(quantity(libm::round(duration * 1e2) / 1e2, Dimension::TIME));
    }
    if let Some(verdict) = plan.verdict.as_ref().filter(|v| v.ok() && duration > 0.0) {
        let [x, y, _] = verdict.travel;
        let travel = libm::round(libm::hypot(x, y) * 1e3) / 1e3;
        if travel > 0.0 {
            parts.push(format!("travels {}", quantity(travel, Dimension::LENGTH)));
        }
    }
    parts.join(", ")
}

pub(super) fn causes(causes: &[Cause]) -> Vec<Value> {
    let place = |c: &Cause| json!({ "file": c.file, "line": c.line, "text": c.text });
    let cause = |c: &Cause| {
        let caller = c.caller.as_deref().map(place);
        json!({ "file": c.file, "line": c.line, "text": c.text, "instance": c.instance, "caller": caller })
    };
    causes.iter().map(cause).collect()
}
