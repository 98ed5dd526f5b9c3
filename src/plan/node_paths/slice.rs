//! Node paths between two times.

use super::limits::Margins;
use super::motion::{Interpolation, Keyframe, NodePaths};
use super::ramps::Ramps;

impl NodePaths {
    /// Returns the paths between two times, s from the start of the plan, with keyframes at both; a new keyframe
    /// states no margins.
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
            // The margins at the cut are others.
            let margins = if keyframe.time == time { keyframe.margins } else { Margins::default() };
            Keyframe {
                time: time - from,
                interpolation,
                ramps,
                nodes: self.state(time),
                cause: keyframe.cause,
                margins,
            }
        };
        NodePaths { keyframes: times.into_iter().map(keyframe).collect(), ..self.clone() }
    }
}
