//! Programs for the tests, built by plain Rust: short names for actions and their composition.
#![allow(dead_code)]

use modl::behavior::{Problem, Refusal, Scheduled, Settings, schedule};
use modl::plan::{Action, CauseId, Command, Compare, Condition, Node, Otherwise, Profile, Signal, Target};
use modl::robot::{Assembly, JointId, State};
use std::sync::Arc;

pub fn action(command: Command, cause: u32) -> Action {
    Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause: CauseId(cause) }
}

pub fn act(command: Command, cause: u32) -> Arc<Node> {
    Arc::new(Node::Action(action(command, cause)))
}

pub fn moving(joint: u32, target: Target, duration: Option<f64>, profile: Profile) -> Command {
    Command::Move { joint: JointId(joint), target, duration, profile }
}

/// A smooth move in least time.
pub fn go(joint: u32, to: f64, cause: u32) -> Arc<Node> {
    act(moving(joint, Target::To(to), None, Profile::Smooth), cause)
}

/// A smooth move in a given time.
pub fn go_in(joint: u32, to: f64, duration: f64, cause: u32) -> Arc<Node> {
    act(moving(joint, Target::To(to), Some(duration), Profile::Smooth), cause)
}

pub fn by(joint: u32, change: f64, cause: u32) -> Arc<Node> {
    act(moving(joint, Target::By(change), None, Profile::Smooth), cause)
}

pub fn spinning(joint: u32, speed: f64, duration: Option<f64>) -> Command {
    Command::Spin { joint: JointId(joint), speed, duration }
}

pub fn spin_for(joint: u32, speed: f64, duration: f64, cause: u32) -> Arc<Node> {
    act(spinning(joint, speed, Some(duration)), cause)
}

pub fn spin(joint: u32, speed: f64, cause: u32) -> Arc<Node> {
    act(spinning(joint, speed, None), cause)
}

pub fn wait(duration: f64) -> Arc<Node> {
    act(Command::Wait { duration }, 0)
}

pub fn until(command: Command, condition: Condition, cause: u32) -> Action {
    Action { until: Some(condition), ..action(command, cause) }
}

pub fn node(action: Action) -> Arc<Node> {
    Arc::new(Node::Action(action))
}

pub fn angle(joint: u32, compare: Compare, value: f64) -> Condition {
    Condition::Compare { signal: Signal::Angle(JointId(joint)), compare, value }
}

pub fn series(list: Vec<Arc<Node>>) -> Arc<Node> {
    Arc::new(Node::Series(list))
}

pub fn parallel(list: Vec<Arc<Node>>) -> Arc<Node> {
    Arc::new(Node::Parallel(list))
}

pub fn repeat(body: Arc<Node>, times: u64) -> Arc<Node> {
    Arc::new(Node::Repeat { body, times, until: None })
}

/// Schedules from rest at zero.
pub fn plan(robot: Assembly, program: Arc<Node>) -> Result<Scheduled, Refusal> {
    let start = crate::support::robots::at_rest(&robot);
    plan_from(robot, start, program)
}

pub fn plan_from(robot: Assembly, start: State, program: Arc<Node>) -> Result<Scheduled, Refusal> {
    let settings = Settings::default();
    schedule(Problem { robot, start, program, start_causes: vec![], bond_causes: vec![], settings })
}
