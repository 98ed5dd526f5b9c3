//! The headline of a verdict, with what it excuses.

use super::body::Body;
use super::cause::Cause;
use super::listing::listed;
use super::motion_plan::Plan;
use super::verdict::{CheckKind, Verdict};
use super::world::{DynamicsModel, ExemptionKind, World, WorldFrom};
use std::collections::{BTreeMap, BTreeSet};

/// The beginning of the name of a file of the standard library.
const LIBRARY: &str = "std/";

/// Returns the headline of a verdict on a plan: `not verified`, or `verified under` the dynamics by which it was
/// judged, with the excused checks and the lines of the source that excuse them: `verified under full dynamics,
/// except torque (allowed at line 40)`. `verdict`: one on this plan, to whose exemptions it refers.
pub fn headline(plan: &Plan, verdict: &Verdict) -> String {
    headline_under(plan, &plan.worlds, verdict)
}

/// Returns the headline of a verdict as [`headline`] does, for a plan that was judged in `worlds` instead of its own.
pub fn headline_under(plan: &Plan, worlds: &[WorldFrom], verdict: &Verdict) -> String {
    if !verdict.ok() {
        return "not verified".to_owned();
    }
    let excused = excused(plan, verdict);
    let verified = format!("verified under {}", judged_under(plan, worlds).words());
    if excused.is_empty() { verified } else { format!("{verified}, except {}", listed(&excused)) }
}

/// Returns the dynamics that a plan is judged under in some worlds: full dynamics if one of them asks for them.
pub fn judged_under(plan: &Plan, worlds: &[WorldFrom]) -> DynamicsModel {
    let full = worlds.iter().find(|from| from.world.dynamics == DynamicsModel::Full);
    let world = full.or(worlds.first()).map_or(World::FREE, |from| from.world);
    plan.body.dynamics(&world)
}

/// Returns each check of which a verdict needed an exemption, with the lines that allow it.
fn excused(plan: &Plan, verdict: &Verdict) -> Vec<String> {
    let mut lines: BTreeMap<CheckKind, BTreeSet<(&str, usize)>> = BTreeMap::new();
    for (index, exemption) in plan.exemptions.iter().enumerate() {
        if !verdict.unneeded_exemptions.contains(&index) {
            let cause = plan.causes.get(exemption.cause.0 as usize);
            lines.entry(check(&exemption.kind, &plan.body)).or_default().extend(cause.map(position));
        }
    }
    let files: BTreeSet<&str> = lines.values().flatten().map(|(file, _)| *file).collect();
    let own = if files.len() == 1 { files.first().filter(|file| !file.starts_with(LIBRARY)) } else { None };
    let words = |(check, positions): (&CheckKind, &BTreeSet<(&str, usize)>)| {
        let lines: Vec<String> =
            positions.iter().map(|(file, line)| line_of(file, *line, own.is_none())).collect();
        let allowed =
            if lines.is_empty() { "allowed".to_owned() } else { format!("allowed at {}", listed(&lines)) };
        format!("{} ({allowed})", check.name())
    };
    lines.iter().map(words).collect()
}

/// Returns the check that an exemption excuses in a plan of this body.
fn check(kind: &ExemptionKind, body: &Body) -> CheckKind {
    match kind {
        ExemptionKind::Overload(_) if matches!(body, Body::NodePaths(_)) => CheckKind::StrutLoad,
        ExemptionKind::Unstable => CheckKind::Stability,
        ExemptionKind::Slip => CheckKind::Slip,
        ExemptionKind::Collision(_) => CheckKind::Collision,
        ExemptionKind::Overload(_) | ExemptionKind::Saturation => CheckKind::Torque,
        ExemptionKind::Acceleration => CheckKind::Acceleration,
        ExemptionKind::Balance => CheckKind::Balance,
        ExemptionKind::Traction => CheckKind::Traction,
    }
}

/// Returns the file and the line of a cause.
fn position(cause: &Cause) -> (&str, usize) {
    (&cause.file, cause.line)
}

fn line_of(file: &str, line: usize, named: bool) -> String {
    if named { format!("line {line} of {file}") } else { format!("line {line}") }
}
