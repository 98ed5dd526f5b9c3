//! The data of an articulated robot in a page: its modules, the steps of its kinematics, its tracks.

use super::fittings::fittings;
use super::ground_pose;
use super::number::{list, number, rotation, vector};
use super::solids::{Meshes, solids};
use crate::geometry::Pose;
use crate::plan::verify::articulated::ClusterPath;
use crate::plan::{DockingKind, LastingTrees, Segment, Track, Tracks, polynomial};
use crate::robot::{Assembly, JointKind, JointOwner, Kinematics, Library, ModuleType};
use crate::robot::{Motion, Step};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The most segments of joints' tracks in one page; the motion of a longer plan is sampled at even distances in time.
pub(super) const SEGMENTS_MAX: usize = 60_000;

/// The least number of samples that a joint keeps when its motion is sampled.
const POSITIONS_MIN: usize = 16;

/// Returns the robot and its motion as JSON, with lengths in metres, angles in radians and times in seconds; `base` are
/// the base poses as [`ground_pose::base`](super::ground_pose::base) gives them, and `clusters` the paths of several
/// clusters, none of one robot that stays one. Adds the meshes of links and obstacles to `meshes`, and to `notes` a
/// sentence for each thing left out.
pub(super) fn body(
    tracks: &Tracks,
    (base, clusters): (Value, &[ClusterPath]),
    meshes: &mut Meshes,
    notes: &mut Vec<String>,
) -> Value {
    let robot = &tracks.robot;
    let mut forms = Forms::default();
    let trees = trees(tracks, clusters, &mut forms);
    let mut body = json!({
        "form": "tracks",
        "kinds": robot.library.modules.iter().map(|kind| module_type(&robot.library, kind, meshes)).collect::<Vec<_>>(),
        "modules": robot.modules.iter().map(|m| json!([m.name, m.kind])).collect::<Vec<_>>(),
        "hinges": hinges(robot),
        "bonds": (0..robot.bonds.len()).map(|bond| robot.bond_name(bond)).collect::<Vec<_>>(),
        "start": list(tracks.start.joints.iter().copied()),
        "forms": forms.list,
        "trees": trees,
        "tracks": joint_tracks(tracks, notes),
        "docks": docks(tracks),
        "base": base,
    });
    if !tracks.obstacles.is_empty() {
        let around = tracks.obstacles.iter();
        body["around"] =
            around.map(|o| json!({ "name": o.name, "solids": solids(&o.shapes, meshes) })).collect();
    }
    if !clusters.is_empty() {
        body["paths"] = clusters.iter().map(|cluster| ground_pose::path(cluster.poses())).collect();
    }
    body
}

/// Returns a module type: its links with their shapes and fittings, and its joints.
fn module_type(library: &Library, kind: &ModuleType, meshes: &mut Meshes) -> Value {
    let links = kind.links.iter().enumerate().map(|(i, link)| {
        let judged = if link.collides == link.shape { Value::Null } else { solids(&link.collides, meshes) };
        let fitted = solids(&fittings(library, kind, i), meshes);
        json!({ "name": link.name, "solids": solids(&link.shape, meshes), "fittings": fitted, "collides": judged })
    });
    let joints = kind.joints.iter().map(|joint| {
        let still = joint.kind == JointKind::Fixed;
        json!({ "name": joint.name, "turns": joint.kind == JointKind::Revolute, "still": still })
    });
    json!({ "name": kind.name, "links": links.collect::<Vec<_>>(), "joints": joints.collect::<Vec<_>>() })
}

/// Returns `[name, module, module]` of each bond that is a joint, in order of joint.
fn hinges(robot: &Assembly) -> Vec<Value> {
    let hinge = |owner| match owner {
        JointOwner::Bond(bond) => {
            let between = robot.bonds[bond];
            Some(json!([robot.joint_name(owner), between.a.module, between.b.module]))
        }
        JointOwner::Module { .. } => None,
    };
    robot.joints().filter_map(hinge).collect()
}

