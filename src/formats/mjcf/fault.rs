//! The reasons why a plan has no model.

use crate::plan::PlanFault;
use std::fmt;

/// The reason why a plan has no MuJoCo model (MJCF).
#[derive(Clone, Debug, PartialEq)]
pub enum MjcfFault {
    /// The plan is one of a lattice or a truss, which has no links and joints.
    NoJoints,
    /// The plan is not valid, for the reason given.
    Invalid(PlanFault),
    /// More links hang on each other in a row than MuJoCo reads.
    TooDeep {
        /// The number of links in the longest row.
        depth: usize,
        /// The greatest number of links in a row that MuJoCo reads.
        most: usize,
    },
}

impl fmt::Display for MjcfFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            MjcfFault::NoJoints => f.write_str(
                "a model for MuJoCo is one of links and joints, which lattices and trusses have not",
            ),
            MjcfFault::Invalid(fault) => write!(f, "the plan is not valid: {fault}"),
            MjcfFault::TooDeep { depth, most } => write!(
                f,
                "{depth} links hang on each other in a row, and MuJoCo reads {most} at most: a base nearer to the \
                 middle halves that"
            ),
        }
    }
}

impl std::error::Error for MjcfFault {}
