//! Behaviours with goals: their planning, and what is said where a goal can't be reached.

use super::behavior::{in_library, with_instance};
use super::causes::PlanCauses;
use super::design::Design;
use super::interpreter::Interpreter;
use super::planning::state_value;
use super::robot::Robot;
use super::stop::{Eval, Stop};
use crate::behavior::{self, Scheduled};
use crate::geometry::Pose;
use crate::plan::visit::Graph;
use crate::plan::{CauseId, Ground, Node, World};
use crate::planners::RequestedProgress;
use crate::planners::goals::{
    GOALS_MAX, Misplaced, Problem, Reason, Refusal, Resolved, avoid, line, reach, resolve,
};
use crate::robot::State;
use crate::source::{Code, Diagnostic, Span, code};
use std::cell::OnceCell;
use std::rc::Rc;
use std::sync::Arc;

/// A behaviour's robot, with the state and the world in which the behaviour is to begin.
pub(super) struct Stated<'a> {
    /// The design of the robot.
    pub design: &'a Rc<Design>,
    /// The robot.
    pub robot: &'a Rc<Robot>,
    /// The state in which the behaviour begins.
    pub start: &'a State,
    /// The world that is assumed.
    pub world: World,
    /// The causes that the program names.
    pub causes: &'a PlanCauses,
}

impl Interpreter<'_> {
    /// Returns a program in which actions stand in the place of goals; one without goals as it is. `stated`: what the program
    /// is of; `span`: the code that asks for the plan.
    ///
    /// # Errors
    /// A fault at the goal that does not become actions.
    pub(super) fn resolved(&self, stated: &Stated, program: &Arc<Node>, span: Span) -> Eval<Resolved> {
        if !Graph::of(program).nodes.iter().any(|node| matches!(&***node, Node::Goal(_))) {
            return Ok(Resolved { program: program.clone(), paths: Vec::new() });
        }
        crate::interrupt::start_task(format!("planning {}", stated.design.name));
        let problem = Problem {
            robot: &stated.robot.assembly,
            start: stated.start,
            program,
            obstacles: &stated.robot.obstacles,
            floor: stated.world.has_floor(),
            settings: behavior::Settings::default(),
        };
        let mut placing = |scheduled: &mut Scheduled, time: f64| self.placed(stated, scheduled, time);
        resolve(&problem, &mut placing, &mut RequestedProgress)
            .map_err(|refusal| self.goal_refused(&refusal, &stated.causes.ids, span))
    }

    /// Returns the world poses of all links at a time of a motion, as the judge's ground has it, and gives bonds by which
    /// robots docked on the way the turns in which they did.
    fn placed(&self, stated: &Stated, scheduled: &mut Scheduled, time: f64) -> Vec<Pose> {
        let mut before = scheduled.clone();
        // Marks of goals are no exemptions.
        before.exemptions.clear();
        let (design, robot) = (stated.design.clone(), stated.robot.clone());
        let mut planned = self.assemble_plan(design, robot, before, stated.causes, stated.world).0;
        planned.plan.program = None;
        if let Some(tracks) = planned.plan.body.tracks() {
            scheduled.tracks.robot.bonds.clone_from(&tracks.robot.bonds);
        }
        // A robot that is held does not move its base.
        let base = match stated.world.ground {
            Ground::Held => OnceCell::from(stated.start.base),
            Ground::Settle | Ground::Fixed | Ground::Off => OnceCell::new(),
        };
        let state = state_value(&Rc::new(planned), &Rc::new(vec![time]), 0, base);
        state.expect("the plan is one of joints").poses()
    }

    /// Returns the fault of a goal that does not become actions, at the goal, and at `span`.
    fn goal_refused(&self, refusal: &Refusal, ids: &[CauseId], span: Span) -> Stop {
        if let (None, Reason::Schedule(refusal)) = (refusal.cause, &*refusal.reason) {
            return self.refused(refusal, ids, span);
        }
        let (code, words, hint) = words(&refusal.reason);
        let message = if refusal.name.is_empty() { words } else { format!("`{}`: {words}", refusal.name) };
        let mut diagnostic = Diagnostic::error(code, message);
        if let Some(cause) = refusal.cause {
            let record = self.memory.causes.get(ids[cause.0 as usize]);
            diagnostic = diagnostic.label(record.primary(), with_instance("this goal".to_string(), record));
            diagnostic = in_library(diagnostic, record);
            if record.primary() != span {
                diagnostic = diagnostic.label(span, "planned here");
            }
        } else {
            diagnostic = diagnostic.label(span, "planned here");
        }
        match hint {
            Some(hint) => diagnostic.hint(hint).into(),
            None => diagnostic.into(),
        }
    }
}

