//! Obstacles: solids that stand fast in the world of articulated robots.

use crate::geometry::Placed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A solid that stands fast among the robots of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// The name, by which reports name the obstacle; unique in the plan, also among its modules.
    pub name: String,
    /// The shapes whose union the solid is, in the world's frame, m.
    pub shapes: Vec<Placed>,
}
