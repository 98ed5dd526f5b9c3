//! Everything that a page knows of a plan.

use super::number::number;
use super::solids::Meshes;
use super::{Showing, findings, lattice, robot, stand, truss};
use crate::plan::verify::{clearances, history};
use crate::plan::{Body, Ground, Plan};
use crate::units::{Dimension, display, quantity};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

/// Bytes of source texts in one page; beyond that only the lines that command something.
const TEXTS_MAX: usize = 400_000;

/// Points of the curve of clearances.
const CLEARANCES: usize = 160;

/// The plan's data as the page's scripts read it.
pub fn data(showing: &Showing) -> Value {
    let plan = showing.plan;
    let end = findings::end(plan);
    let moments = history(plan, end);
    let mut meshes = Meshes::default();
    let mut notes = Vec::new();
    let body = match &plan.body {
        Body::Tracks(tracks) => {
            let base = stand::base(&moments, &tracks.start.base);
            robot::body(tracks, base, &mut meshes, &mut notes)
        }
        Body::Stages(stages) => lattice::body(stages, &plan.library),
        Body::NodePaths(paths) => truss::body(paths, &plan.library),
    };
    let ground = plan.worlds.first().is_none_or(|world| world.world.ground != Ground::Off);
    json!({
        "title": showing.title,
        "summary": findings::summary(showing),
        "duration": number(plan.body.duration()),
        "end": number(end),
        "floor": 0,
        "ground": ground,
        "verdict": findings::verdict(plan),
        "causes": findings::causes(&plan.causes),
        "sources": sources(showing.texts),
        "notes": notes,
        "data": facts(plan),
        "texts": plan.provenance.sources,
        "command": showing.command,
        "meshes": meshes.list,
        "stand": stand::stands(&moments),
        "clearance": stand::curve(&clearances(plan, end, CLEARANCES)),
        "loads": stand::loads(&moments),
        "body": body,
    })
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
    if let Some(verdict) = &plan.verdict {
        facts.push(("verdict", if verdict.ok() { "verified".into() } else { "not verified".into() }));
        facts.push(("energy", format!("{}J", display::number(libm::round(verdict.energy * 1e3) / 1e3))));
        facts.push(("samples", verdict.samples.to_string()));
    }
    for from in &plan.worlds {
        let world = from.world;
        let ground = match world.ground {
            Ground::Settle => "rests on the ground",
            Ground::Fixed => "base held",
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
    let text = crate::plan::file::write(&bare).unwrap_or_default();
    Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect()
}
