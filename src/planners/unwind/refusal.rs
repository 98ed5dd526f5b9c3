//! The reasons for which there is no plan.

use super::ends::Unfit;
use crate::behavior;
use crate::geometry::Unsound;
use crate::planners::goals::Meeting;
use std::error::Error;
use std::fmt;

/// The state of a search at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// The number of connections between ends that a snake has.
    pub needed: usize,
    /// The number of these that were made.
    pub made: usize,
    /// The number of attempts to bring two ends together.
    pub tried: u64,
    /// The number of postures that were examined.
    pub work: u64,
}

/// The reason why there is no plan to the snake. Modules are named by their indices in the assembly.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// A module lacks what the method needs.
    Unfit(Unfit),
    /// The robot has more links than the planner takes.
    Links {
        /// The number of links.
        found: usize,
        /// The greatest number.
        limit: usize,
    },
    /// A module is not connected to the base.
    Pieces(usize),
    /// Two bodies overlap at the start.
    Overlap(Meeting),
    /// A shape is not sound.
    Unsound(Unsound),
    /// The budget is spent.
    BudgetSpent(Status),
    /// No pair of ends came together in many rounds.
    Exhausted(Status),
    /// The observer ended the search.
    Stopped(Status),
    /// All modules are in one chain, in which these joints do not get to zero, by name.
    Bent(Vec<String>),
    /// The steps can't be scheduled as a program, for the reason given.
    Schedule(behavior::Refusal),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reached = |f: &mut fmt::Formatter<'_>, what: &str, status: &Status| {
            let Status { needed, made, tried, .. } = status;
            write!(f, "{what}: {made} of {needed} connections were made, and {tried} pairs of ends tried")
        };
        match self {
            Refusal::Unfit(unfit) => unfit.fmt(f),
            Refusal::Links { found, limit } => {
                write!(
                    f,
                    "the robot has {found} links; robots of up to {limit} are unwound, but for RoFI modules"
                )
            }
            Refusal::Pieces(module) => write!(f, "module {module} is not connected to the base"),
            Refusal::Overlap(Meeting { bodies: [a, b], .. }) => {
                write!(f, "`{a}` and `{b}` are in each other before anything moves")
            }
            Refusal::Unsound(unsound) => unsound.fmt(f),
            Refusal::BudgetSpent(status) => reached(f, "no way to the snake within the budget", status),
            Refusal::Exhausted(status) => reached(f, "no way to the snake was found", status),
            Refusal::Stopped(status) => reached(f, "no way to the snake within the timeout", status),
            Refusal::Bent(joints) => write!(f, "the snake does not get straight: {}", joints.join(", ")),
            Refusal::Schedule(refusal) => write!(f, "the steps can't be scheduled: {}", refusal.reason),
        }
    }
}

impl Error for Refusal {}
