//! Node paths run backwards.

use super::motion::{Interpolation, Keyframe, NodePaths};

impl NodePaths {
    /// Returns the paths in reverse, from end to start: rolls turn in the opposite direction.
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
            Keyframe {
                time: d - keyframes[i].time,
                interpolation,
                ramps: out.ramps.reversed(),
                nodes: keyframes[i].nodes.clone(),
                cause: out.cause,
                margins: keyframes[i].margins,
            }
        };
        NodePaths { keyframes: (0..keyframes.len()).rev().map(keyframe).collect(), ..self.clone() }
    }
}
