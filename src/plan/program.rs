//! The program: a series-parallel graph of actions, the (J, X, ξ, T) of the compositional-design paper, as a
//! position-servo robot executes it. In a plan file it is a table of nodes, so that what is shared stays shared.

use super::cause::CauseId;
use super::goal::Goal;
use super::world::ExemptionKind;
use crate::robot::{JointId, PortRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A series-parallel graph of actions (Section V-B of the compositional-design paper, Tosun, Jing, Kress-Gazit and
/// Yim), as a position-servo robot executes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The root node, under which all other nodes are.
    pub root: Arc<Node>,
}

/// A node of the graph: an action, or a series (`Sc`) or parallel (`Pc`) composition of nodes. Nodes are shared where
/// a behaviour is used twice.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A single action: one command with its end.
    Action(Action),
    /// The series composition `Sc`: behaviours one after the other.
    Series(Vec<Arc<Node>>),
    /// The parallel composition `Pc`: behaviours that begin together; it ends when the last of them has.
    Parallel(Vec<Arc<Node>>),
    /// A repetition: a behaviour several times, one after the other.
    Repeat {
        /// The behaviour that is repeated.
        body: Arc<Node>,
        /// The number of times that the behaviour is carried out, at most.
        times: u64,
        /// The condition that ends the repetition if it holds after one of these times; `None`: no condition does. The
        /// time that it measures begins with the repetition.
        until: Option<Condition>,
    },
    /// A cyclic behaviour that begins at the fraction `shift` of its cycle, and ends there.
    Phase {
        /// The behaviour whose cycle is shifted.
        body: Arc<Node>,
        /// The fraction of the cycle, from 0 to 1.
        shift: f64,
        /// The index in the plan's causes of the source command that the node comes from.
        cause: CauseId,
    },
    /// A move of the joints together, in least time, to the positions at which `Phase` of the same body and shift
    /// begins.
    Approach {
        /// The behaviour to whose shifted cycle the joints move.
        body: Arc<Node>,
        /// The fraction of the cycle, from 0 to 1.
        shift: f64,
        /// The index in the plan's causes of the source command that the node comes from.
        cause: CauseId,
    },
    /// A behaviour whose time is scaled so that it lasts `duration` seconds.
    Stretch {
        /// The behaviour whose time is scaled.
        body: Arc<Node>,
        /// The duration after scaling, s.
        duration: f64,
        /// The index in the plan's causes of the source command that the node comes from.
        cause: CauseId,
    },
    /// A behaviour excused from checks over its own interval.
    Exempt {
        /// The behaviour that is excused.
        body: Arc<Node>,
        /// The check that the behaviour is excused from.
        kind: ExemptionKind,
        /// The index in the plan's causes of the source command that the node comes from.
        cause: CauseId,
    },
    /// A behaviour over whose own interval a contract is judged; it stands in behaviours only, and planning leaves the
    /// behaviour in its place.
    Contract {
        /// The behaviour that has the contract.
        body: Arc<Node>,
        /// The number of the contract among those of the run, for whoever judges it.
        number: u32,
        /// The index in the plan's causes of what is to blame: the use of the behaviour, or the clause.
        cause: CauseId,
    },
    /// A motion that is stated by its goal; it stands in behaviours only, and planning puts actions in its place.
    Goal(Box<Goal>),
}

/// One command to one controller with its end: (J, X, ξ, T) for controller, setpoint, condition and timeout. Without
/// `until` and `timeout` it ends when its motion does.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// The command: the controller J and the setpoint X.
    pub command: Command,
    /// The condition ξ that ends the action as soon as it holds; `None`: no condition does.
    pub until: Option<Condition>,
    /// The time T after which the action ends, s; `None`: no time is set.
    pub timeout: Option<f64>,
    /// The continuation when the timeout comes before `until` holds.
    pub otherwise: Otherwise,
    /// The index in the plan's causes of the source command that the action comes from.
    pub cause: CauseId,
}

