//! The topology of a truss, which nodes each strut ends at, and the events that change it: nodes that merge and split.
//!
//! Indices of nodes and struts stay for the whole plan; an event changes the ends of struts. A node that is merged into
//! another has no struts, and rides along in the same place until it is split off again.

use super::motion::NodePaths;
use crate::plan::cause::CauseId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A change of the topology of a truss at the time of a keyframe. Events of one keyframe follow each other in the order of
/// the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TopologyEvent {
    /// The time of the event, that of a keyframe, s.
    pub time: f64,
    /// The nodes that merge or split.
    pub change: TopologyChange,
    /// The index in the plan's causes of the source command that this event comes from.
    pub cause: CauseId,
}

/// A change of the ends of struts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TopologyChange {
    /// All struts that end at a node end at another one from now on, in the same place.
    Merge {
        /// The index of the node that loses its struts, and rides along from now on.
        node: usize,
        /// The index of the node into which it merges.
        into: usize,
    },
    /// A node that rides along takes some struts of the node that it rides on, and moves on its own from now on.
    Split {
        /// The index of the node that takes struts.
        node: usize,
        /// The indices of the struts that it takes, ascending.
        struts: Vec<usize>,
    },
}

impl TopologyChange {
    /// Returns the index of the node that merges into another, or splits off.
    pub fn node(&self) -> usize {
        match self {
            TopologyChange::Merge { node, .. } | TopologyChange::Split { node, .. } => *node,
        }
    }
}

/// The ends of the struts of a truss at an instant, and which nodes ride along with others.
#[derive(Clone, Debug, PartialEq)]
pub struct Topology {
    /// The struts, by their index in the plan, each a pair of indices of nodes.
    pub struts: Vec<(usize, usize)>,
    /// The node that each node was merged into, by its index; `None` for nodes that move on their own.
    pub merged: Vec<Option<usize>>,
}

impl Topology {
    /// Returns the node that a node rides along with, which moves on its own; the node itself if that is one.
    pub fn carrier(&self, node: usize) -> usize {
        let mut carrier = node;
        // In a sound plan no node rides on itself.
        for _ in 0..self.merged.len() {
            match self.merged.get(carrier).copied().flatten() {
                Some(into) => carrier = into,
                None => break,
            }
        }
        carrier
    }

    /// Returns the indices of the nodes that move on their own, ascending.
    pub fn free_nodes(&self) -> Vec<usize> {
        (0..self.merged.len()).filter(|&node| self.merged[node].is_none()).collect()
    }

    /// Returns the nodes that ride along, each with the node that it was merged into, ascending.
    pub fn riders(&self) -> Vec<(usize, usize)> {
        self.merged.iter().enumerate().filter_map(|(node, into)| Some((node, (*into)?))).collect()
    }

    /// Returns the indices of the struts that end at a node, ascending.
    pub fn struts_at(&self, node: usize) -> Vec<usize> {
        let ends_there = |strut: &usize| self.struts[*strut].0 == node || self.struts[*strut].1 == node;
        (0..self.struts.len()).filter(ends_there).collect()
    }

    /// Changes the topology, and returns the change that takes it back. Indices without a node or strut change nothing.
    pub fn apply(&mut self, change: &TopologyChange) -> TopologyChange {
        let node = change.node();
        let (struts, from, to, merged, back) = match change {
            TopologyChange::Merge { into, .. } => {
                let struts = self.struts_at(node);
                let back = TopologyChange::Split { node, struts: struts.clone() };
                (struts, node, self.carrier(*into), Some(*into), back)
            }
            TopologyChange::Split { struts, .. } => {
                let into = self.merged.get(node).copied().flatten().unwrap_or(node);
                (struts.clone(), self.carrier(node), node, None, TopologyChange::Merge { node, into })
            }
        };
        for strut in struts {
            let Some(ends) = self.struts.get_mut(strut) else { continue };
            for end in [&mut ends.0, &mut ends.1] {
                if *end == from {
                    *end = to;
                }
            }
        }
        if let Some(entry) = self.merged.get_mut(node) {
            *entry = merged;
        }
        back
    }
}

impl NodePaths {
    /// Returns the topology with which the plan begins, before its events.
    pub fn topology_at_start(&self) -> Topology {
        let mut merged = vec![None; self.node_names.len()];
        for &(node, into) in &self.merged {
            if let Some(entry) = merged.get_mut(node) {
                *entry = Some(into);
            }
        }
        Topology { struts: self.struts.clone(), merged }
    }

    /// Returns the topology at a time `t` (s), after the events of that time.
    pub fn topology(&self, t: f64) -> Topology {
        let mut topology = self.topology_at_start();
        for event in self.events.iter().take_while(|event| event.time <= t) {
            topology.apply(&event.change);
        }
        topology
    }

    /// Returns the topology at the end of the plan, after all events.
    pub fn topology_at_end(&self) -> Topology {
        self.topology(f64::INFINITY)
    }

    /// Returns the ends of each strut at a time `t` (s), after the events of that time, by the index of the strut.
    pub fn struts(&self, t: f64) -> Vec<(usize, usize)> {
        if self.events.first().is_none_or(|event| event.time > t) {
            return self.struts.clone();
        }
        self.topology(t).struts
    }

    /// Returns the name that reports give to a strut with these ends: the names of its nodes, `a -- b`.
    pub fn strut_name(&self, (a, b): (usize, usize)) -> String {
        let name = |node: usize| self.node_names.get(node).map_or("", String::as_str);
        format!("{} -- {}", name(a), name(b))
    }

    /// Returns an event in words: which node merges into which, or which struts it takes along as it splits off. `before`:
    /// the topology before it.
    pub fn event_words(&self, before: &Topology, change: &TopologyChange) -> String {
        let name = |node: usize| self.node_names.get(node).map_or("", String::as_str);
        match change {
            TopologyChange::Merge { node, into } => {
                format!("{} merges into {}", name(*node), name(before.carrier(*into)))
            }
            TopologyChange::Split { node, struts } => {
                let count = crate::units::counted(struts.len(), "strut");
                format!("{} splits off {} with {count}", name(*node), name(before.carrier(*node)))
            }
        }
    }
}
