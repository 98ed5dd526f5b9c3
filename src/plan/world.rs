//! The world that a plan assumes, how strictly it is judged, and what it is excused from.

use super::cause::CauseId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ground {
    /// Quasi-static contact: the robot rests, rolls, travels, tips.
    Settle,
    /// The base keeps its pose.
    Fixed,
    /// The base module's body is held fast, as if bolted down: whatever holds it takes any force and
    /// moment, and nothing else touches the robot.
    Held,
    /// The robot floats.
    Off,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// m/s², downwards; 0 is weightless.
    pub gravity: f64,
    pub ground: Ground,
    /// Factor on the friction of every link.
    pub friction: f64,
}

impl World {
    /// Nothing pulls, and there is no ground.
    pub const FREE: World = World { gravity: 0.0, ground: Ground::Off, friction: 1.0 };

    /// Whether there is something under the robot.
    pub fn has_floor(&self) -> bool {
        matches!(self.ground, Ground::Settle | Ground::Fixed)
    }
}

impl Default for World {
    fn default() -> World {
        World { gravity: 9.80665, ground: Ground::Settle, friction: 1.0 }
    }
}

/// From when on which world holds; the first begins at 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldFrom {
    pub from: f64,
    pub world: World,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// The hull of the ground contacts.
    Footprint,
    /// The paper's rule: the hull of the centres of the lowest modules.
    Centres,
}

/// Options of the judge. A looser value than the default stands in the source and in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Longest time between two samples, s.
    pub sample: f64,
    /// How long support may be missing at a stretch (the paper's t_max), s.
    pub unstable_for: f64,
    pub stability: Stability,
    /// Most samples of one verification, refinements included.
    pub samples_max: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { sample: 0.01, unstable_for: 0.0, stability: Stability::Footprint, samples_max: 2_000_000 }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ExemptionKind {
    Unstable,
    Slip,
    /// Between two modules; `None`: between any.
    Collision(Option<(usize, usize)>),
    /// Of one joint ([`JointId`](crate::robot::JointId)); `None`: of any.
    Overload(Option<u32>),
}

/// What a stretch of the plan is excused from. The end of the whole plan never is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exemption {
    pub kind: ExemptionKind,
    pub from: f64,
    pub to: f64,
    pub cause: CauseId,
}
