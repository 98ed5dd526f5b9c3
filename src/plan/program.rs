//! The program: a series-parallel graph of actions, the paper's (J, X, ξ, T), as a position-servo
//! robot executes it. In a plan file it is a table of nodes, so that what is shared stays shared.

use super::cause::CauseId;
use super::world::ExemptionKind;
use crate::robot::{JointId, PortRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A series-parallel graph of actions (Section V-B of the compositional-design paper), as a position-servo
/// robot executes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The node that all others are under.
    pub root: Arc<Node>,
}

/// Series (`Sc`) and parallel (`Pc`) composition. Nodes are shared where a behaviour is used twice.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// One action.
    Action(Action),
    /// Behaviours one after the other: `Sc`.
    Series(Vec<Arc<Node>>),
    /// Behaviours that begin together, and end when the last of them has: `Pc`.
    Parallel(Vec<Arc<Node>>),
    /// A behaviour several times, one after the other.
    Repeat {
        /// The behaviour.
        body: Arc<Node>,
        /// The number of repetitions.
        times: u64,
    },
    /// A cyclic behaviour begun at `shift` (0..1) of its cycle.
    Phase {
        /// The behaviour.
        body: Arc<Node>,
        /// The part of the cycle, 0 to 1.
        shift: f64,
        /// The command of the source that this comes from.
        cause: CauseId,
    },
    /// The joints move together to where `Phase` of the same body and shift begins, in least time.
    Approach {
        /// The behaviour.
        body: Arc<Node>,
        /// The part of the cycle, 0 to 1.
        shift: f64,
        /// The command of the source that this comes from.
        cause: CauseId,
    },
    /// A behaviour whose time is scaled so that it lasts `duration` seconds.
    Stretch {
        /// The behaviour.
        body: Arc<Node>,
        /// The duration, s.
        duration: f64,
        /// The command of the source that this comes from.
        cause: CauseId,
    },
    /// A behaviour excused from checks over its own interval.
    Exempt {
        /// The behaviour.
        body: Arc<Node>,
        /// The checks.
        kind: ExemptionKind,
        /// The command of the source that this comes from.
        cause: CauseId,
    },
}

/// One command to one controller with its end: (J, X, ξ, T).
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// J and X: what is commanded.
    pub command: Command,
    /// ξ: ends the action when it holds.
    pub until: Option<Condition>,
    /// T, in seconds.
    pub timeout: Option<f64>,
    /// The continuation after the timeout.
    pub otherwise: Otherwise,
    /// The command of the source that this comes from.
    pub cause: CauseId,
}

/// The command of an action: a controller (J) and a setpoint (X), a pause, or a change of the bonds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// `duration: None` is the least time that the limits allow.
    Move {
        /// The joint.
        joint: JointId,
        /// The end.
        target: Target,
        /// Seconds, or `None`.
        duration: Option<f64>,
        /// The time law.
        profile: Profile,
    },
    /// `duration: None` lasts until the next command to the joint.
    Spin {
        /// The joint.
        joint: JointId,
        /// The speed, rad/s or m/s.
        speed: f64,
        /// Seconds, or `None`.
        duration: Option<f64>,
    },
    /// A sampled function of time since the action's start: (time, position) with the velocities
    /// between which it is a cubic.
    Follow {
        /// The joint.
        joint: JointId,
        /// (s, rad or m, rad/s or m/s), in order of time; the first at 0.
        keyframes: Vec<[f64; 3]>,
    },
    /// Nothing moves for a time.
    Wait {
        /// The duration, s.
        duration: f64,
    },
    /// Port `b` docks to port `a`; the turn is the allowed one nearest to where they are.
    Dock {
        /// The port that is docked to.
        a: PortRef,
        /// The port that docks.
        b: PortRef,
    },
    /// The bond at a port ceases to hold.
    Undock {
        /// One of the two ports of the bond.
        port: PortRef,
    },
}

/// The end of a move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Target {
    /// A position, rad or m.
    To(f64),
    /// A change of position, rad or m.
    By(f64),
}

/// The time law of a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// Quintic, at rest at both ends.
    Smooth,
    /// Constant acceleration, constant speed, constant deceleration.
    Trapezoid,
    /// Constant speed throughout.
    Linear,
}

/// The continuation after a timeout before `until` held.
#[derive(Clone, Debug, PartialEq)]
pub enum Otherwise {
    /// The next action begins: the paper's meaning.
    Proceed,
    /// The behaviour fails, with a message.
    Abort(String),
    /// Another behaviour begins.
    Node(Arc<Node>),
}

/// A quantity that a condition measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Signal {
    /// The position of a joint, rad or m.
    Angle(JointId),
    /// The rate of a joint, rad/s or m/s.
    Speed(JointId),
    /// Seconds since the action began.
    Elapsed,
}

/// A comparison of a signal with a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Compare {
    /// Less than: `<`.
    Less,
    /// At most: `<=`.
    LessEqual,
    /// Greater than: `>`.
    Greater,
    /// At least: `>=`.
    GreaterEqual,
}

/// ξ: what ends an action when it begins to hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Condition {
    /// A signal compares with a value.
    Compare {
        /// The left side.
        signal: Signal,
        /// The comparison.
        compare: Compare,
        /// The right side, in the unit of the signal.
        value: f64,
    },
    /// Something is docked at a port.
    Docked(PortRef),
    /// Two ports are docked to each other.
    Mated(PortRef, PortRef),
    /// Both conditions hold.
    And(Box<Condition>, Box<Condition>),
    /// One of them holds, or both.
    Or(Box<Condition>, Box<Condition>),
    /// It does not hold.
    Not(Box<Condition>),
}

impl Compare {
    /// Returns the comparison that holds when both sides change their signs.
    pub fn turned(self) -> Compare {
        match self {
            Compare::Less => Compare::Greater,
            Compare::LessEqual => Compare::GreaterEqual,
            Compare::Greater => Compare::Less,
            Compare::GreaterEqual => Compare::LessEqual,
        }
    }
}
