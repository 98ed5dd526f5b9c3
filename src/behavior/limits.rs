//! The check of a program's commands against the limits of the joints, without running it: targets outside ranges,
//! speeds that no motor reaches, joints that take no commands, ports that do not mate.

use super::condition;
use super::docking::mate;
use super::joints::{JointFacts, Uncommandable, facts};
use super::law::{self, MotionLimits};
use crate::plan::visit::Graph;
use crate::plan::{Action, CauseId, Command, Node, Target, polynomial};
use crate::robot::{Assembly, JointId};
use std::sync::Arc;

/// An issue of a program: a command that asks for more than the robot can do.
#[derive(Clone, Debug, PartialEq)]
pub struct Issue {
    /// The cause of the command that asks for too much.
    pub cause: CauseId,
    /// The argument of the command that is at fault.
    pub part: Part,
    /// The demand that the robot cannot meet.
    pub kind: IssueKind,
}

/// An argument of a command or of its action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The argument that names the joint.
    Joint,
    /// The argument for the position at which a move ends.
    Target,
    /// The argument for the speed of a spin.
    Speed,
    /// The argument for the duration of a move, a spin or a wait.
    Duration,
    /// The argument for the timeout of the action.
    Timeout,
    /// The argument for the keyframes of a followed function.
    Keyframes,
    /// The argument for the condition with which the action ends.
    Until,
    /// The arguments for the two ports to dock.
    Ports,
}

/// The demand of a command that cannot be met, in SI units; joints and ports by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum IssueKind {
    /// A position, the target of a move or that of a keyframe, is outside the joint's range.
    OutOfRange {
        /// The path name of the joint.
        joint: String,
        /// The position asked for, rad or m.
        position: f64,
        /// The lowest and the highest position, rad or m.
        range: (f64, f64),
        /// `true` for a joint that moves along its axis, in metres.
        prismatic: bool,
    },
    /// A speed, of a spin or between keyframes, is more than the joint or a motor that drives it can do.
    TooFast {
        /// The path name of the joint.
        joint: String,
        /// The speed asked for, rad/s or m/s; negative towards lower positions.
        speed: f64,
        /// The greatest speed of the joint, rad/s or m/s.
        limit: f64,
        /// `true` for a joint that moves along its axis, in metres.
        prismatic: bool,
    },
    /// The duration of a move is shorter than the joint's limits allow.
    TooShort {
        /// The path name of the joint.
        joint: String,
        /// The duration that the command states, s.
        given: f64,
        /// The least duration that the limits allow, s.
        needed: f64,
    },
    /// The joint that is commanded takes no commands.
    NoCommands {
        /// The path name of the joint.
        joint: String,
        /// The reason why the joint takes no commands.
        why: Uncommandable,
    },
    /// The connectors of the ports to dock do not mate, or both ports are of one module.
    NoMate {
        /// The path name of the first port.
        a: String,
        /// The path name of the second port.
        b: String,
    },
    /// A number is not finite or is negative where it must not be, or a condition is nested too deep.
    BadNumber {
        /// The number that was found, in SI units; of a condition the greatest depth that is allowed.
        value: f64,
    },
}

/// Returns the issues of every action of a program on a robot, in the order of [`Graph::actions`], each action once
/// however often it is repeated. The durations of moves to a position are not checked, since they depend on the
/// position before: see [`Scheduled::issues`](super::Scheduled::issues). `tol` is the fraction of a limit or range by
/// which it may be exceeded, for rounding ([`Settings::tol_duration`](super::Settings::tol_duration)).
pub fn issues(robot: &Assembly, program: &Arc<Node>, tol: f64) -> Vec<Issue> {
    let facts = facts(robot);
    let mut found = Vec::new();
    for action in Graph::of(program).actions() {
        let mut judge = Judge { robot, facts: &facts, tol, action, found: &mut found };
        judge.action();
    }
    found
}

/// The check of one action.
struct Judge<'a> {
    robot: &'a Assembly,
    facts: &'a [JointFacts],
    tol: f64,
    action: &'a Action,
    found: &'a mut Vec<Issue>,
}

