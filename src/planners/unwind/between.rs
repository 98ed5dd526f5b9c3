//! From one configuration to another through the snake.

use super::refusal::Refusal;
use super::settings::Settings;
use super::{Problem, plan as unwound};
use crate::plan::{self, Cause, OperationError, Plan, World, joined, reversed};
use crate::planners::reconfigure::{Report, Way};
use crate::planners::tosnake;
use crate::planners::{Progress, Solution};
use std::error::Error;
use std::fmt;

/// The reason why there is no reconfiguration.
#[derive(Clone, Debug, PartialEq)]
pub enum BetweenRefusal {
    /// The start can't be unwound into a snake, for the reason given.
    From(Refusal),
    /// The goal can't be unwound into a snake, for the reason given.
    To(Refusal),
    /// The two configurations unwind to different snakes.
    DifferentSnakes(OperationError),
}

impl fmt::Display for BetweenRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BetweenRefusal::From(refusal) => write!(f, "the start can't be unwound: {refusal}"),
            BetweenRefusal::To(refusal) => write!(f, "the goal can't be unwound: {refusal}"),
            BetweenRefusal::DifferentSnakes(error) => {
                write!(f, "both unwind to a snake, but not to the same one: {error}")
            }
        }
    }
}

impl Error for BetweenRefusal {}

/// Plans the motion from one configuration to another: the first one unwinds, and the second one's unwinding is run
/// backwards. In the solution cause 0 is that of the first half and cause 1 that of the second. `judge`: the settings of the
/// judge that the plan states.
///
/// # Errors
/// A [`BetweenRefusal`] where either configuration can't be unwound, or the snakes differ.
pub fn between(
    (from, to): (&Problem, &Problem),
    settings: &Settings,
    judge: plan::Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, BetweenRefusal> {
    let mut half = |problem: &Problem| -> Result<(Plan, tosnake::Report), Refusal> {
        let Solution { body, program, report } = unwound(problem, settings, progress)?;
        let bare = Plan::bare(problem.robot.library.clone(), body, World::FREE, judge);
        Ok((Plan { program, causes: vec![Cause::planner_call()], ..bare }, report))
    };
    let (there, first) = half(from).map_err(BetweenRefusal::From)?;
    let (back, second) = half(to).map_err(BetweenRefusal::To)?;
    let plan = joined(&there, &reversed(&back)).map_err(BetweenRefusal::DifferentSnakes)?;
    let both = tosnake::Report {
        docks: first.docks + second.undocks,
        undocks: first.undocks + second.docks,
        joint_travel: first.joint_travel + second.joint_travel,
        tried: first.tried + second.tried,
        work: first.work + second.work,
        actions: first.actions + second.actions,
    };
    let bonds = |problem: &Problem| problem.start.bonds.iter().filter(|holds| **holds).count();
    let report = Report {
        both,
        way: Way::Snake { direct: None },
        fewest_changes: bonds(from).abs_diff(bonds(to)),
        history: plan.provenance.history,
        verdict: None,
    };
    Ok(Solution { body: plan.body, program: plan.program, report })
}
