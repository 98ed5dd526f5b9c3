//! The program: a series-parallel graph of actions, the paper's (J, X, ξ, T), as a position-servo
//! robot executes it. In a plan file it is a table of nodes, so that what is shared stays shared.

use super::cause::CauseId;
use super::world::ExemptionKind;
use crate::robot::{JointId, PortRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    pub root: Arc<Node>,
}

/// Series (`Sc`) and parallel (`Pc`) composition. Nodes are shared where a behaviour is used twice.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    Action(Action),
    Series(Vec<Arc<Node>>),
    Parallel(Vec<Arc<Node>>),
    Repeat {
        body: Arc<Node>,
        times: u64,
    },
    /// A cyclic behaviour begun at `shift` (0..1) of its cycle.
    Phase {
        body: Arc<Node>,
        shift: f64,
        cause: CauseId,
    },
    /// The joints move together to where `Phase` of the same body and shift begins, in least time.
    Approach {
        body: Arc<Node>,
        shift: f64,
        cause: CauseId,
    },
    /// A behaviour whose time is scaled so that it lasts `duration` seconds.
    Stretch {
        body: Arc<Node>,
        duration: f64,
        cause: CauseId,
    },
    /// A behaviour excused from checks over its own interval.
    Exempt {
        body: Arc<Node>,
        kind: ExemptionKind,
        cause: CauseId,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    pub command: Command,
    /// ξ: ends the action when it holds.
    pub until: Option<Condition>,
    /// T, in seconds.
    pub timeout: Option<f64>,
    pub otherwise: Otherwise,
    pub cause: CauseId,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// `duration: None` is the least time that the limits allow.
    Move {
        joint: JointId,
        target: Target,
        duration: Option<f64>,
        profile: Profile,
    },
    /// `duration: None` lasts until the next command to the joint.
    Spin {
        joint: JointId,
        speed: f64,
        duration: Option<f64>,
    },
    /// A sampled function of time since the action's start: (time, position) with the velocities
    /// between which it is a cubic.
    Follow {
        joint: JointId,
        keyframes: Vec<[f64; 3]>,
    },
    Wait {
        duration: f64,
    },
    /// Port `b` docks to port `a`; the turn is the allowed one nearest to where they are.
    Dock {
        a: PortRef,
        b: PortRef,
    },
    Undock {
        port: PortRef,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Target {
    To(f64),
    By(f64),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// Quintic, at rest at both ends.
    Smooth,
    Trapezoid,
    Linear,
}

/// What follows a timeout before `until` held.
#[derive(Clone, Debug, PartialEq)]
pub enum Otherwise {
    /// The next action begins: the paper's meaning.
    Proceed,
    Abort(String),
    Node(Arc<Node>),
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Signal {
    Angle(JointId),
    Speed(JointId),
    /// Seconds since the action began.
    Elapsed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Compare {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Condition {
    Compare { signal: Signal, compare: Compare, value: f64 },
    Docked(PortRef),
    Mated(PortRef, PortRef),
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
    Not(Box<Condition>),
}

impl Compare {
    /// The comparison of the two sides with their signs changed.
    pub fn turned(self) -> Compare {
        match self {
            Compare::Less => Compare::Greater,
            Compare::LessEqual => Compare::GreaterEqual,
            Compare::Greater => Compare::Less,
            Compare::GreaterEqual => Compare::LessEqual,
        }
    }
}
