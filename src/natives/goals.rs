//! Built-ins that state motions by their goal: `reach`, `line`, `arc`, `avoid`, and the poses that they take.

use super::Native;
use crate::elaborate::{default_up, port_rotation};
use crate::geometry::{Pose, Vec3};
use crate::interpret::argument::{Auto, Choice, Positive, WordOr, parameters};
use crate::interpret::design::{Instance, Subject, port_ref};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{Behavior, PortValue, Value};
use crate::plan::visit::{Graph, has_contracts};
use crate::plan::{
    Action, CauseId, Command, Goal, GoalFrame, GoalKind, LineEnd, Node, Otherwise, Profile, Target,
};
use crate::robot::chain::{Chain, Orientation, PoseError};
use crate::robot::jacobian::LinkFrame;
use crate::robot::{JointId, Kinematics};
use crate::source::code;
use std::collections::BTreeSet;
use std::rc::Rc;
use std::sync::Arc;

/// The built-ins `pose_at`, `reach`, `line`, `arc` and `avoid`: the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("pose_at", parameters![position: Vec3, facing: Vec3, up: Option<Vec3>], pose_at),
    Native::pure(
        "reach",
        parameters![port: &PortValue, to: Option<Pose>, position: Option<Vec3>, along: Option<Vec3>, seen_from: Option<&Rc<Instance>>, in: Option<Positive>, profile: Profile, starts: usize, seed: WordOr<Auto, usize>],
        reach,
    ),
    Native::pure(
        "line",
        parameters![port: &PortValue, to: Option<Pose>, by: Option<Vec3>, seen_from: Option<&Rc<Instance>>, for: Option<Positive>, within: Positive, turned_within: Positive, orientation: LineOrientation],
        line,
    ),
    Native::pure(
        "arc",
        parameters![port: &PortValue, to: Pose, via: Vec3, seen_from: Option<&Rc<Instance>>, for: Option<Positive>, within: Positive, turned_within: Positive, orientation: LineOrientation],
        arc,
    ),
    Native::pure(
        "avoid",
        parameters![behavior: &Rc<Behavior>, clearance: f64, budget: usize, seed: WordOr<Auto, usize>],
        avoid,
    ),
];

/// The orientation of a port on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LineOrientation {
    Kept,
    Free,
}

impl Choice for LineOrientation {
    const WORDS: &'static [(&'static str, LineOrientation)] =
        &[("kept", LineOrientation::Kept), ("free", LineOrientation::Free)];
}

/// The greatest number of starts of a search for a posture.
const STARTS_MAX: usize = 10_000;

/// Returns a direction that the argument `name` gives, as a unit vector.
///
/// # Errors
/// A fault where it is zero.
fn unit(call: &Call, name: &str, direction: Vec3) -> Eval<Vec3> {
    direction.try_normalize(0.0).ok_or_else(|| call.refuse(name, "a direction must not be zero"))
}

/// Runs `pose_at`: x along `facing`, z along the part of `up` that is perpendicular to it.
fn pose_at(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let position = call.get::<Vec3>("position")?;
    let facing = unit(call, "facing", call.get("facing")?)?;
    let up: Option<Vec3> = call.get("up")?;
    let up = up.map_or(Ok(default_up(facing)), |up| unit(call, "up", up))?;
    let turn =
        port_rotation(facing, up).ok_or_else(|| call.refuse("up", "`up` and `facing` lie on one line"))?;
    Ok(Value::Pose(Rc::new(Pose::from_parts(position.into(), turn))))
}

