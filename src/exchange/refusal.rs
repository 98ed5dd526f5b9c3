//! The reasons why a plan is not written in a format.

use crate::formats::mjcf::MjcfFault;
use crate::plan::PlanFault;
use std::fmt;

/// The reason why a plan is not written in a format.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The plan is not valid, for the reason given.
    Invalid(PlanFault),
    /// The format is one of links and joints, which lattices and trusses have not.
    NoJoints {
        /// The format in words, such as "a robot description".
        format: &'static str,
    },
    /// MuJoCo has no such model.
    Mjcf(MjcfFault),
    /// A bond closes a kinematic loop, which URDF, a tree of links, can't state.
    Loop {
        /// The name of the bond.
        bond: String,
        /// The time from which on it closes the loop, s.
        time: f64,
    },
    /// The robot has more links than pictures and scenes are made of.
    TooMany {
        /// The things counted, in words.
        what: &'static str,
        /// Their number.
        count: usize,
        /// The greatest number of them.
        most: usize,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Refusal::Invalid(fault) => write!(f, "the plan is not valid: {fault}"),
            Refusal::NoJoints { format } => {
                write!(f, "{format} is one of links and joints, which lattices and trusses have not")
            }
            Refusal::Mjcf(fault) => fault.fmt(f),
            Refusal::Loop { bond, time } => write!(
                f,
                "URDF has no closed loops, and the bond {bond} closes one at {time} s: `.{}` has them",
                crate::formats::mjcf::ENDING
            ),
            Refusal::TooMany { what, count, most } => write!(f, "{count} {what} are more than {most}"),
        }
    }
}

impl std::error::Error for Refusal {}