/// Distinct transforms of kinematic steps, each once: a robot has many modules of few types.
#[derive(Default)]
struct Forms {
    list: Vec<Value>,
    known: BTreeMap<String, usize>,
}

impl Forms {
    /// Returns the index of a step's transform; adds it if it is new.
    fn index(&mut self, step: &Step) -> usize {
        let mut form = Map::new();
        form.insert("shift".into(), vector(&step.shift));
        let turn = Pose::from_parts(step.shift.into(), step.turn);
        form.insert("turn".into(), rotation(&turn));
        if let Some(axis) = step.motion.axis() {
            form.insert("axis".into(), vector(&axis));
        }
        if let Motion::Along(direction) = &step.motion {
            form.insert("along".into(), vector(direction));
        }
        if step.offset.norm() > 0.0 {
            form.insert("offset".into(), vector(&step.offset));
        }
        let form = Value::Object(form);
        *self.known.entry(form.to_string()).or_insert_with(|| {
            self.list.push(form);
            self.list.len() - 1
        })
    }
}

/// Returns the kinematic trees, one for each instant at which bonds change.
fn trees(tracks: &Tracks, clusters: &[ClusterPath], forms: &mut Forms) -> Vec<Value> {
    let mut times = vec![0.0];
    times.extend(tracks.events.iter().map(|dock| dock.time));
    times.dedup();
    let mut trees: Vec<(Vec<bool>, Value)> = Vec::new();
    for time in times {
        let bonds = tracks.bonds(time);
        if trees.last().is_none_or(|(before, _)| *before != bonds) {
            let mut made = tree(&tracks.robot, &bonds, time, forms);
            let parts = parts(tracks, &bonds, time, clusters, forms);
            if !parts.is_empty() {
                made["parts"] = parts.into();
            }
            trees.push((bonds, made));
        }
    }
    trees.into_iter().map(|(_, tree)| tree).collect()
}

/// Returns the kinematic tree for the bonds that hold from a time on, in seconds.
fn tree(robot: &Assembly, bonds: &[bool], time: f64, forms: &mut Forms) -> Value {
    let kinematics = Kinematics::new(robot, bonds, robot.base);
    let steps: Vec<Value> = kinematics.steps.iter().map(|step| step_value(step, forms)).collect();
    let loose = !kinematics.tree.loose.is_empty();
    json!({ "time": number(time), "root": kinematics.link(robot.base, 0), "steps": steps, "loose": loose })
}

/// Returns the trees of the clusters that there are at a time (s), as `{root, steps, path}`; `path` is the cluster's
/// number in `clusters`.
fn parts(
    tracks: &Tracks,
    bonds: &[bool],
    time: f64,
    clusters: &[ClusterPath],
    forms: &mut Forms,
) -> Vec<Value> {
    let robot = &tracks.robot;
    let mut found = Vec::new();
    let there = |cluster: &ClusterPath| cluster.exists(time);
    for (path, cluster) in clusters.iter().enumerate().filter(|(_, cluster)| there(cluster)) {
        let kinematics = cluster.kinematics(robot, bonds);
        let steps: Vec<Value> = kinematics.steps.iter().map(|step| step_value(step, forms)).collect();
        found.push(json!({ "root": kinematics.link(cluster.base(), 0), "steps": steps, "path": path }));
    }
    found
}

/// The trees of what hangs together during a whole simulation, with the transforms of their steps.
pub(super) struct MeasuredTrees {
    /// The trees as `{root, steps}`, the base module's first; steps are as in [`step_value`], each moved by its own joint
    /// alone.
    pub trees: Vec<Value>,
    /// The transforms of the steps.
    pub forms: Vec<Value>,
}

