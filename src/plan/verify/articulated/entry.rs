//! The beginning of a robot in the middle of a plan.

use crate::geometry::Pose;
use crate::plan::CauseId;
use crate::robot::dynamics::{Twist, Wrench};

/// The beginning of a rollout in the middle of a plan: of a robot that came to be by docking or undocking.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The world pose of the base module's body (`X_WB`) at that time, m.
    pub base: Pose,
    /// The momentum that the robot has then (N·s), and its angular momentum about its centre of mass (N·m·s), in the world;
    /// zero under statics.
    pub momentum: Wrench,
    /// The twist that its base module's body then has in the world, m/s and rad/s; zero under statics.
    pub twist: Twist,
    /// The causes of the events by which the robot came to be.
    pub causes: Vec<CauseId>,
}
