//! Behaviours as series-parallel trees with times, plans as sketches of their time.

use super::pretty::Branch;
use super::truss;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Behavior;
use crate::interpret::verdicts::failure_line;
use crate::plan::{self, Action, Command, Node, Profile, Target, Track, Tracks};
use crate::robot::{Assembly, JointId};
use crate::units::{Dimension, counted, quantity};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The greatest number of nodes of a behaviour that are drawn.
const NODES_DRAWN: usize = 200;
/// The greatest number of nodes of a behaviour that are visited for their times.
const NODES_TIMED: usize = 100_000;
/// The greatest depth of branches within branches that are drawn.
const DEPTH_DRAWN: usize = 30;
/// The number of characters for the duration of a plan in a sketch.
const SKETCH_WIDTH: usize = 48;
/// The greatest number of joints in a sketch.
const SKETCH_ROWS: usize = 16;
/// The greatest number of failures under a sketch.
const FAILURES_SHOWN: usize = 3;
/// Threshold: instants nearer to each other than this are one, s: rounding.
const TOL_INSTANT: f64 = 1e-9;

impl Interpreter<'_> {
    /// Returns a behaviour as text: the tree of its actions, with their times if it can be planned from the start pose.
    /// Reports nothing.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while it is planned.
    pub(super) fn display_behavior(&mut self, behavior: &Behavior) -> Eval<String> {
        let Some(design) = behavior.robot.as_ref().map(|robot| robot.design.clone()) else {
            return Ok("a behaviour that moves no robot".to_owned());
        };
        let declared = self.shared.program.def(design.def).span;
        let planned = self.quietly(|this| this.plan_behavior(behavior, declared))?;
        let robot = match &planned {
            Some(planned) => planned.body.clone(),
            None => self.quietly(|this| this.robot_of(&design, declared))?,
        };
        let Some(robot) = robot else { return Ok(format!("a behaviour of {}", design.name)) };
        let program = planned.as_ref().and_then(|planned| planned.plan.program.as_ref());
        let root = program.map_or(&behavior.node, |program| &program.root);
        let tracks = planned.as_ref().and_then(|planned| planned.plan.body.tracks());
        let mut drawer = Drawer { names: Names::of(&robot), tracks: by_joint(tracks), drawn: 0, timed: 0 };
        let branch = drawer.branch(root, tracks.map(|_| 0.0), 0);
        let long = tracks.map_or_else(
            || "it can't be planned as it is".to_owned(),
            |tracks| quantity(tracks.duration, Dimension::TIME),
        );
        let text = format!("a behaviour of {}, {long}", design.name);
        Ok(Branch { text, below: vec![branch] }.drawn())
    }

    /// Returns the result of `ask` without reporting anything; `None` also for a fault.
    fn quietly<T>(&mut self, ask: impl FnOnce(&mut Self) -> Eval<Option<T>>) -> Eval<Option<T>> {
        let errors = self.reported.errors;
        let (found, _) = self.capture_diagnostics(ask);
        self.reported.errors = errors;
        match found {
            Err(Stop::Fault(_)) => Ok(None),
            other => other,
        }
    }

    /// Returns a plan as text: its duration and verdict, a chart of the times at which joints move, and its failures.
    ///
    /// # Errors
    /// None: the result is always `Ok`.
    pub(super) fn display_plan(&mut self, planned: &Rc<PlanValue>) -> Eval<String> {
        let duration = planned.plan.body.duration();
        let settings = self.judge_settings();
        let verdict = self.judge(planned, settings, None)?;
        let mark =
            if verdict.ok() { plan::headline(&planned.plan, &verdict) } else { "NOT VERIFIED".to_owned() };
        let long = quantity(duration, Dimension::TIME);
        let mut lines = vec![format!("a plan of {long} of {}, {mark}", planned.robot.name)];
        let rows = rows(planned, duration);
        let wide = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        let row = |name: &str, marks: &str| format!("  {name:<wide$}  {}", marks.trim_end());
        lines.extend(rows.iter().take(SKETCH_ROWS).map(|(name, marks)| row(name, marks)));
        if rows.len() > SKETCH_ROWS {
            lines.push(format!("  and {} that move", counted(rows.len() - SKETCH_ROWS, "more joint")));
        }
        if duration > 0.0 {
            let rest = SKETCH_WIDTH.saturating_sub(1 + long.chars().count());
            lines.push(row("", &format!("0{:rest$}{long}", "")));
        }
        lines.extend(truss::made(planned));
        for failure in verdict.failures.iter().take(FAILURES_SHOWN) {
            lines.push(format!("  {}", failure_line(failure)));
        }
        if verdict.failures.len() > FAILURES_SHOWN {
            lines.push(format!("  and {} more", verdict.failures.len() - FAILURES_SHOWN));
        }
        Ok(lines.join("\n"))
    }
}

