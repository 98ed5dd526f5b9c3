//! Refusals of scheduling: why a behaviour is no plan, and which action is to blame.

use super::joints::Uncommandable;
use crate::plan::CauseId;
use crate::units::{Dimension, quantity};

/// The refusal of a behaviour that cannot be carried out, or whose schedule exceeds a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The action to blame; `None` where it is the behaviour as a whole.
    pub cause: Option<CauseId>,
    /// The reason.
    pub reason: Reason,
}

/// The reason of a refusal. SI units; joints and ports by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The joint takes no commands.
    NoCommands {
        /// The path name of the joint.
        joint: String,
        /// The reason.
        why: Uncommandable,
    },
    /// No limit says how fast the joint is, so the action needs a duration.
    NoSpeed {
        /// The path name of the joint.
        joint: String,
    },
    /// A duration, speed, target or keyframe that is not finite, is negative, or is out of order.
    BadNumber {
        /// The meaning of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The followed function does not begin where the joint is.
    Jump {
        /// The path name of the joint.
        joint: String,
        /// The position of the joint, rad or m.
        at: f64,
        /// The position at which the function begins, rad or m.
        begins: f64,
    },
    /// The joint moves too fast to be stopped within the duration of the move that takes over.
    NoTimeToStop {
        /// The path name of the joint.
        joint: String,
        /// The time to stop, s.
        needed: f64,
        /// The duration, s.
        given: f64,
    },
    /// The plan would end while the joint still turns.
    StillTurning {
        /// The path name of the joint.
        joint: String,
        /// The speed, rad/s or m/s.
        speed: f64,
    },
    /// The condition never holds in the undisturbed run.
    NeverHolds,
    /// The behaviour aborts in the undisturbed run.
    Aborted {
        /// The message of `abort`.
        message: String,
        /// The time, s.
        time: f64,
    },
    /// The port is taken.
    PortTaken {
        /// The path name of the port.
        port: String,
        /// The path name of the port that is docked to it.
        by: String,
    },
    /// Nothing is docked at the port.
    PortFree {
        /// The path name of the port.
        port: String,
    },
    /// The connectors do not mate.
    NoMate {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// The two ports are on parts of the robot that nothing connects.
    Apart {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// A phase or stretch contains an action that can't be shifted or scaled.
    NotCyclic {
        /// The part that cannot be shifted or scaled.
        what: &'static str,
    },
    /// A piece of motion shorter than a tick of time.
    TooShort,
    /// A limit was reached.
    Limit {
        /// The things that are counted.
        what: &'static str,
        /// The most there may be.
        limit: u64,
    },
}

impl Refusal {
    /// Returns the refusal of an action.
    pub fn at(cause: CauseId, reason: Reason) -> Refusal {
        Refusal { cause: Some(cause), reason }
    }

    /// Returns the refusal of a behaviour as a whole.
    pub fn whole(reason: Reason) -> Refusal {
        Refusal { cause: None, reason }
    }
}

/// In words, with plain SI numbers; whoever knows the user's units may say it better.
impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reason::NoCommands { joint, why: Uncommandable::Passive } => write!(f, "`{joint}` has no motor"),
            Reason::NoCommands { joint, why: Uncommandable::Mimic } => {
                write!(f, "`{joint}` follows another joint")
            }
            Reason::NoCommands { joint, why: Uncommandable::Fixed } => write!(f, "`{joint}` is fixed"),
            Reason::NoSpeed { joint } => {
                write!(f, "`{joint}` states no greatest speed, so the action needs a duration (`in:`)")
            }
            Reason::BadNumber { what, value } => write!(f, "{what} cannot be {value}"),
            Reason::Jump { joint, at, begins } => {
                write!(f, "the motion begins at {begins:.6}, but `{joint}` is at {at:.6}")
            }
            Reason::NoTimeToStop { joint, needed, given } => {
                write!(
                    f,
                    "`{joint}` needs {} to stop, which leaves nothing of {}",
                    time(*needed),
                    time(*given)
                )
            }
            Reason::StillTurning { joint, speed } => {
                write!(f, "the plan ends while `{joint}` still turns at {speed:.6} per second")
            }
            Reason::NeverHolds => write!(f, "the condition never holds, and there is no timeout"),
            Reason::Aborted { message, time } => write!(f, "aborted at {}: {message}", self::time(*time)),
            Reason::PortTaken { port, by } => write!(f, "`{port}` is taken by `{by}`"),
            Reason::PortFree { port } => write!(f, "nothing is docked at `{port}`"),
            Reason::NoMate { a, b } => write!(f, "`{a}` and `{b}` do not mate"),
            Reason::Apart { a, b } => write!(f, "nothing connects the parts of `{a}` and `{b}`"),
            Reason::NotCyclic { what } => write!(f, "{what} cannot be part of a cycle"),
            Reason::TooShort => write!(f, "a piece of the motion is shorter than a tick of time"),
            Reason::Limit { what, limit } => write!(f, "more than {limit} {what}"),
        }
    }
}

fn time(seconds: f64) -> String {
    quantity(seconds, Dimension::TIME)
}
