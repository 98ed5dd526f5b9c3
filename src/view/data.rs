//! The data of a plan that a page holds, as JSON.

use super::input::RenderInput;
use super::number::{list, number};
use super::solids::Meshes;
use super::{findings, ground_pose, lattice, robot, surroundings, truss};
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::articulated::{CONTACTS_MAX, ClusterPaths, Moment, clearances, history};
use crate::plan::{Body, Ground, ObjectiveValue, Plan, file, headline};
use crate::units::{self, Dimension, quantity};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The most bytes of source texts in one page; if there are more, no text is included.
const TEXTS_MAX: usize = 400_000;

/// The number of samples of the clearance curve.
const CLEARANCES: usize = 160;

/// Returns the data of a plan as the page's scripts read it: a JSON object with lengths in metres, times in seconds
/// and angles in radians; clearances alone are in millimetres.
pub(super) fn data(input: &RenderInput) -> Value {
    let plan = input.plan;
    let end = findings::end(plan);
    let moments = history(plan, end);
    let mut notes = Vec::new();
    let mut data = motion(input, &moments, end, &mut notes);
    let (contacts, in_part) = ground_pose::contacts(&moments);
    if in_part {
        notes.push(format!("of the contacts with the ground {CONTACTS_MAX} at most are marked"));
    }
    data["clearance"] = clearance(plan, end, &mut notes).into();
    data["notes"] = notes.into();
    data["stand"] = ground_pose::supports(&moments).into();
    data["contacts"] = contacts.into();
    data["loads"] = ground_pose::loads(&moments);
    data
}

/// Returns the same with the surface that a truss takes on, given by the corners of its triangles, m, in the world's frame.
pub(super) fn with_target(input: &RenderInput, target: &[[Vec3; 3]]) -> Value {
    let mut data = data(input);
    let mut known = BTreeMap::new();
    let mut points = Vec::new();
    let triangles = target.iter().flatten().map(|p| {
        *known.entry([p.x, p.y, p.z].map(f64::to_bits)).or_insert_with(|| {
            points.extend([p.x, p.y, p.z]);
            points.len() / 3 - 1
        })
    });
    let triangles: Vec<usize> = triangles.collect();
    let radius = target.iter().flatten().map(Vec3::norm).fold(0.0, f64::max);
    let mesh = json!({ "points": list(points), "triangles": triangles, "radius": number(radius) });
    if let Some(meshes) = data["meshes"].as_array_mut() {
        meshes.push(mesh);
        data["target"] = json!(meshes.len() - 1);
    }
    data
}

/// Returns the same of the whole motion of a plan alone, without what is judged of it. `X_WP`: the pose of the plan's world
/// in that of the page.
#[allow(non_snake_case)]
pub(super) fn nominal(input: &RenderInput, X_WP: &Pose) -> Value {
    let plan = input.plan;
    let end = plan.body.duration();
    let mut notes = Vec::new();
    let mut moments = history(plan, end);
    moments.iter_mut().for_each(|moment| moment.base = X_WP * moment.base);
    let mut data = motion(input, &moments, end, &mut notes);
    data["notes"] = notes.into();
    for none in ["clearance", "stand", "contacts"] {
        data[none] = json!([]);
    }
    data["loads"] = Value::Null;
    data
}