/// Returns the rows of a sketch: for each joint that moves its name with marks at its times, or one row with
/// the stages of a plan without joints.
fn rows(planned: &PlanValue, duration: f64) -> Vec<(String, String)> {
    match (planned.plan.body.tracks(), &planned.body) {
        (Some(tracks), Some(robot)) => {
            let names = Names::of(robot);
            let moving = tracks.tracks.iter().filter(|track| !track.segments.is_empty());
            moving.map(|track| (names.joint(track.joint), marks(track, duration))).collect()
        }
        _ => {
            let body = &planned.plan.body;
            let mut marks = vec!['─'; SKETCH_WIDTH];
            for instant in body.instants() {
                marks[column(instant, duration).min(SKETCH_WIDTH - 1)] = '│';
            }
            let steps = body.instants().len().saturating_sub(1);
            vec![(counted(steps, "stage"), marks.into_iter().collect())]
        }
    }
}

/// Returns the marks of a joint: one character for each part of the duration.
fn marks(track: &Track, duration: f64) -> String {
    let mut marks = vec!['·'; SKETCH_WIDTH];
    for segment in &track.segments {
        // However short, what moves is seen.
        let from = column(segment.start, duration).min(SKETCH_WIDTH - 1);
        let to = column(segment.end, duration).clamp(from + 1, SKETCH_WIDTH);
        marks[from..to].fill('█');
    }
    marks.into_iter().collect()
}

fn column(time: f64, duration: f64) -> usize {
    if duration > 0.0 { (time / duration * SKETCH_WIDTH as f64) as usize } else { 0 }
}

fn by_joint(tracks: Option<&Tracks>) -> BTreeMap<u32, &Track> {
    let tracks = tracks.into_iter().flat_map(|tracks| &tracks.tracks);
    tracks.map(|track| (track.joint.0, track)).collect()
}

/// Names of joints, and which of them slide.
struct Names {
    robot: std::sync::Arc<Assembly>,
    joints: Vec<(String, bool)>,
}

impl Names {
    fn of(robot: &Robot) -> Names {
        let assembly = &robot.assembly;
        let joints =
            assembly.joints().map(|owner| (assembly.joint_name(owner), assembly.slides(owner))).collect();
        Names { robot: assembly.clone(), joints }
    }

    fn joint(&self, joint: JointId) -> String {
        self.joints.get(joint.0 as usize).map_or_else(String::new, |(name, _)| name.clone())
    }

    /// Returns a position of a joint.
    fn amount(&self, joint: JointId, x: f64) -> String {
        let slides = self.joints.get(joint.0 as usize).is_some_and(|(_, slides)| *slides);
        quantity(x, if slides { Dimension::LENGTH } else { Dimension::ANGLE })
    }

    /// Returns an action in words: `move leg.bend to 30deg`.
    fn action(&self, action: &Action) -> String {
        let time = |t: f64| quantity(t, Dimension::TIME);
        let words = match &action.command {
            Command::Move { joint, target: Target::To(to), .. } => {
                format!("move {} to {}", self.joint(*joint), self.amount(*joint, *to))
            }
            Command::Move { joint, target: Target::By(by), .. } => {
                format!("move {} by {}", self.joint(*joint), self.amount(*joint, *by))
            }
            Command::Spin { joint, speed, duration } => {
                let long = duration.map_or_else(String::new, |t| format!(" for {}", time(t)));
                format!("spin {} at {}{long}", self.joint(*joint), quantity(*speed, Dimension::ANGULAR_SPEED))
            }
            Command::Follow { joint, .. } => format!("follow {}", self.joint(*joint)),
            Command::Wait { duration } => format!("wait {}", time(*duration)),
            Command::Dock { a, b } => {
                format!("dock {} to {}", self.robot.port_name(*b), self.robot.port_name(*a))
            }
            Command::Undock { port } => format!("undock {}", self.robot.port_name(*port)),
        };
        if action.until.is_some() { format!("{words}, until a condition holds") } else { words }
    }
}

struct Drawer<'a> {
    names: Names,
    tracks: BTreeMap<u32, &'a Track>,
    drawn: usize,
    timed: usize,
}

