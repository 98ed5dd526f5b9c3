//! Nodes that merge and split: the stretches of a plan between these events, and what is asked at the events.
//!
//! Each stretch has its own ends of struts, and all checks of its steps are made with them. At an event the truss is at rest,
//! and with the ends before and with those after it keeps all limits: lengths, distances, angles, rigidity, the ground,
//! stability and forces. Events of one keyframe follow each other in the order of the plan, and the truss keeps its limits
//! between them, too.
//!
//! Struts of nodes that are about to merge, or have just split, come nearer than their clearance. While the two nodes come
//! nearer to each other all the time, up to the event, or move away from each other all the time, since the event, only the
//! ends of these struts at the two nodes may be near each other: either strut without that end keeps its clearance from
//! the whole of the other. That ends do not meet before their nodes do is not proved.

use super::judgement::{Judgement, Step};
use super::loads::LoadMonitor;
use super::rigidity::RigidityMonitor;
use super::shape;
use super::support::StabilityMonitor;
use crate::geometry::Vec3;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{
    CheckKind, Failure, Interpolation, NodePaths, Topology, TopologyChange, TopologyEvent, World,
};
use crate::robot::truss_statics::Layout;
use crate::units::{Dimension, quantity};

/// The keyframes between which the topology stays, and the nodes that meet at either end.
#[derive(Clone, Debug, Default)]
pub(super) struct Stretch {
    /// The index of the keyframe at which the stretch begins.
    first: usize,
    /// The index of the keyframe at which it ends.
    last: usize,
    /// The place at which each node of the plan is in the events at the start: nodes of one number were merged there.
    apart_from: Option<Vec<usize>>,
    /// The same in the events at the end: nodes of one number merge there.
    meet_at: Option<Vec<usize>>,
}

/// The monitors that go on from step to step.
pub(super) struct Monitors<'a> {
    /// The static stability, and the slip.
    pub standing: StabilityMonitor,
    /// The rigidity.
    pub stiff: RigidityMonitor,
    /// The forces.
    pub loads: LoadMonitor<'a>,
}

/// Returns the place at which each node of a plan is in some events, one after the other: all nodes that merge or split there
/// with each other have one number. `before`: the topology before them.
fn meetings(before: &Topology, events: &[TopologyEvent]) -> Vec<usize> {
    let mut topology = before.clone();
    let mut places: Vec<usize> = (0..topology.merged.len()).map(|node| topology.carrier(node)).collect();
    for event in events {
        let other = match event.change {
            TopologyChange::Merge { into, .. } => into,
            TopologyChange::Split { node, .. } => topology.carrier(node),
        };
        let (from, to) = (places[event.change.node()], places[other]);
        places.iter_mut().filter(|place| **place == from).for_each(|place| *place = to);
        topology.apply(&event.change);
    }
    places
}

