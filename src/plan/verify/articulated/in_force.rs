//! The world and the exemption from tipping at a time of a plan.

use crate::plan::{Exemption, ExemptionKind, World, WorldFrom};

/// Returns true if an exemption allows the robot to tip at `t` (s).
pub(super) fn excused(exemptions: &[Exemption], t: f64) -> bool {
    exemptions.iter().any(|e| e.kind == ExemptionKind::Unstable && e.covers(t))
}

/// Returns the world just after a time (s); the default world before the first change.
pub(super) fn world_at(worlds: &[WorldFrom], t: f64) -> World {
    worlds.iter().take_while(|w| w.from <= t).last().map_or_else(World::default, |w| w.world)
}