/// The command of an action: a controller (J) and a setpoint (X), a pause, or a change of the bonds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// A move of a joint to a position, by a time law.
    Move {
        /// The joint that is commanded.
        joint: JointId,
        /// The end of the move, as a position or a change of it.
        target: Target,
        /// The duration of the move, s; `None`: the least that the limits allow.
        duration: Option<f64>,
        /// The time law of the move.
        profile: Profile,
    },
    /// A motion of a joint at a constant speed.
    Spin {
        /// The joint that is commanded.
        joint: JointId,
        /// The speed, rad/s or m/s; negative towards lower positions.
        speed: f64,
        /// The duration of the motion, s; `None`: until the next command to the joint.
        duration: Option<f64>,
    },
    /// A motion of a joint along a sampled function of the time since the action's start: between two samples it is
    /// the cubic with their positions and velocities.
    Follow {
        /// The joint that is commanded.
        joint: JointId,
        /// The samples, each as time (s), position (rad or m) and velocity (rad/s or m/s), in order of time; the first
        /// at 0.
        keyframes: Vec<[f64; 3]>,
    },
    /// A pause, in which nothing moves.
    Wait {
        /// The duration of the pause, s.
        duration: f64,
    },
    /// Docking of port `b` to port `a`; the turn is the allowed one nearest to that in which they meet.
    Dock {
        /// The port that is docked to.
        a: PortRef,
        /// The port that docks.
        b: PortRef,
    },
    /// Undocking: the bond at a port ceases to hold.
    Undock {
        /// One of the two ports of the bond.
        port: PortRef,
    },
}

/// The end of a move: a position of its joint, or a change of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Target {
    /// The position at the end, rad or m.
    To(f64),
    /// The change of the position from that at the start, rad or m.
    By(f64),
}

/// The time law of a move: how its joint comes from one position to the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// A quintic polynomial of time, at rest at both ends.
    Smooth,
    /// Constant acceleration, constant speed, constant deceleration; at rest at both ends.
    Trapezoid,
    /// Constant speed throughout: the speed jumps at both ends.
    Linear,
}

/// The continuation when an action's timeout comes before its `until` holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Otherwise {
    /// The next action begins, as in the compositional-design paper (Tosun, Jing, Kress-Gazit and Yim, Section V-B).
    Proceed,
    /// The behaviour is aborted, with this message.
    Abort(String),
    /// Another behaviour, given by its root node, begins.
    Node(Arc<Node>),
}

/// A quantity that a condition measures while an action runs. A plan knows positions, rates and times before it is
/// executed; of the others, [measured](Signal::is_measured) ones, nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Signal {
    /// The position of a joint, rad or m.
    Angle(JointId),
    /// The rate of a joint, rad/s or m/s.
    Speed(JointId),
    /// The time since the action began, s.
    Elapsed,
    /// The effort of a joint's motor in the joint's positive direction, N·m or N.
    Effort(JointId),
    /// The distance of the origins of two ports, m.
    Separation(PortRef, PortRef),
    /// The angle by which the body of a module, given by its index, leans from its attitude at the start, rad.
    Tilt(usize),
}

impl Signal {
    /// Returns true for a quantity of which a plan knows nothing before it is executed.
    pub fn is_measured(self) -> bool {
        match self {
            Signal::Angle(_) | Signal::Speed(_) | Signal::Elapsed => false,
            Signal::Effort(_) | Signal::Separation(..) | Signal::Tilt(_) => true,
        }
    }
}

/// A comparison of a signal with a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Compare {
    /// The comparison less than: `<`.
    Less,
    /// The comparison at most: `<=`.
    LessEqual,
    /// The comparison greater than: `>`.
    Greater,
    /// The comparison at least: `>=`.
    GreaterEqual,
}

/// A condition ξ on joints, time and bonds, which ends an action as soon as it holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Condition {
    /// A comparison of a signal with a value, such as `elapsed >= 2 s`: it holds while the inequality does.
    Compare {
        /// The signal on the left side.
        signal: Signal,
        /// The comparison of the signal with the value.
        compare: Compare,
        /// The value on the right side, in the unit of the signal.
        value: f64,
    },
    /// The condition that something is docked at a port.
    Docked(PortRef),
    /// The condition that two ports are docked to each other.
    Mated(PortRef, PortRef),
    /// The condition that one of some modules, given by their indices, touches the ground or a module that is not among
    /// them; measured.
    Touching(Vec<usize>),
    /// The condition that one of some modules touches one of others, both given by their indices, and is not docked to it;
    /// measured.
    TouchingEachOther(Vec<usize>, Vec<usize>),
    /// A conjunction: both conditions hold at once.
    And(Box<Condition>, Box<Condition>),
    /// A disjunction: one of the conditions holds, or both.
    Or(Box<Condition>, Box<Condition>),
    /// A negation: the condition does not hold.
    Not(Box<Condition>),
}

impl Compare {
    /// Returns the comparison that says the same after the signs of both sides are changed: `>` for `<`, `>=` for
    /// `<=`, and the reverse.
    pub fn turned(self) -> Compare {
        match self {
            Compare::Less => Compare::Greater,
            Compare::LessEqual => Compare::GreaterEqual,
            Compare::Greater => Compare::Less,
            Compare::GreaterEqual => Compare::LessEqual,
        }
    }
}