impl Judgement<'_> {
    /// Takes on a topology from the keyframe of an index on, with the events that come next and, where it begins with some,
    /// those of its start, with the topology before these.
    pub(super) fn enter(&mut self, topology: &Topology, first: usize, begins: Option<&Topology>) {
        let NodePaths { keyframes, events, node_names, limits, .. } = self.paths;
        let time = keyframes[first].time;
        let now = |event: &&TopologyEvent| event.time == time;
        self.nodes = topology.free_nodes();
        let mut index = vec![0; node_names.len()];
        self.nodes.iter().enumerate().for_each(|(own, &node)| index[node] = own);
        self.struts = topology.struts.iter().map(|&(a, b)| (index[a], index[b])).collect();
        self.carried = vec![0.0; self.nodes.len()];
        (0..node_names.len()).for_each(|node| self.carried[index[topology.carrier(node)]] += 1.0);
        self.layout = Layout::new(self.nodes.len(), &self.struts);
        self.corners = Vec::new();
        if limits.angle > 0.0 {
            self.corners = shape::corners(self.nodes.len(), &self.struts);
        }
        // The events at the end: those that are still to come at the time of the next one.
        let own: Vec<TopologyEvent> = events.iter().filter(now).cloned().collect();
        let begun = begins.map(|before| meetings(before, &own));
        let next = match begins {
            Some(_) => events.iter().find(|event| event.time > time),
            None => events.iter().find(|event| event.time >= time),
        };
        let next: Vec<TopologyEvent> = next
            .map_or_else(Vec::new, |next| events.iter().filter(|e| e.time == next.time).cloned().collect());
        let ends = next.first().map(|next| keyframes.partition_point(|keyframe| keyframe.time < next.time));
        self.stretch = Stretch {
            first,
            last: ends.unwrap_or(keyframes.len() - 1),
            apart_from: begun,
            meet_at: (!next.is_empty()).then(|| meetings(topology, &next)),
        };
    }

    /// Returns the index of a node of the plan in this judgement: that of the node that it rides along with, if it does.
    pub(super) fn own_node(&self, topology: &Topology, node: usize) -> usize {
        let carrier = topology.carrier(node);
        self.nodes.binary_search(&carrier).unwrap_or_default()
    }

    /// Returns the positions of the nodes at the keyframe of an index, in the world, m.
    pub(super) fn places(&self, keyframe: usize) -> Vec<Vec3> {
        let nodes = &self.paths.keyframes[keyframe].nodes;
        self.nodes.iter().map(|&node| Vec3::from(nodes[node])).collect()
    }

    /// Returns the length of the ends of struts that may come near each other at a joint that forms or has come apart, m.
    pub(super) fn joint_reach(&self) -> f64 {
        self.tolerances.joint_reach * self.strut.clearance
    }

    /// Returns the ends, one of each of two struts, at which the two are about to share a node, or have just done so; `None`
    /// if there are none, or the nodes do not come nearer all the way from this step to the event, or do not move away all the
    /// way from the event to the end of this step.
    pub(super) fn joint(&self, step: &Step, (first, second): (usize, usize)) -> Option<(usize, usize)> {
        let ((a, b), (c, d)) = (self.struts[first], self.struts[second]);
        [(a, c), (a, d), (b, c), (b, d)].into_iter().find(|&(p, q)| {
            let together = |places: &Option<Vec<usize>>| {
                places.as_ref().is_some_and(|places| places[self.nodes[p]] == places[self.nodes[q]])
            };
            let Stretch { first, last, apart_from, meet_at } = &self.stretch;
            let (meets, parts) = (together(meet_at), together(apart_from));
            match step.keyframe {
                None => meets || parts,
                Some(to) => {
                    meets && (to..=*last).all(|step| self.approach((p, q), step))
                        || parts && (first + 1..=to).all(|step| self.departs((p, q), step))
                }
            }
        })
    }

    /// Returns the vectors from one node to another at the start and at the end of the step to the keyframe of an index, m.
    fn across(&self, (p, q): (usize, usize), keyframe: usize) -> (Vec3, Vec3) {
        let at = |keyframe: usize| {
            let nodes = &self.paths.keyframes[keyframe].nodes;
            Vec3::from(nodes[self.nodes[q]]) - Vec3::from(nodes[self.nodes[p]])
        };
        (at(keyframe - 1), at(keyframe))
    }

    /// Returns true if two nodes come nearer to each other all the way of a step: their distance is convex, so its end tells.
    fn approach(&self, nodes: (usize, usize), keyframe: usize) -> bool {
        let (from, to) = self.across(nodes, keyframe);
        let change = to - from;
        change.dot(&to) <= self.tolerances.approach * change.norm()
    }

    /// Returns true if two nodes move away from each other all the way of a step.
    fn departs(&self, nodes: (usize, usize), keyframe: usize) -> bool {
        let (from, to) = self.across(nodes, keyframe);
        let change = to - from;
        change.dot(&from) >= -self.tolerances.approach * change.norm()
    }

    /// Judges the truss at rest at the keyframe of an index, with all checks that a step has.
    pub(super) fn at_rest(
        &self,
        keyframe: usize,
        world: World,
        monitors: &mut Monitors,
        ledger: &mut Ledger,
    ) {
        let (x, time) = (self.places(keyframe), self.paths.keyframes[keyframe].time);
        let step = Step::still(&x, time);
        self.lengths(&step, ledger);
        self.distances(&step, ledger);
        self.obstacles(&step, ledger);
        self.shape(&step, ledger);
        monitors.stiff.rest(self, &x, time, ledger);
        if world.has_floor() {
            self.ground(&step, ledger);
            if world.gravity > 0.0 {
                let stood = ledger.verdict.failures.len();
                monitors.standing.step(self, &step, ledger);
                // Forces are of no interest where it topples.
                if ledger.verdict.failures.len() == stood {
                    monitors.loads.rest(self, (&x, time), world, &monitors.standing, ledger);
                }
            }
        }
    }

    /// Checks that the truss is at rest at a keyframe at which nodes merge or split: that the steps beside it end and begin with
    /// a rate of zero, if its struts have a limit of acceleration, and are no rolls.
    pub(super) fn rests_beside(&self, keyframe: usize, ledger: &mut Ledger) {
        let keyframes = &self.paths.keyframes;
        let time = keyframes[keyframe].time;
        for (to, ends) in [(keyframe, true), (keyframe + 1, false)] {
            let (Some(next), Some(before)) =
                (keyframes.get(to), to.checked_sub(1).map(|from| &keyframes[from]))
            else {
                continue;
            };
            let duration = next.time - before.time;
            let rate = next.ramps.progress(duration).rate(if ends { duration } else { 0.0 });
            let ways =
                before.nodes.iter().zip(&next.nodes).map(|(p, q)| (Vec3::from(*q) - Vec3::from(*p)).norm());
            let (way, node) =
                ways.zip(0..).fold((0.0, 0), |most, way| if way.0 > most.0 { way } else { most });
            let rolls = matches!(next.interpolation, Interpolation::RigidRoll { .. });
            let moves = self.strut.acceleration.is_some() && way * rate > self.tolerances.rest;
            if !rolls && !moves {
                continue;
            }
            let when = if ends { "before" } else { "after" };
            let (at, message) = if rolls {
                (Vec::new(), format!("it rolls just {when} nodes merge or split; it has to be at rest then"))
            } else {
                let (name, speed) =
                    (self.paths.node_names[node].clone(), quantity(way * rate, Dimension::SPEED));
                let message = format!(
                    "the node {name} moves at {speed} just {when} nodes merge or split; the truss has to be at rest then"
                );
                (vec![name], message)
            };
            let failure = self.failure(CheckKind::Rest, time, at, message);
            ledger.fail(Failure { value: way * rate, limit: 0.0, ..failure });
        }
    }

    /// Notes what is assumed where nodes merge and split, and what is not proved.
    pub(super) fn note_assumptions(&self, ledger: &mut Ledger) {
        let reach = quantity(self.joint_reach(), Dimension::LENGTH);
        ledger.note(
            "assumed: the passive joints of nodes that merge and split open and close by themselves, at once and without \
             force"
                .to_owned(),
        );
        ledger.note(format!(
            "not proved: that the last {reach} of struts stay clear of each other where their nodes are about to merge, or \
             have just split"
        ));
        if self.strut.acceleration.is_none() {
            ledger.note(
                "assumed: struts stop and start at once where nodes merge and split, as they state no `max_accel`".to_owned(),
            );
        }
    }
}