/// Returns the code, the words and a hint for the reason why a goal does not become actions.
fn words(reason: &Reason) -> (Code, String, Option<&'static str>) {
    match reason {
        Reason::Reach(refusal) => {
            let code = match refusal {
                reach::Refusal::NoJoints => code::BAD_ACTION,
                reach::Refusal::TooFar { .. } | reach::Refusal::Unreachable { .. } => code::UNREACHABLE,
                reach::Refusal::Stopped => code::SIZE_LIMIT,
            };
            let hint = "ask for less: `position:` leaves the orientation free, `along:` the turn about the port's axis";
            (code, refusal.to_string(), (code == code::UNREACHABLE).then_some(hint))
        }
        Reason::Line(refusal) => {
            let (code, hint) = match refusal {
                line::Refusal::NoJoints | line::Refusal::NoArc => (code::BAD_ACTION, None),
                line::Refusal::Unreachable { .. } | line::Refusal::Singular { .. } => (
                    code::UNREACHABLE,
                    Some("begin in another posture, or go there by `reach`, which need not go straight"),
                ),
                line::Refusal::Deviates { .. } => {
                    (code::UNREACHABLE, Some("a greater `within` allows a greater deviation"))
                }
                line::Refusal::Stopped => (code::SIZE_LIMIT, None),
            };
            (code, refusal.to_string(), hint)
        }
        Reason::Avoid(refusal) => {
            let (code, hint) = match refusal {
                avoid::Refusal::Start(_) | avoid::Refusal::Goal(_) => (code::NOT_FREE, None),
                avoid::Refusal::Budget { .. } => (
                    code::NO_FREE_WAY,
                    Some("a greater `budget`, a smaller `clearance` or another `seed` may find one"),
                ),
                avoid::Refusal::Stopped => (code::SIZE_LIMIT, None),
            };
            (code, refusal.to_string(), hint)
        }
        Reason::Schedule(refusal) => (code::BAD_ACTION, refusal.reason.to_string(), None),
        Reason::Misplaced(why) => (
            code::BAD_ACTION,
            format!("where it begins is not known, because it stands {}", place(*why)),
            Some("a goal begins where the plan has brought the robot: put it into a series before or after"),
        ),
        Reason::NotConnected => {
            (code::BAD_ACTION, "nothing connects the port with what it is seen from".into(), None)
        }
        Reason::NoSpeed => (
            code::BAD_ACTION,
            "no joint that moves states a greatest speed: say how long it takes".into(),
            None,
        ),
        Reason::Docks => (
            code::BAD_ACTION,
            "the behaviour docks or undocks, and is no posture to go to".into(),
            Some("dock after the way: `Sc(avoid(..), dock(..))`"),
        ),
        Reason::TooMany => {
            (code::SIZE_LIMIT, format!("this behaviour has more than {GOALS_MAX} goals"), None)
        }
        Reason::Unsound(why) => (code::BAD_SHAPE, why.to_string(), None),
    }
}

/// Returns the place of a goal in words.
fn place(why: Misplaced) -> &'static str {
    match why {
        Misplaced::Else => "after `else`",
        Misplaced::Until => "in a repetition that ends by a condition",
        Misplaced::Cycle => "in a cycle, or in a behaviour that is stretched",
    }
}
