//! The world, the exemption from tipping and the positions of the joints at a time of a plan.

use super::rollout_input::Rollout;
use crate::plan::{Exemption, ExemptionKind, World, WorldFrom};

/// Returns true if an exemption allows the robot to tip at `t` (s).
pub(super) fn excused(exemptions: &[Exemption], t: f64) -> bool {
    exemptions.iter().any(|e| e.kind == ExemptionKind::Unstable && e.covers(t))
}

/// Returns the world just after a time (s); the default world before the first change.
pub(super) fn world_at(worlds: &[WorldFrom], t: f64) -> World {
    worlds.iter().take_while(|w| w.from <= t).last().map_or_else(World::default, |w| w.world)
}

/// Overwrites `joints` with the positions (rad or m) of all joints at a time (s), by the number in their `JointId`;
/// the joint that the rollout holds keeps the position at which it is held.
pub(super) fn positions(rollout: &Rollout, t: f64, joints: &mut Vec<f64>) {
    joints.clear();
    joints.extend_from_slice(&rollout.tracks.start.joints);
    for track in &rollout.tracks.tracks {
        let index = track.joint.0 as usize;
        let t = match rollout.held {
            Some((joint, from)) if joint == index => t.min(from),
            _ => t,
        };
        joints[index] = track.position(joints[index], t);
    }
}
