//! The data of a truss plan in a page: its nodes at the keyframes of the plan.

use super::number::{list, number};
use super::solids::{Meshes, solids};
use super::surroundings;
use crate::plan::{Interpolation, Keyframe, NodePaths, Ramps, TopologyEvent};
use crate::robot::Library;
use serde_json::{Value, json};

/// Returns struts, keyframes and surroundings of a truss plan as JSON, with lengths in metres and times in seconds.
/// Adds the meshes of the surroundings to `meshes`.
pub(super) fn body(paths: &NodePaths, library: &Library, meshes: &mut Meshes) -> Value {
    let strut = library.struts.get(paths.strut);
    let (low, high) = strut.map_or((0.0, 1.0), |strut| strut.length);
    json!({
        "form": "node_paths",
        "strut": strut.map_or("strut", |strut| strut.name.as_str()),
        "range": list([low, high]),
        "nodes": paths.node_names,
        "struts": pairs(&paths.struts),
        "events": events(paths),
        "around": surroundings::solids(paths)
            .iter()
            .map(|(name, shapes)| json!({ "name": name, "solids": solids(shapes, meshes) }))
            .collect::<Vec<_>>(),
        "keyframes": paths.keyframes.iter().map(keyframe).collect::<Vec<_>>(),
    })
}

fn pairs(struts: &[(usize, usize)]) -> Vec<[usize; 2]> {
    struts.iter().map(|&(a, b)| [a, b]).collect()
}

/// Returns the nodes that merge and split, in order of time, each as JSON: the words for it, and the ends of the struts that
/// have others from then on, as [strut, node, node].
pub(super) fn events(paths: &NodePaths) -> Vec<Value> {
    let mut topology = paths.topology_at_start();
    let event = |event: &TopologyEvent| {
        let before = topology.clone();
        let words = paths.event_words(&before, &event.change);
        topology.apply(&event.change);
        let changed =
            (0..before.struts.len()).filter(|&strut| before.struts[strut] != topology.struts[strut]);
        let ends: Vec<[usize; 3]> =
            changed.map(|strut| [strut, topology.struts[strut].0, topology.struts[strut].1]).collect();
        json!({ "time": number(event.time), "text": words, "ends": ends })
    };
    paths.events.iter().map(event).collect()
}

fn keyframe(keyframe: &Keyframe) -> Value {
    let roll = match keyframe.interpolation {
        Interpolation::Linear => Value::Null,
        Interpolation::RigidRoll { edge: (a, b), angle } => json!([a, b, number(angle)]),
    };
    let at = list(keyframe.nodes.iter().flatten().copied());
    let mut data =
        json!({ "time": number(keyframe.time), "roll": roll, "at": at, "cause": keyframe.cause.0 });
    if !keyframe.ramps.is_none() {
        let Ramps { up, down, before, after } = keyframe.ramps;
        data["ramps"] = list([up, down, before, after]);
    }
    data
}
