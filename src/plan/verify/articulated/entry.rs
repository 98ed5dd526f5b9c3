//! The beginning of a part of a robot that has come off another.

use crate::geometry::Pose;
use crate::plan::CauseId;

/// The beginning of a rollout in the middle of a plan: of a part that has come off another.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The world pose of the base module's body (`X_WB`) at that time, m.
    pub base: Pose,
    /// The part in words, for messages.
    pub name: String,
    /// The causes of the events by which the part came off.
    pub causes: Vec<CauseId>,
}