impl<'a> Judge<'a> {
    /// Checks timeout, condition and command.
    fn action(&mut self) {
        // The action's timeout and condition.
        if let Some(timeout) = self.action.timeout {
            self.at_least_zero(Part::Timeout, timeout);
        }
        if self.action.until.as_ref().is_some_and(|c| condition::depth(c) > condition::DEPTH_MAX) {
            self.report(Part::Until, IssueKind::BadNumber { value: condition::DEPTH_MAX as f64 });
        }
        // The arguments of its command.
        match &self.action.command {
            Command::Move { joint, target, duration, profile } => {
                self.joint(*joint);
                let change = match *target {
                    Target::To(position) => {
                        self.position(Part::Target, *joint, position);
                        None
                    }
                    Target::By(change) => Some(change),
                };
                if let Some(given) = *duration {
                    self.at_least_zero(Part::Duration, given);
                    self.short(
                        *joint,
                        given,
                        change.and_then(|c| law::least_duration(*profile, c, self.able(*joint))),
                    );
                }
            }
            Command::Spin { joint, speed, duration } => {
                self.joint(*joint);
                self.speed(Part::Speed, *joint, *speed);
                if let Some(given) = *duration {
                    self.at_least_zero(Part::Duration, given);
                }
            }
            Command::Follow { joint, keyframes } => {
                self.joint(*joint);
                self.keyframes(*joint, keyframes);
            }
            Command::Wait { duration } => self.at_least_zero(Part::Duration, *duration),
            Command::Dock { a, b } => {
                if !mate(self.robot, *a, *b) {
                    let (a, b) = (self.robot.port_name(*a), self.robot.port_name(*b));
                    self.report(Part::Ports, IssueKind::NoMate { a, b });
                }
            }
            Command::Undock { .. } => {}
        }
    }

    fn joint(&mut self, joint: JointId) {
        let facts = self.of(joint);
        if let Some(why) = facts.uncommandable {
            self.report(Part::Joint, IssueKind::NoCommands { joint: facts.name.clone(), why });
        }
    }

    fn position(&mut self, part: Part, joint: JointId, position: f64) {
        let facts = self.of(joint);
        if !position.is_finite() {
            return self.report(part, IssueKind::BadNumber { value: position });
        }
        let Some(range) = facts.range else { return };
        let slack = self.tol * (range.1 - range.0);
        if position < range.0 - slack || position > range.1 + slack {
            let (joint, prismatic) = (facts.name.clone(), facts.prismatic);
            self.report(part, IssueKind::OutOfRange { joint, position, range, prismatic });
        }
    }

    fn speed(&mut self, part: Part, joint: JointId, speed: f64) {
        let facts = self.of(joint);
        if !speed.is_finite() {
            return self.report(part, IssueKind::BadNumber { value: speed });
        }
        let Some(limit) = facts.speed else { return };
        if speed.abs() > limit * (1.0 + self.tol) {
            let (joint, prismatic) = (facts.name.clone(), facts.prismatic);
            self.report(part, IssueKind::TooFast { joint, speed, limit, prismatic });
        }
    }

    fn short(&mut self, joint: JointId, given: f64, least: Option<f64>) {
        let Some(needed) = least.filter(|needed| given < needed * (1.0 - self.tol)) else { return };
        let joint = self.of(joint).name.clone();
        self.report(Part::Duration, IssueKind::TooShort { joint, given, needed });
    }

    /// Checks the keyframes of a followed function, and the cubics between them: at most one issue of each
    /// kind.
    fn keyframes(&mut self, joint: JointId, keyframes: &[[f64; 3]]) {
        let before = self.found.len();
        if let Some(value) = keyframes.iter().flatten().copied().find(|v| !v.is_finite()) {
            return self.report(Part::Keyframes, IssueKind::BadNumber { value });
        }
        for keyframe in keyframes {
            self.position(Part::Keyframes, joint, keyframe[1]);
            if self.found.len() > before {
                break;
            }
        }
        let before = self.found.len();
        for piece in law::cubic_pieces(keyframes).into_iter().filter(|p| p.duration > 0.0) {
            let rates = polynomial::derivative(&piece.control);
            for u in [0.0, 0.5, 1.0] {
                self.speed(Part::Keyframes, joint, polynomial::value(&rates, u) / piece.duration);
                if self.found.len() > before {
                    return;
                }
            }
        }
    }

    fn at_least_zero(&mut self, part: Part, value: f64) {
        if !(value >= 0.0 && value.is_finite()) {
            self.report(part, IssueKind::BadNumber { value });
        }
    }

    fn of(&self, joint: JointId) -> &'a JointFacts {
        &self.facts[joint.0 as usize]
    }

    fn able(&self, joint: JointId) -> MotionLimits {
        let facts = self.of(joint);
        MotionLimits { speed: facts.speed, acceleration: facts.acceleration }
    }

    fn report(&mut self, part: Part, kind: IssueKind) {
        self.found.push(Issue { cause: self.action.cause, part, kind });
    }
}
