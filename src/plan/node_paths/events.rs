//! The validation of the events of a truss: nodes that merge in one place, and split.

use super::fault::NodePathsFault;
use super::motion::{Keyframe, NodePaths};
use super::topology::{Topology, TopologyChange, TopologyEvent};
use crate::geometry::Vec3;
use crate::plan::fault::{PlanFault, need, need_index};
use crate::plan::tolerances::TOLERANCES;
use std::collections::BTreeSet;

/// The greatest number of events of a truss's plan, and of nodes that ride along at its start: each event takes the judge as
/// long as a keyframe.
pub const TOPOLOGY_EVENTS_MAX: usize = 1000;

impl NodePaths {
    /// Checks that nodes that ride along at the start have no struts and ride on others, that every event is at the time of a
    /// keyframe, in order, and that merges and splits can be done: the nodes are there, the one is free or rides along, no
    /// strut joins nodes that merge, and no two struts have the same ends. `causes`: the number of causes of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(super) fn validate_events(&self, causes: usize) -> Result<(), PlanFault> {
        let (count, most) = (self.events.len().max(self.merged.len()), TOPOLOGY_EVENTS_MAX);
        need(count <= most, || NodePathsFault::EventCount { count, most })?;
        if self.events.is_empty() && self.merged.is_empty() {
            return Ok(());
        }
        for &(node, into) in &self.merged {
            need_index(node, self.node_names.len(), "node")?;
            need_index(into, self.node_names.len(), "node")?;
        }
        let ascending = self.merged.windows(2).all(|pair| pair[0].0 < pair[1].0);
        need(ascending, || NodePathsFault::MergedOrder)?;
        let mut topology = self.topology_at_start();
        let name = |node: usize| self.node_names[node].clone();
        for &(node, _) in &self.merged {
            let rests_on_one = topology.merged[topology.carrier(node)].is_none();
            need(rests_on_one, || NodePathsFault::RidesOnItself { node: name(node) })?;
            let bare = topology.struts_at(node).is_empty();
            need(bare, || NodePathsFault::RiderWithStruts { node: name(node) })?;
        }
        if let Some(twice) = twice(&topology) {
            return Err(NodePathsFault::DoubleStrut { time: 0.0, strut: self.strut_name(twice) }.into());
        }
        let mut before = 0.0;
        for event in &self.events {
            let time = event.time;
            let there = self.keyframes.binary_search_by(|keyframe| keyframe.time.total_cmp(&time)).is_ok();
            need(there && time >= before, || NodePathsFault::EventTime { time })?;
            before = time;
            need_index(event.cause.0 as usize, causes, "cause")?;
            self.validate_event(&topology, event)?;
            topology.apply(&event.change);
            if let Some(twice) = twice(&topology) {
                return Err(NodePathsFault::DoubleStrut { time, strut: self.strut_name(twice) }.into());
            }
        }
        Ok(())
    }

    fn validate_event(&self, before: &Topology, event: &TopologyEvent) -> Result<(), PlanFault> {
        let time = event.time;
        let name = |node: usize| self.node_names[node].clone();
        need_index(event.change.node(), self.node_names.len(), "node")?;
        match &event.change {
            &TopologyChange::Merge { node, into } => {
                need_index(into, self.node_names.len(), "node")?;
                let free = before.merged[node].is_none();
                need(free, || NodePathsFault::MergesTwice { time, node: name(node) })?;
                let carrier = before.carrier(into);
                need(carrier != node, || NodePathsFault::MergesIntoItself { time, node: name(node) })?;
                let struts = before.struts_at(node);
                need(!struts.is_empty(), || NodePathsFault::WithoutStruts { time, node: name(node) })?;
                let joins = |strut: &&usize| {
                    let (a, b) = before.struts[**strut];
                    a == carrier || b == carrier
                };
                match struts.iter().find(joins) {
                    Some(&strut) => {
                        let strut = self.strut_name(before.struts[strut]);
                        Err(NodePathsFault::MergesStrut { time, strut }.into())
                    }
                    None => Ok(()),
                }
            }
            TopologyChange::Split { node, struts } => {
                let rides = before.merged[*node].is_some();
                need(rides, || NodePathsFault::SplitsNothing { time, node: name(*node) })?;
                need(!struts.is_empty(), || NodePathsFault::WithoutStruts { time, node: name(*node) })?;
                struts.iter().try_for_each(|&strut| need_index(strut, self.struts.len(), "strut"))?;
                let ascending = struts.windows(2).all(|pair| pair[0] < pair[1]);
                need(ascending, || NodePathsFault::SplitOrder { time, node: name(*node) })?;
                let carrier = before.carrier(*node);
                let elsewhere = |strut: &&usize| {
                    let (a, b) = before.struts[**strut];
                    a != carrier && b != carrier
                };
                match struts.iter().find(elsewhere) {
                    Some(&strut) => {
                        let (strut, node) = (self.strut_name(before.struts[strut]), name(carrier));
                        Err(NodePathsFault::SplitsElsewhere { time, strut, node }.into())
                    }
                    None => Ok(()),
                }
            }
        }
    }

    /// Checks that nodes are in one place where they merge and where they split, and in all keyframes between. The events
    /// must have been validated.
    ///
    /// # Errors
    /// [`NodePathsFault::Apart`] for the first node that is elsewhere.
    pub(super) fn check_meetings(&self) -> Result<(), PlanFault> {
        if self.events.is_empty() && self.merged.is_empty() {
            return Ok(());
        }
        let mut topology = self.topology_at_start();
        let mut events = self.events.iter().peekable();
        for keyframe in &self.keyframes {
            self.check_together(&topology, keyframe)?;
            while let Some(event) = events.next_if(|event| event.time <= keyframe.time) {
                topology.apply(&event.change);
                self.check_together(&topology, keyframe)?;
            }
        }
        Ok(())
    }

    fn check_together(&self, topology: &Topology, keyframe: &Keyframe) -> Result<(), PlanFault> {
        for (node, _) in topology.riders() {
            let carrier = topology.carrier(node);
            let place = |node: usize| Vec3::from(keyframe.nodes[node]);
            let distance = (place(node) - place(carrier)).norm();
            need(distance <= TOLERANCES.meeting, || NodePathsFault::Apart {
                time: keyframe.time,
                node: self.node_names[node].clone(),
                into: self.node_names[carrier].clone(),
                distance,
            })?;
        }
        Ok(())
    }
}

/// Returns the ends of the first strut that has the same ends as one before it; `None` if there is none.
fn twice(topology: &Topology) -> Option<(usize, usize)> {
    let mut seen = BTreeSet::new();
    topology.struts.iter().copied().find(|&(a, b)| !seen.insert((a.min(b), a.max(b))))
}
