//! Node paths as they stand in a plan file.

use super::limits::{Surroundings, TrussLimits};
use super::motion::{Keyframe, NodePaths};
use super::topology::{TopologyChange, TopologyEvent};
use crate::plan::cause::CauseId;
use crate::plan::stated::Stated;
use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A truss whose nodes move between keyframes, on straight lines or as one rigid body.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "NodePaths", deny_unknown_fields)]
pub(in crate::plan) struct NodePathsJson<'a> {
    /// Index in the library's `struts`.
    strut: usize,
    /// The name of that strut type.
    strut_name: String,
    node_names: Cow<'a, [String]>,
    /// Pairs of nodes, with which the plan begins.
    struts: Cow<'a, [(usize, usize)]>,
    /// The names of the nodes at the ends of each strut.
    strut_ends: Vec<(String, String)>,
    /// The nodes that ride along with others at the start, ascending; absent if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    merged: Vec<MergedJson>,
    /// The keyframes, in order of time; the first at 0.
    keyframes: Cow<'a, [Keyframe]>,
    /// The nodes that merge and split, in order of time; absent if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    events: Vec<TopologyEventJson>,
    /// The limits beside those of its struts.
    #[serde(default, skip_serializing_if = "is_no_limit")]
    limits: Cow<'a, TrussLimits>,
    #[serde(default, skip_serializing_if = "is_nothing_around")]
    surroundings: Cow<'a, Surroundings>,
}

/// A node that rides along with another at the start.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Merged", deny_unknown_fields)]
struct MergedJson {
    /// The node that has no struts.
    node: usize,
    /// The node that it was merged into.
    into: usize,
    /// The names of the two nodes.
    on: (String, String),
}

/// A change of the ends of struts at the time of a keyframe.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "TopologyEvent", deny_unknown_fields)]
struct TopologyEventJson {
    /// The time of the event, that of a keyframe, s.
    time: f64,
    change: TopologyChange,
    /// The names of the node that merges or splits off and of the one that it merges into or splits off from, then those
    /// of the struts that it takes along, with the ends that they have before.
    on: Vec<String>,
    cause: CauseId,
}

fn is_no_limit(limits: &TrussLimits) -> bool {
    limits.is_none()
}

fn is_nothing_around(surroundings: &Surroundings) -> bool {
    surroundings.is_none()
}

impl<'a> NodePathsJson<'a> {
    /// Returns node paths as they stand in a plan file, with names out of `library`; long lists are borrowed.
    pub(in crate::plan) fn of(paths: &'a NodePaths, library: &Library) -> NodePathsJson<'a> {
        let strut = library.struts.get(paths.strut);
        let node = |index: usize| paths.node_names.get(index).cloned().unwrap_or_default();
        let mut topology = paths.topology_at_start();
        let event = |event: &TopologyEvent| {
            let on = match &event.change {
                TopologyChange::Merge { node: merges, into } => vec![node(*merges), node(*into)],
                TopologyChange::Split { node: splits, struts } => {
                    let ends = struts.iter().filter_map(|&strut| topology.struts.get(strut));
                    let names = ends.map(|ends| paths.strut_name(*ends));
                    [node(*splits), node(topology.carrier(*splits))].into_iter().chain(names).collect()
                }
            };
            topology.apply(&event.change);
            TopologyEventJson { time: event.time, change: event.change.clone(), on, cause: event.cause }
        };
        let merged =
            |&(rides, into): &(usize, usize)| MergedJson { node: rides, into, on: (node(rides), node(into)) };
        NodePathsJson {
            events: paths.events.iter().map(event).collect(),
            merged: paths.merged.iter().map(merged).collect(),
            strut: paths.strut,
            strut_name: strut.map_or_else(String::new, |strut| strut.name.clone()),
            node_names: Cow::Borrowed(&paths.node_names),
            struts: Cow::Borrowed(&paths.struts),
            strut_ends: paths.struts.iter().map(|&(a, b)| (node(a), node(b))).collect(),
            keyframes: Cow::Borrowed(&paths.keyframes),
            limits: Cow::Borrowed(&paths.limits),
            surroundings: Cow::Borrowed(&paths.surroundings),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(in crate::plan) fn names(&self, stated: &mut Stated) {
        stated.add("strut type", &self.strut_name);
        for (a, b) in &self.strut_ends {
            stated.add("the first node of strut", a);
            stated.add("the second node of strut", b);
        }
        for MergedJson { on: (a, b), .. } in &self.merged {
            stated.add("a node that rides along", a);
            stated.add("the node that it rides on", b);
        }
        self.events.iter().for_each(|event| stated.add_all("event subject", &event.on));
    }

    /// Returns the node paths that stand in a file; nothing is checked.
    pub(in crate::plan) fn into_node_paths(self) -> NodePaths {
        NodePaths {
            strut: self.strut,
            node_names: self.node_names.into_owned(),
            struts: self.struts.into_owned(),
            merged: self.merged.into_iter().map(|merged| (merged.node, merged.into)).collect(),
            keyframes: self.keyframes.into_owned(),
            events: self
                .events
                .into_iter()
                .map(|TopologyEventJson { time, change, cause, .. }| TopologyEvent { time, change, cause })
                .collect(),
            limits: self.limits.into_owned(),
            surroundings: self.surroundings.into_owned(),
        }
    }
}
