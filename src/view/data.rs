//! Everything that a page knows of a plan.

use super::number::number;
use super::solids::Meshes;
use super::{RenderInput, findings, ground_pose, lattice, robot, surroundings, truss};
use crate::plan::verify::articulated::{CONTACTS_MAX, clearances, history};
use crate::plan::{Body, Bound, Ground, Plan, file};
use crate::units::{Dimension, display, quantity};
use serde_json::{Value, json};

/// Bytes of source texts in one page; beyond that only the lines that command something.
const TEXTS_MAX: usize = 400_000;

/// Points of the curve of clearances.
const CLEARANCES: usize = 160;

/// The plan's data as the page's scripts read it.
pub(super) fn data(input: &RenderInput) -> Value {
    let plan = input.plan;
    let end = findings::end(plan);
    let moments = history(plan, end);
    let mut meshes = Meshes::default();
    let mut notes = Vec::new();
    let body = match &plan.body {
        Body::Tracks(tracks) => {
            let base = ground_pose::base(&moments, &tracks.start.base);
            robot::body(tracks, base, &mut meshes, &mut notes)
        }
        Body::Stages(stages) => lattice::body(stages, &plan.library),
        Body::NodePaths(paths) => truss::body(paths, &plan.library, &mut meshes),
    };
    let (contacts, in_part) = ground_pose::contacts(&moments);
    if in_part {
        notes.push(format!("of the contacts with the ground {CONTACTS_MAX} at most are marked"));
    }
    let clearance = clearance(plan, end, &mut notes);
    json!({
        "title": input.title,
        "summary": findings::summary(input),
        "duration": number(plan.body.duration()),
        "end": number(end),
        "floor": 0,
        "ground": surroundings::floor(plan),
        "verdict": findings::verdict(plan),
        "causes": findings::causes(&plan.causes),
        "sources": sources(input.texts),
        "notes": notes,
        "data": facts(plan),
        "texts": plan.provenance.sources,
        "command": input.command,
        "meshes": meshes.list,
        "stand": ground_pose::supports(&moments),
        "contacts": contacts,
        "clearance": clearance,
        "loads": ground_pose::loads(&moments),
        "body": body,
    })
}

/// The curve of clearances, through the least that the judge found.
fn clearance(plan: &Plan, end: f64, notes: &mut Vec<String>) -> Vec<Value> {
    let points = clearances(plan, end, CLEARANCES);
    if (2..=CLEARANCES).contains(&points.len()) {
        notes.push(format!("the curve of clearances goes through {} instants, evenly in time", points.len()));
    }
    let worst = plan.verdict.iter().find_map(|verdict| verdict.clearance.as_ref());
    ground_pose::curve(points, worst.filter(|worst| worst.time <= end).map(|worst| (worst.time, worst.value)))
}

fn sources(texts: &[(String, String)]) -> Vec<Value> {
    if texts.iter().map(|(_, text)| text.len()).sum::<usize>() > TEXTS_MAX {
        return vec![];
    }
    let lines =
        |text: &str| text.lines().enumerate().map(|(i, line)| json!([i + 1, line])).collect::<Vec<_>>();
    texts.iter().map(|(name, text)| json!({ "name": name, "lines": lines(text) })).collect()
}

/// What a person wants to know of a plan, as (name, words).
fn facts(plan: &Plan) -> Vec<(&'static str, String)> {
    let time = |t| quantity(t, Dimension::TIME);
    let made = &plan.provenance;
    let mut facts = vec![("planner", made.planner.clone()), ("tool", made.tool.clone())];
    facts.extend(made.seed.map(|seed| ("seed", seed.to_string())));
    facts.extend(made.budget.map(|budget| ("budget", budget.to_string())));
    facts.push(("duration", time(plan.body.duration())));
    facts.extend(made.bound.map(|Bound::FoldingEnergy(least)| {
        ("lower bound", format!("no such pattern folds with less than {}J", display::number(least)))
    }));
    if let Some(verdict) = &plan.verdict {
        facts.push(("verdict", if verdict.ok() { "verified".into() } else { "not verified".into() }));
        facts.push(("energy", format!("{}J", display::number(libm::round(verdict.energy * 1e3) / 1e3))));
        facts.push(("samples", verdict.samples.to_string()));
        facts.extend(verdict.dynamics.iter().flat_map(|d| d.in_words(plan.body.duration())));
    }
    for from in &plan.worlds {
        let world = from.world;
        let ground = match world.ground {
            Ground::Settle => "rests on the ground",
            Ground::Fixed => "base kept on the ground",
            Ground::Held => "base held fast",
            Ground::Off => "no ground",
        };
        let words = format!(
            "{ground}, gravity {}m/s^2, friction x {}",
            display::number(world.gravity),
            display::number(world.friction)
        );
        facts.push((
            "world",
            if from.from > 0.0 { format!("from {}: {words}", time(from.from)) } else { words },
        ));
    }
    facts.push(("sampled every", time(plan.settings.sample)));
    facts.push(("unstable for", format!("{} at most", time(plan.settings.unstable_for))));
    facts.push(("plan, SHA-256", hash(plan)));
    facts
}

/// Of the plan file without its verdict.
fn hash(plan: &Plan) -> String {
    let bare = Plan { verdict: None, ..plan.clone() };
    file::digest(&file::write(&bare).unwrap_or_default())
}
