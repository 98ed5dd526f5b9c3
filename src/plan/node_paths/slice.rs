//! Node paths between two times.

use super::limits::Margins;
use super::motion::{Interpolation, Keyframe, NodePaths};
use super::ramps::Ramps;
use super::topology::TopologyEvent;

impl NodePaths {
    /// Returns the paths between two times, s from the start of the plan, with keyframes at both; a new keyframe
    /// states no margins. Nodes that merge or split at the first instant have done so at the start of the slice, those that
    /// do at the last instant do so at its end.
    pub(in crate::plan) fn sliced(&self, from: f64, to: f64) -> NodePaths {
        let inside = self.keyframes.iter().filter(|k| from < k.time && k.time < to).map(|k| k.time);
        let mut times: Vec<f64> = std::iter::once(from).chain(inside).collect();
        if to > from {
            times.push(to);
        }
        let mut before = from;
        let keyframe = |time: f64| {
            let after = self.keyframes.partition_point(|k| k.time < time).min(self.keyframes.len() - 1);
            let keyframe = &self.keyframes[after];
            let begins = self.keyframes[after.saturating_sub(1)].time;
            let whole = keyframe.time - begins;
            let interpolation = match keyframe.interpolation {
                Interpolation::RigidRoll { edge, angle } if whole > 0.0 => {
                    Interpolation::RigidRoll { edge, angle: angle * ((time - before) / whole) }
                }
                other => other,
            };
            let ramps = if time > from {
                keyframe.ramps.sliced(whole, before - begins, time - begins)
            } else {
                Ramps::NONE
            };
            before = time;
            // The margins at the cut are others, and margins at a keyframe are those before its events.
            let changed = time == from && self.events.iter().any(|event| event.time == from);
            let kept = keyframe.time == time && !changed;
            let margins = if kept { keyframe.margins } else { Margins::default() };
            Keyframe {
                time: time - from,
                interpolation,
                ramps,
                nodes: self.state(time),
                cause: keyframe.cause,
                margins,
            }
        };
        let start = self.topology(from);
        let within = self.events.iter().filter(|event| from < event.time && event.time <= to);
        NodePaths {
            keyframes: times.into_iter().map(keyframe).collect(),
            merged: start.riders(),
            struts: start.struts,
            events: within.map(|event| TopologyEvent { time: event.time - from, ..event.clone() }).collect(),
            ..self.clone()
        }
    }
}