impl Drawer<'_> {
    /// Returns the branch of a node; `from`: the time (s) at which it begins, if that is known.
    fn branch(&mut self, node: &Node, from: Option<f64>, depth: usize) -> Branch {
        self.drawn += 1;
        if self.drawn > NODES_DRAWN || depth > DEPTH_DRAWN {
            return Branch::leaf("...");
        }
        let words = match node {
            Node::Action(action) => self.names.action(action),
            Node::Series(_) => "Sc".to_owned(),
            Node::Parallel(_) => "Pc".to_owned(),
            Node::Repeat { times, until: None, .. } => format!("repeat {times} times"),
            Node::Repeat { times, .. } => format!("repeat at most {times} times, until a condition holds"),
            Node::Phase { shift, .. } => format!("phase, from {shift} of its cycle"),
            Node::Approach { shift, .. } => format!("approach {shift} of the cycle"),
            Node::Stretch { duration, .. } => format!("in {}", quantity(*duration, Dimension::TIME)),
            Node::Exempt { kind, .. } => format!("allows {}", kind.name()),
            Node::Contract { .. } => "with a contract".to_owned(),
            Node::Goal(goal) => goal.name().to_owned(),
        };
        let below = match node {
            Node::Action(_) | Node::Approach { .. } | Node::Goal(_) => Vec::new(),
            Node::Series(nodes) => {
                let mut at = from;
                let next = |node: &std::sync::Arc<Node>| {
                    let branch = (self.drawn <= NODES_DRAWN).then(|| self.branch(node, at, depth + 1));
                    at = at.and_then(|at| self.end(node, at));
                    branch
                };
                nodes.iter().filter_map(next).collect()
            }
            Node::Parallel(nodes) => {
                let shown = nodes.iter().take(NODES_DRAWN);
                shown.map(|node| self.branch(node, from, depth + 1)).collect()
            }
            Node::Repeat { body, .. } | Node::Exempt { body, .. } | Node::Contract { body, .. } => {
                vec![self.branch(body, from, depth + 1)]
            }
            // Within these the time runs otherwise.
            Node::Phase { body, .. } | Node::Stretch { body, .. } => vec![self.branch(body, None, depth + 1)],
        };
        let times = from.and_then(|from| {
            let time = |t: f64| quantity(t, Dimension::TIME);
            self.end(node, from).map(|to| format!("  {}..{}", time(from), time(to)))
        });
        Branch { text: format!("{words}{}", times.unwrap_or_default()), below }
    }

    /// Returns the time at which a node ends that begins at the time `from`, s, by the tracks; `None` where it
    /// can't be known.
    fn end(&mut self, node: &Node, from: f64) -> Option<f64> {
        self.timed += 1;
        if self.timed > NODES_TIMED {
            return None;
        }
        match node {
            Node::Action(action) => self.action_end(action, from),
            Node::Series(nodes) => nodes.iter().try_fold(from, |at, node| self.end(node, at)),
            Node::Parallel(nodes) => {
                nodes.iter().try_fold(from, |latest, node| Some(self.end(node, from)?.max(latest)))
            }
            Node::Repeat { until: Some(_), .. } => None,
            Node::Repeat { body, times, until: None } => {
                // Only the first time may begin elsewhere than the others.
                let first = self.end(body, from)?;
                let Some(more) = times.checked_sub(1).filter(|more| *more > 0) else { return Some(first) };
                let second = self.end(body, first)?;
                Some(first + more as f64 * (second - first))
            }
            Node::Stretch { duration, .. } => Some(from + duration),
            Node::Exempt { body, .. } | Node::Contract { body, .. } => self.end(body, from),
            Node::Phase { .. } | Node::Approach { .. } | Node::Goal(_) => None,
        }
    }

    /// Returns the time at which an action ends, s: by its duration, or by the segments of its joint's track;
    /// never `None`.
    fn action_end(&self, action: &Action, from: f64) -> Option<f64> {
        let (joint, pieces) = match &action.command {
            Command::Wait { duration } => return Some(from + duration),
            Command::Dock { .. } | Command::Undock { .. } | Command::Spin { duration: None, .. } => {
                return Some(from);
            }
            Command::Move { duration: Some(long), .. } | Command::Spin { duration: Some(long), .. }
                if action.until.is_none() =>
            {
                return Some(from + long);
            }
            Command::Move { joint, profile: Profile::Smooth | Profile::Linear, .. } => (joint, 1),
            Command::Move { joint, profile: Profile::Trapezoid, .. } => (joint, 3),
            Command::Spin { joint, .. } => (joint, 3),
            Command::Follow { joint, keyframes } => (joint, keyframes.len().saturating_sub(1)),
        };
        let segments = self.tracks.get(&joint.0).map_or(&[][..], |track| &track.segments);
        let first = segments.partition_point(|segment| segment.start < from - TOL_INSTANT);
        let own = segments[first..].iter().take(pieces);
        let mut end = from;
        for segment in own.take_while(|segment| segment.cause == action.cause) {
            if segment.start > end + TOL_INSTANT {
                break;
            }
            end = segment.end;
        }
        Some(end)
    }
}