impl MeasuredTrees {
    /// Returns the trees of a plan's robot; `apart`: the bonds, by their indices, that are in none although they hold all
    /// the time.
    pub(super) fn new(tracks: &Tracks, apart: &[usize]) -> MeasuredTrees {
        let lasting = LastingTrees::new(tracks, &tracks.start.base, &tracks.start.clusters, apart);
        let mut forms = Forms::default();
        let mut step_of = |step: &Step| {
            let form = forms.index(step);
            let Some(joint) = lasting.joint_of[step.link] else {
                return json!([step.link, step.parent, form]);
            };
            match step.terms() {
                [(same, factor)] if *same == joint && *factor != 1.0 => {
                    json!([step.link, step.parent, form, [joint, number(*factor)]])
                }
                _ => json!([step.link, step.parent, form, joint]),
            }
        };
        let mut tree = |tree: &Kinematics| {
            let steps: Vec<Value> = tree.steps.iter().map(&mut step_of).collect();
            json!({ "root": tree.link(tree.root, 0), "steps": steps })
        };
        let trees = lasting.trees.iter().map(&mut tree).collect();
        MeasuredTrees { trees, forms: forms.list }
    }
}

/// Returns a step as `[link, parent, form, joint]`; several joints, or one with a factor, as `[joint,
/// factor, ...]`.
fn step_value(step: &Step, forms: &mut Forms) -> Value {
    let form = forms.index(step);
    match step.terms()[..] {
        [] => json!([step.link, step.parent, form]),
        [(joint, 1.0)] => json!([step.link, step.parent, form, joint]),
        _ => {
            let terms: Vec<Value> = step.terms().iter().flat_map(|&(j, f)| [json!(j), number(f)]).collect();
            json!([step.link, step.parent, form, terms])
        }
    }
}

/// Returns `[joint, segments]` of each track; a segment is `[start, end, cause, control points...]`.
fn joint_tracks(tracks: &Tracks, notes: &mut Vec<String>) -> Vec<Value> {
    let count: usize = tracks.tracks.iter().map(|t| t.segments.len()).sum();
    let thinned = count > SEGMENTS_MAX;
    let positions = (SEGMENTS_MAX / tracks.tracks.len().max(1)).max(POSITIONS_MIN);
    if thinned {
        notes.push(format!(
            "the plan has {count} segments of motion; drawn are {positions} positions of each joint, evenly in time"
        ));
    }
    let segments = |track: &Track| {
        let own: Vec<Segment> =
            if thinned { sampled(tracks, track, positions) } else { track.segments.clone() };
        own.iter().map(segment).collect::<Vec<_>>()
    };
    tracks.tracks.iter().map(|track| json!([track.joint.0, segments(track)])).collect()
}

/// Returns a segment as a list of numbers.
fn segment(segment: &Segment) -> Value {
    let mut numbers = vec![number(segment.start), number(segment.end), json!(segment.cause.0)];
    numbers.extend(segment.control.iter().map(|c| number(*c)));
    Value::Array(numbers)
}

/// Returns a track as linear segments between samples at even distances in time.
fn sampled(tracks: &Tracks, track: &Track, positions: usize) -> Vec<Segment> {
    let start = tracks.start.joints[track.joint.0 as usize];
    let time = |i: usize| tracks.duration * i as f64 / positions as f64;
    let piece = |i: usize| {
        let (from, to) = (time(i), time(i + 1));
        let control = vec![track.position(start, from), track.position(start, to)];
        let begun = track.segments.partition_point(|s| s.start < to).saturating_sub(1);
        let moving = polynomial::hull(&control);
        let cause = track.segments.get(begun)?.cause;
        (moving.0 < moving.1 || i == 0).then_some(Segment { start: from, end: to, control, cause })
    };
    (0..positions).filter_map(piece).collect()
}

/// Returns `[time, is a docking, bond, cause]` of each docking event.
fn docks(tracks: &Tracks) -> Vec<Value> {
    let dock = |d: &crate::plan::DockingEvent| {
        json!([number(d.time), d.kind == DockingKind::Dock, d.bond, d.cause.0])
    };
    tracks.events.iter().map(dock).collect()
}
