//! Trajectory generation: the tracks of a program's undisturbed run, a series-parallel graph of actions.
//!
//! The run goes from event to event. An action begins when all actions before it have completed; it
//! completes when its motion has, or, if it has one, when its condition holds, or when its time runs
//! out. Its command stays in force until the next command to the same joint, which takes over from where the
//! joint is then.

use super::joints::{self, JointFacts};
use super::limits::Issue;
use super::motion::Motion;
use super::played::Played;
use super::refusal::{Reason, Refusal};
use super::run::Run;
use crate::plan::visit::{Graph, without_contracts};
use crate::plan::{CauseId, Exemption, Node, Otherwise, Program, Tracks};
use crate::robot::{Assembly, JointId, State};
use std::sync::Arc;

/// A behaviour to be scheduled, and the state of the robot that it begins in.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The robot, with the bonds that its start state knows, closed or open.
    pub robot: Assembly,
    /// The state that the behaviour begins in, at rest: one position (rad or m) for every joint, by the number in its
    /// `JointId`, and one flag for every bond, by its index, true if it holds.
    pub start: State,
    /// The behaviour, a series-parallel graph of actions.
    pub program: Arc<Node>,
    /// The causes of start positions as (joint, cause), which become those of the tracks.
    pub start_causes: Vec<(JointId, CauseId)>,
    /// The causes of bonds as (index in the robot's bonds, cause), which become those of the tracks.
    pub bond_causes: Vec<(usize, CauseId)>,
    /// The limits of scheduling, beyond which the behaviour is refused, and its tolerances.
    pub settings: Settings,
}

/// The limits of [`schedule`], beyond which it refuses a behaviour, and its tolerances; each field states its
/// default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The greatest number of actions that are carried out, repetitions included, in each run of a behaviour or of a
    /// cycle's body. Default 5 million.
    pub actions_max: u64,
    /// The greatest number of pieces of motion of all joints together. Default 10 million.
    pub segments_max: u64,
    /// The greatest number of nodes that are entered, empty ones included. Default 50 million.
    pub steps_max: u64,
    /// The deepest nesting of a program. Default 1000.
    pub depth_max: u64,
    /// The deepest nesting of phases, approaches and stretches in each other. Default 8.
    pub cycles_max: u64,
    /// The greatest distance from the joint at which a followed function, or a cycle, may begin, rad or m. Default
    /// 1e-6: rounding, which can't be seen.
    pub tol_begin: f64,
    /// The fraction of the least duration by which a stated one may be shorter. Default 1e-9: rounding.
    pub tol_duration: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            actions_max: 5_000_000,
            segments_max: 10_000_000,
            steps_max: 50_000_000,
            depth_max: 1_000,
            cycles_max: 8,
            tol_begin: 1e-6,
            tol_duration: 1e-9,
        }
    }
}

/// The undisturbed run of a behaviour, as [`schedule`] records it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scheduled {
    /// The motion of every joint, and the changes of bonds.
    pub tracks: Tracks,
    /// The behaviour itself, which a robot executes.
    pub program: Program,
    /// The intervals of the motion that are excused from a check of the judge.
    pub exemptions: Vec<Exemption>,
    /// The intervals of the motion over which contracts are judged, in the order in which they begin.
    pub contracts: Vec<ContractInterval>,
    /// True if times depend on sensors or timeouts; the times are then those of the undisturbed run.
    pub nominal: bool,
    /// The number of actions that were carried out, repetitions included.
    pub actions: u64,
    /// The bonds whose turns are not known, in order of time, by their indices: robots that stood by themselves dock by them,
    /// or they were closed after that. The turns stand as 0, or as bonds before had made them.
    pub open_turns: Vec<usize>,
    /// Stated durations that are shorter than the joints' limits allow, at most one for each cause.
    pub issues: Vec<Issue>,
}

/// The interval of a behaviour that has a contract, in one of its uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContractInterval {
    /// The number of the contract, as its [`Node::Contract`] has it.
    pub number: u32,
    /// The cause that is to blame where the contract does not hold.
    pub cause: CauseId,
    /// The time at which the behaviour begins, s.
    pub from: f64,
    /// The time at which all of it has ended, s.
    pub to: f64,
}

/// Schedules a behaviour, a series-parallel action graph (Section V-B of the compositional-design paper, Tosun, Jing,
/// Kress-Gazit and Yim): runs it undisturbed from event to event. Commands in conflict are not searched here: see
/// [`conflicts`](super::conflicts).
///
/// # Errors
/// A [`Refusal`] with the action to blame, if a command cannot be carried out, a condition never
/// holds, the behaviour aborts, a joint still turns at the end, or a limit of the settings is exceeded.
///
/// # Panics
/// Panics unless the start has one position for every joint and one flag for every bond.
pub fn schedule(problem: Problem) -> Result<Scheduled, Refusal> {
    let Problem { robot, start, program, start_causes, bond_causes, settings } = problem;
    let graph = Graph::of(&program);
    if graph.depth as u64 > settings.depth_max {
        return Err(Refusal::whole(Reason::Limit { what: "nested behaviours", limit: settings.depth_max }));
    }
    let nominal = graph.nodes.iter().any(|node| match &***node {
        Node::Action(action) => {
            action.timeout.is_some()
                || matches!(action.otherwise, Otherwise::Node(_))
                || action.until.as_ref().is_some_and(super::condition::senses)
        }
        Node::Repeat { until: Some(until), .. } => super::condition::senses(until),
        _ => false,
    });
    let facts: Vec<JointFacts> = joints::facts(&robot);
    assert_eq!(facts.len(), start.joints.len(), "a state has one position for every joint");
    assert_eq!(robot.bonds.len(), start.bonds.len(), "a state has one flag for every bond");
    let motions = start.joints.iter().map(|&q| Motion::at_rest(q)).collect();
    let obstacles = Default::default();
    let run = Run::new(Arc::new(robot), facts, motions, start.bonds.clone(), settings);
    let Played {
        robot,
        tracks,
        joints,
        docks,
        open_turns,
        duration,
        exemptions,
        contracts,
        actions,
        issues,
        ..
    } = run.play(&program)?;
    let robot = Arc::unwrap_or_clone(robot);
    let bonds = robot.bonds.iter().enumerate().map(|(i, _)| start.bonds.get(i).copied().unwrap_or(false));
    let start = State { bonds: bonds.collect(), joints, ..start };
    drop(graph);
    Ok(Scheduled {
        tracks: Tracks {
            robot,
            start,
            tracks,
            events: docks,
            duration,
            obstacles,
            start_causes,
            bond_causes,
        },
        program: Program { root: without_contracts(&program) },
        exemptions,
        contracts,
        nominal,
        actions,
        open_turns,
        issues,
    })
}
