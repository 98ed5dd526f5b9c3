//! Scheduling and judgement of a folding program.

use crate::behavior::{self, Scheduled};
use crate::interrupt;
use crate::plan::{self, Body, Cause, CauseId, Failure, Node, Plan, Verdict, World};
use crate::planners::Solution;
use crate::robot::{Assembly, State};
use std::sync::Arc;

/// A folding program to be scheduled and judged: the robot with its start, the program, and the world and settings
/// under which the judge decides.
pub(crate) struct Motion {
    /// The robot that folds.
    pub robot: Assembly,
    /// The state of the robot at the beginning.
    pub start: State,
    /// The program of the folding; all its actions have cause 0.
    pub program: Arc<Node>,
    /// The world that the plan assumes.
    pub world: World,
    /// The settings of the judge that the plan has to pass.
    pub judge: plan::Settings,
}

/// The number of actions of a motion that the judge accepts, with the verdict.
pub(crate) struct Judged {
    /// The number of actions of the program.
    pub actions: u64,
    /// The verdict of the judge on the plan.
    pub verdict: Verdict,
}

/// The reason why [`judged`] refuses a motion.
pub(crate) enum Fault {
    /// The program can't be scheduled, for the reason given.
    Schedule(behavior::Refusal),
    /// A stated duration is shorter than the limits of a joint allow.
    TooFast,
    /// The judge refuses the plan, with its earliest failure.
    Refused(Box<Failure>),
}

/// Schedules a motion (turns its program into joint trajectories) and puts the plan before the judge; returns the
/// plan's body and program, with the verdict in the report.
///
/// # Errors
/// [`Fault::Schedule`] if the program can't be scheduled, [`Fault::TooFast`] if a stated duration is shorter than the
/// joints' limits allow, [`Fault::Refused`] with the earliest failure of the verdict.
pub(crate) fn judged(motion: Motion) -> Result<Solution<Judged>, Fault> {
    let Motion { robot, start, program, world, judge } = motion;
    let (name, bonds) = (robot.name.clone(), robot.bonds.len());
    let problem = behavior::Problem {
        robot,
        start,
        program,
        start_causes: Vec::new(),
        bond_causes: (0..bonds).map(|bond| (bond, CauseId(0))).collect(),
        settings: behavior::Settings::default(),
    };
    let Scheduled { tracks, program, exemptions, nominal, actions, issues, .. } =
        behavior::schedule(problem).map_err(Fault::Schedule)?;
    if !issues.is_empty() {
        return Err(Fault::TooFast);
    }
    interrupt::start_task(format!("verifying {name}"));
    let bare = Plan::bare(tracks.robot.library.clone(), Body::Tracks(tracks), world, judge);
    let causes = vec![Cause::planner_call()];
    let plan = Plan { program: Some(program), nominal, causes, exemptions, ..bare };
    let verdict = plan::verify::verify(&plan);
    if !verdict.ok() {
        let first = verdict.failures.into_iter().reduce(|a, b| if b.time < a.time { b } else { a });
        let unjudged = || Failure::form("the plan can't be judged".to_owned());
        return Err(Fault::Refused(Box::new(first.unwrap_or_else(unjudged))));
    }
    let Plan { body, program, .. } = plan;
    Ok(Solution { body, program, report: Judged { actions, verdict } })
}
