//! Node paths run backwards.

use super::limits::Margins;
use super::motion::{Interpolation, Keyframe, NodePaths};
use super::topology::TopologyEvent;

impl NodePaths {
    /// Returns the paths in reverse, from end to start: rolls turn in the opposite direction, merges become splits and
    /// splits merges.
    pub fn reversed(&self) -> NodePaths {
        let d = self.duration();
        let keyframes = &self.keyframes;
        let keyframe = |i: usize| {
            // The interpolation into the new keyframe is that out of the old one.
            let out = keyframes.get(i + 1).unwrap_or(&keyframes[0]);
            let interpolation = match out.interpolation {
                Interpolation::RigidRoll { edge, angle } => Interpolation::RigidRoll { edge, angle: -angle },
                Interpolation::Linear => Interpolation::Linear,
            };
            // Margins at a keyframe are those before its events.
            let changes = self.events.iter().any(|event| event.time == keyframes[i].time);
            Keyframe {
                time: d - keyframes[i].time,
                interpolation,
                ramps: out.ramps.reversed(),
                nodes: keyframes[i].nodes.clone(),
                cause: out.cause,
                margins: if changes { Margins::default() } else { keyframes[i].margins },
            }
        };
        let mut topology = self.topology_at_start();
        let back = |event: &TopologyEvent| TopologyEvent {
            time: d - event.time,
            change: topology.apply(&event.change),
            cause: event.cause,
        };
        let mut events: Vec<TopologyEvent> = self.events.iter().map(back).collect();
        events.reverse();
        NodePaths {
            keyframes: (0..keyframes.len()).rev().map(keyframe).collect(),
            merged: topology.riders(),
            struts: topology.struts,
            events,
            ..self.clone()
        }
    }
}