/// Returns the data of a plan's motion up to `end` (s), by the judge's rollout, and of the texts around it. Adds to `notes` a
/// sentence for each thing left out.
fn motion(input: &RenderInput, moments: &[Moment], end: f64, notes: &mut Vec<String>) -> Value {
    let plan = input.plan;
    let mut meshes = Meshes::default();
    // The motion, by the family of the plan.
    let body = match &plan.body {
        Body::Tracks(tracks) => {
            let base = ground_pose::base(moments, &tracks.start.base);
            let paths = ClusterPaths::of(plan, end).map_or(vec![], |paths| paths.clusters);
            robot::body(tracks, (base, &paths), &mut meshes, notes)
        }
        Body::Stages(stages) => lattice::body(stages, &plan.library),
        Body::NodePaths(paths) => truss::body(paths, &plan.library, &mut meshes),
    };
    let mut data = json!({
        "title": input.title,
        "summary": findings::summary(input, input.plan.body.duration()),
        "duration": number(plan.body.duration()),
        "end": number(end),
        "floor": 0,
        "ground": surroundings::floor(plan),
        "goal": plan.provenance.shapes.is_some(),
        "verdict": findings::verdict(plan),
        "causes": findings::causes(&plan.causes),
        "sources": sources(input.texts),
        "data": facts(plan),
        "texts": plan.provenance.sources,
        "command": input.command,
        "meshes": meshes.list,
        "body": body,
    });
    if let Some(slope) = surroundings::slope(plan) {
        data["slope"] = json!(slope);
    }
    data
}

/// Returns the clearance curve through the least clearance that the judge found. Adds a note where it is
/// sampled.
fn clearance(plan: &Plan, end: f64, notes: &mut Vec<String>) -> Vec<Value> {
    let points = clearances(plan, end, CLEARANCES);
    if (2..=CLEARANCES).contains(&points.len()) {
        notes.push(format!("the curve of clearances goes through {} instants, evenly in time", points.len()));
    }
    let worst = plan.verdict.iter().find_map(|verdict| verdict.clearance.as_ref());
    ground_pose::curve(points, worst.filter(|worst| worst.time <= end).map(|worst| (worst.time, worst.value)))
}

/// Returns the source texts with their lines, numbered from 1.
fn sources(texts: &[(String, String)]) -> Vec<Value> {
    if texts.iter().map(|(_, text)| text.len()).sum::<usize>() > TEXTS_MAX {
        return vec![];
    }
    let lines =
        |text: &str| text.lines().enumerate().map(|(i, line)| json!([i + 1, line])).collect::<Vec<_>>();
    texts.iter().map(|(name, text)| json!({ "name": name, "lines": lines(text) })).collect()
}

/// Returns the facts about a plan that its page lists, as (name, text).
fn facts(plan: &Plan) -> Vec<(&'static str, String)> {
    let time = |t| quantity(t, Dimension::TIME);
    let made = &plan.provenance;
    let mut facts = vec![("planner", made.planner.clone()), ("tool", made.tool.clone())];
    facts.extend(made.seed.map(|seed| ("seed", seed.to_string())));
    facts.extend(made.budget.map(|budget| ("budget", budget.to_string())));
    facts.push(("duration", time(plan.body.duration())));
    let energy = |ObjectiveValue::FoldingEnergy(value)| quantity(value, Dimension::ENERGY);
    facts.extend(made.reached.map(|reached| ("folding energy", energy(reached))));
    facts.extend(made.bound.map(|bound| ("lower bound", format!("no folding is below {}", energy(bound)))));
    if let Some(verdict) = &plan.verdict {
        facts.push(("verdict", headline(plan, verdict)));
        facts.push(("energy", format!("{}J", units::rounded(verdict.energy, 3))));
        facts.push(("samples", verdict.samples.to_string()));
        facts.extend(verdict.dynamics.iter().flat_map(|d| d.in_words(plan.body.duration())));
    }
    for from in &plan.worlds {
        let world = from.world;
        let ground = match world.ground {
            Ground::Settle if world.is_sloped() => "rests on a slope",
            Ground::Settle => "rests on the ground",
            Ground::Fixed => "base kept on the ground",
            Ground::Held => "base held fast",
            Ground::Off => "no ground",
        };
        let slope = match world.is_sloped() {
            true => format!(" of {}", quantity(world.slope_angle(), Dimension::ANGLE)),
            false => String::new(),
        };
        let words = format!(
            "{ground}{slope}, gravity {}m/s^2, friction x {}",
            units::number(world.gravity),
            units::number(world.friction)
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

/// Returns the digest of the plan file without its verdict.
fn hash(plan: &Plan) -> String {
    let bare = Plan { verdict: None, ..plan.clone() };
    file::digest(&file::write(&bare).unwrap_or_default())
}
