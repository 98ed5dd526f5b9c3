//! Refusals of scheduling: the reason why a behaviour is not a plan, and the action to blame.

use super::joints::Uncommandable;
use crate::plan::{CauseId, Goal};
use crate::units::{Dimension, quantity};

/// The refusal of a behaviour that cannot be carried out, or whose schedule exceeds a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The cause of the action to blame; `None` if the behaviour as a whole is.
    pub cause: Option<CauseId>,
    /// The reason for which the behaviour is refused.
    pub reason: Reason,
}

/// The reason of a refusal, in SI units; joints and ports are named by their paths, such as `leg[2].m[0].tilt`.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The joint that is commanded takes no commands.
    NoCommands {
        /// The path name of the joint.
        joint: String,
        /// The reason why the joint takes no commands.
        why: Uncommandable,
    },
    /// No limit bounds the least duration of the move, so the action needs a stated one.
    NoSpeed {
        /// The path name of the joint.
        joint: String,
    },
    /// A duration, speed, target, phase or keyframe is not finite, is negative where it must not be, or is out of range
    /// or order.
    BadNumber {
        /// The meaning of the number, such as `a duration`.
        what: &'static str,
        /// The number that was found, in SI units.
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
        /// The time that the joint takes to stop, s.
        needed: f64,
        /// The stated duration of the move, s.
        given: f64,
    },
    /// The plan would end while the joint still moves.
    StillTurning {
        /// The path name of the joint.
        joint: String,
        /// The speed at which the joint moves, rad/s or m/s.
        speed: f64,
    },
    /// The condition of an action without timeout never holds in the undisturbed run.
    NeverHolds,
    /// The behaviour aborts in the undisturbed run.
    Aborted {
        /// The message that `abort` states.
        message: String,
        /// The time at which the behaviour aborts, s from the start of the run.
        time: f64,
    },
    /// A port to be docked has a bond.
    PortTaken {
        /// The path name of the port.
        port: String,
        /// The path name of the port that is docked to the port.
        by: String,
    },
    /// A port to be undocked has no bond.
    PortFree {
        /// The path name of the port.
        port: String,
    },
    /// The connectors of two ports to be docked do not mate, or both ports are of one module.
    NoMate {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// Two ports are to be docked in a branch that the plan's undisturbed run does not take, so that it has no bond of them.
    NotPlanned {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// Two ports to be docked are on parts of the robot that no bonds connect.
    Apart {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// A phase or stretch contains a part that can't be shifted or scaled.
    NotCyclic {
        /// The part in words, such as `docking`.
        what: &'static str,
    },
    /// A motion that is stated by its goal has not become actions.
    Unresolved {
        /// The name of the built-in that makes such a goal.
        name: &'static str,
    },
    /// A piece of the motion is shorter than a tick of time.
    TooShort,
    /// A limit of the schedule is exceeded.
    Limit {
        /// The things that are counted, in words, such as `actions`.
        what: &'static str,
        /// The greatest number that the settings allow.
        limit: u64,
    },
}

impl Refusal {
    /// Returns a refusal with this reason that blames the action of this cause.
    pub fn at(cause: CauseId, reason: Reason) -> Refusal {
        Refusal { cause: Some(cause), reason }
    }

    /// Returns the refusal of a motion that is stated by its goal and has not become actions.
    pub fn unresolved(goal: &Goal) -> Refusal {
        Refusal::at(goal.cause, Reason::Unresolved { name: goal.name() })
    }

    /// Returns a refusal with this reason that blames no single action.
    pub fn whole(reason: Reason) -> Refusal {
        Refusal { cause: None, reason }
    }
}

/// The reason in words, with plain SI numbers; a caller who knows the user's units may say it better.
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
                let speed = crate::units::number(*speed);
                write!(f, "the plan ends while `{joint}` still turns at {speed} per second")
            }
            Reason::NeverHolds => write!(f, "the condition never holds, and there is no timeout"),
            Reason::Aborted { message, time } => write!(f, "aborted at {}: {message}", self::time(*time)),
            Reason::PortTaken { port, by } => write!(f, "`{port}` is taken by `{by}`"),
            Reason::PortFree { port } => write!(f, "nothing is docked at `{port}`"),
            Reason::NoMate { a, b } => write!(f, "`{a}` and `{b}` do not mate"),
            Reason::Apart { a, b } => write!(f, "nothing connects the parts of `{a}` and `{b}`"),
            Reason::NotPlanned { a, b } => write!(f, "the plan does not dock `{a}` and `{b}`"),
            Reason::NotCyclic { what } => write!(f, "{what} cannot be part of a cycle"),
            Reason::Unresolved { name } => {
                write!(f, "`{name}` is a goal, of which no motion has been planned yet")
            }
            Reason::TooShort => write!(f, "a piece of the motion is shorter than a tick of time"),
            Reason::Limit { what, limit } => write!(f, "more than {limit} {what}"),
        }
    }
}

/// Returns a time as text.
fn time(seconds: f64) -> String {
    quantity(seconds, Dimension::TIME)
}

/// Checks that a count is not above its limit; `what`: the name of what is counted, in words, for the refusal.
///
/// # Errors
/// [`Reason::Limit`] if it is.
pub(super) fn limit(value: u64, max: u64, what: &'static str) -> Result<(), Refusal> {
    if value > max { Err(Refusal::whole(Reason::Limit { what, limit: max })) } else { Ok(()) }
}
