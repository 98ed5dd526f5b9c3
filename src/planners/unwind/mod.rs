//! `unwind`: `tosnake` of modules of any kind, from a configuration to a snake.
//!
//! The tentacle paper (Mrázek, Ondika, Černá and Barnat, *Tentacle-Based Shape Shifting of Metamorphic Robots Using Fast
//! Inverse Kinematics*) wants no particular joints or docks, only that the docks are genderless. The declarations of the
//! modules say all that its method needs: the two docks that are the ends of a module in a snake ([`ends`](ends())), chains of
//! joints between docks, and shapes that must not meet. Modules of RoFI have a planner that knows them
//! ([`tosnake`](super::tosnake)), and is faster by far.
//!
//! 1. Bonds that close loops are undocked. Bonds between ends join modules to chains, the others join chains to a robot.
//! 2. Joints turn to zero as far as nothing meets.
//! 3. Free ends of two chains are brought together by [inverse kinematics](super::goals::reach) along a [free
//!    way](super::goals::avoid), and dock. In the loop that this closes is a bond between other docks, for the chains were two;
//!    it is undocked. If no pair comes together, joints turn at random, or a branch is moved to other docks, and all is tried
//!    again.
//! 4. The snake turns its joints to zero.
//!
//! All modules are to lie alike in the snake, the first end on the second one of the next, without a turn: then all snakes of as
//! many modules are the same one. If the search finds no way to that, any way round will do.
//!
//! There is neither gravity nor ground.

#![allow(non_snake_case)]

mod between;
mod chains;
mod ends;
mod program;
mod refusal;
mod search;
mod settings;
mod tolerances;

pub use between::{BetweenRefusal, between};
pub use ends::{Ends, Unfit, ends};
pub use refusal::{Refusal, Status};
pub use settings::Settings;

use super::tosnake::Report;
use super::{Progress, Solution};
use crate::behavior;
use crate::plan::{Body, CauseId};
use crate::robot::{Assembly, State};
use search::{Search, Step};

/// A problem of unwinding: a robot that is to become a snake, and its start.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The robot.
    pub robot: &'a Assembly,
    /// The state at the start: joint positions (rad or m), closed bonds, pose of the base in the world frame.
    pub start: &'a State,
}

/// Plans the motion from a configuration to a snake: one chain of all modules, each joined by its two [ends](ends()), with
/// all joints at zero. All causes of the solution are cause 0.
///
/// # Errors
/// A [`Refusal`] where modules lack what the method needs, the start is in pieces or has modules in each other, the budget
/// does not suffice, the snake does not get straight, the steps can't be scheduled, or `progress` ended the search.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let Problem { robot, start } = *problem;
    progress.task_started(&|| format!("unwinding {}", robot.name));
    let mut search = Search::new(robot, start, settings, true)?;
    match search.run(progress) {
        Err(Refusal::Exhausted(_)) => {
            let (tried, work) = (search.tried, search.work);
            search = Search::new(robot, start, settings, false)?;
            (search.tried, search.work) = (tried, work);
            search.run(progress)?;
        }
        found => found?,
    }
    let scheduled = behavior::schedule(behavior::Problem {
        robot: robot.clone(),
        start: start.clone(),
        program: program::program(&search.robot, &start.joints, &search.steps, CauseId(0)),
        start_causes: Vec::new(),
        bond_causes: (0..robot.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
        settings: behavior::Settings::default(),
    })
    .map_err(Refusal::Schedule)?;
    assert!(scheduled.exemptions.is_empty() && !scheduled.nominal, "steps have neither");
    let mut report = Report {
        fewest_changes: search.fewest_changes(start),
        tried: search.tried,
        work: search.work,
        actions: scheduled.actions,
        ..Report::default()
    };
    let mut at = &start.joints;
    for step in &search.steps {
        match step {
            Step::Dock(_) => report.docks += 1,
            Step::Undock(_) => report.undocks += 1,
            Step::Turn(joints) => {
                report.joint_travel += joints.iter().zip(at).map(|(to, from)| (to - from).abs()).sum::<f64>();
                at = joints;
            }
        }
    }
    Ok(Solution { body: Body::Tracks(scheduled.tracks), program: Some(scheduled.program), report })
}