/// Runs `reach`, which wants one of `to` and `position`.
fn reach(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let to: Option<Pose> = call.get("to")?;
    let (position, along): (Option<Vec3>, Option<Vec3>) = (call.get("position")?, call.get("along")?);
    let (position, orientation) = match (to, position, along) {
        (Some(to), None, None) => (to.translation.vector, Orientation::Full(to.rotation)),
        (None, Some(position), None) => (position, Orientation::Free),
        (None, Some(position), Some(along)) => (position, Orientation::Along(unit(call, "along", along)?)),
        (None, None, _) => return Err(bad_goal(call, "`reach` wants `to:` or `position:`", "where to?")),
        (Some(_), _, _) => {
            return Err(bad_goal(call, "`reach` wants a pose, or a position, not both", "one too many"));
        }
    };
    let starts: usize = call.get_named("starts", "the number of starts")?;
    if starts == 0 || starts > STARTS_MAX {
        return Err(call.refuse("starts", format!("from 1 to {STARTS_MAX} starts are possible")));
    }
    let (frame, robot) = frame(interpreter, call)?;
    let kind = GoalKind::Reach {
        frame,
        position,
        orientation,
        duration: call.positive_if("in", "the duration of a motion")?,
        profile: call.get("profile")?,
        starts,
        seed: interpreter.seed(call.get("seed")?),
    };
    chain_goal(interpreter, call, kind, frame, &robot)
}

/// Runs `line`, which wants one of `to` and `by`.
fn line(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let end = match (call.get::<Option<Pose>>("to")?, call.get::<Option<Vec3>>("by")?) {
        (Some(to), None) => LineEnd::To(to),
        (None, Some(by)) => LineEnd::By(by),
        (None, None) => return Err(bad_goal(call, "`line` wants `to:` or `by:`", "where to?")),
        (Some(_), Some(_)) => {
            return Err(bad_goal(call, "`line` wants `to:` or `by:`, not both", "one too many"));
        }
    };
    way(interpreter, call, end, None)
}

fn arc(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let via: Vec3 = call.get("via")?;
    way(interpreter, call, LineEnd::To(call.get("to")?), Some(via))
}

/// Returns a line to `end`, or, with a point between, an arc.
fn way(interpreter: &mut Interpreter, call: &Call, end: LineEnd, via: Option<Vec3>) -> Eval<Value> {
    let (frame, robot) = frame(interpreter, call)?;
    let within = PoseError {
        distance: call.positive("within", "a deviation")?,
        angle: call.positive("turned_within", "a deviation")?,
    };
    let duration = call.positive_if("for", "the duration of a motion")?;
    let free = call.get::<LineOrientation>("orientation")? == LineOrientation::Free;
    chain_goal(interpreter, call, GoalKind::Line { frame, end, via, duration, free, within }, frame, &robot)
}

/// Returns the port that moves with the module against which it does, and the robot that both belong to.
///
/// # Errors
/// A fault where they belong to two robots, or `seen_from` is not a single module.
fn frame(interpreter: &mut Interpreter, call: &Call) -> Eval<(GoalFrame, Subject)> {
    let port: &PortValue = call.get("port")?;
    let Some(instance) = call.get::<Option<&Rc<Instance>>>("seen_from")? else {
        return Ok((GoalFrame { port: port_ref(port), module: None }, port.robot.clone()));
    };
    let robot = interpreter.common_subject(Some(&port.robot), Some(&instance.robot), call.span)?;
    if instance.design.module().is_none() {
        return Err(call.refuse("seen_from", "places are seen from a single module"));
    }
    let frame = GoalFrame { port: port_ref(port), module: Some(instance.modules.index(0)) };
    Ok((frame, robot.unwrap_or_else(|| port.robot.clone())))
}

/// Returns the behaviour of a goal that the joints between a port and what it is seen from reach.
fn chain_goal(
    interpreter: &mut Interpreter,
    call: &Call,
    kind: GoalKind,
    frame: GoalFrame,
    subject: &Subject,
) -> Eval<Value> {
    let Some(robot) = interpreter.robot_at(subject, call.at("port"))? else { return Ok(Value::Unknown) };
    let assembly = &robot.assembly;
    // The base of the port's own robot: of a scene's robots that which is connected with it.
    let clusters = robot.start.clusters.iter().map(|cluster| cluster.reference);
    let bases: Vec<usize> = frame
        .module
        .map_or_else(|| std::iter::once(assembly.base).chain(clusters).collect(), |module| vec![module]);
    let chain = bases.iter().find_map(|base| {
        let kinematics = Kinematics::new(assembly, &robot.start.bonds, *base);
        let port = LinkFrame::of_port(assembly, &kinematics, frame.port);
        Chain::new(assembly, &kinematics, kinematics.link(*base, 0), &port)
    });
    // Bonds that are made later are not known here: their joints are found when the motion is planned.
    let joints: BTreeSet<usize> = chain.iter().flat_map(Chain::joints).map(|joint| joint.joint).collect();
    let joints =
        joints.into_iter().map(|joint| JointId(u32::try_from(joint).expect("joints fit in 32 bits")));
    let joints: Vec<JointId> = joints.collect();
    if chain.is_some() && joints.is_empty() {
        let message = "no joint that takes commands moves this port";
        return Err(fault(code::BAD_ACTION, call.at("port"), message, "nothing moves it"));
    }
    let name = assembly.port_name(frame.port);
    Ok(goal(interpreter, call, kind, joints, (Some(subject.clone()), &name)))
}

/// Runs `avoid`, which plans a way to where a behaviour would bring the joints.
fn avoid(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let behavior = call.get::<&Rc<Behavior>>("behavior")?;
    let clearance: f64 = call.get("clearance")?;
    if clearance < 0.0 {
        return Err(call.refuse("clearance", "the clearance must not be negative"));
    }
    let budget: usize = call.get("budget")?;
    let seed: WordOr<Auto, usize> = call.get("seed")?;
    if has_contracts(&behavior.node) {
        let message = "`avoid` takes only where a behavior ends, and can't keep its contracts";
        return Err(bad_goal(call, message, "this behavior has contracts, or one in it has"));
    }
    let graph = Graph::of(&behavior.node);
    let mut joints = BTreeSet::new();
    for node in &graph.nodes {
        let stand_ins = match &***node {
            Node::Action(action) => std::slice::from_ref(action),
            Node::Goal(goal) => &goal.stand_ins,
            _ => &[],
        };
        joints.extend(stand_ins.iter().filter_map(|action| match &action.command {
            Command::Move { joint, .. } | Command::Spin { joint, .. } | Command::Follow { joint, .. } => {
                Some(*joint)
            }
            Command::Wait { .. } | Command::Dock { .. } | Command::Undock { .. } => None,
        }));
    }
    drop(graph);
    let kind = GoalKind::Avoid {
        body: behavior.node.clone(),
        clearance,
        budget: budget as u64,
        seed: interpreter.seed(seed),
    };
    Ok(goal(interpreter, call, kind, joints, (behavior.robot.clone(), "")))
}

/// Returns the behaviour of a goal with the joints that it may command.
fn goal(
    interpreter: &mut Interpreter,
    call: &Call,
    kind: GoalKind,
    joints: impl IntoIterator<Item = JointId>,
    (robot, name): (Option<Subject>, &str),
) -> Value {
    let cause: CauseId = interpreter.cause(call.span, Vec::new(), name);
    let stand_in = |joint: JointId| Action {
        command: Command::Move { joint, target: Target::By(0.0), duration: None, profile: Profile::Smooth },
        until: None,
        timeout: None,
        otherwise: Otherwise::Proceed,
        cause,
    };
    let stand_ins = joints.into_iter().map(stand_in).collect();
    let node = Arc::new(Node::Goal(Box::new(Goal { kind, stand_ins, cause })));
    Value::Behavior(Rc::new(Behavior { robot, node }))
}

fn bad_goal(call: &Call, message: &str, label: &str) -> crate::interpret::stop::Stop {
    fault(code::BAD_ACTION, call.span, message, label)
}
