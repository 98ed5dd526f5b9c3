//! Built-ins that make behaviours: actions, the paper's (J, X, ξ, T), and their composition.

use super::{Native, pure};
use crate::behavior::mirror::{Plane, mirrored};
use crate::behavior::{Part, gait};
use crate::elaborate::robot_of::port_ref;
use crate::interpret::call::Call;
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{Behavior, Callable, ConditionValue, JointValue, SignalValue, Value};
use crate::plan::{Action, Command, Condition, Node, Otherwise, Profile, Signal, Target};
use crate::robot::JointId;
use crate::source::{Span, code};
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[
    pure("move", 7, move_joint),
    pure("spin", 5, spin),
    pure("follow", 3, follow),
    pure("wait", 2, wait),
    pure("dock", 2, dock),
    pure("undock", 1, undock),
    pure("abort", 1, abort),
    pure("angle", 1, |i, call| signal(i, call, Signal::Angle)),
    pure("speed", 1, |i, call| signal(i, call, Signal::Speed)),
    pure("elapsed", 0, |_, _| Ok(signal_value(None, Signal::Elapsed))),
    pure("docked", 1, docked),
    pure("Sc", 1, |i, call| compose(i, call, Node::Series)),
    pure("Pc", 1, |i, call| compose(i, call, Node::Parallel)),
    pure("repeat", 2, repeat),
    pure("phase", 2, phase),
    pure("stretch", 2, stretch),
    pure("cycle", 4, cycle),
    pure("mirror", 2, mirror),
    pure("table", 4, table),
];

/// Time between two points of a followed function, s, and the fewest points of one.
const FOLLOW_STEP: f64 = 0.02;
const FOLLOW_POINTS_MIN: f64 = 8.0;
/// Most points of one followed function.
const FOLLOW_POINTS_MAX: f64 = 100_000.0;
/// Part of a step over which the speed of a followed function is measured.
const FOLLOW_SLOPE: f64 = 1e-3;

fn behavior(robot: Option<Rc<Design>>, node: Node) -> Value {
    Value::Behavior(Rc::new(Behavior { robot, node: Arc::new(node) }))
}

/// What an action has beside its command: condition, timeout, where its arguments stand.
struct Extras {
    until: Option<Condition>,
    timeout: Option<f64>,
    parts: Vec<(Part, Span)>,
}

impl Extras {
    /// `until` and `timeout` at these parameters; the condition must be about the same robot.
    fn read(
        interpreter: &Interpreter,
        call: &Call,
        robot: Option<&Rc<Design>>,
        until: usize,
        timeout: usize,
    ) -> Eval<Extras> {
        let condition = match call.arg(until) {
            Value::Condition(condition) => {
                interpreter.common_robot(robot, condition.robot.as_ref(), call.at(until))?;
                Some(condition.condition.clone())
            }
            _ => None,
        };
        let parts = vec![(Part::Until, call.at(until)), (Part::Timeout, call.at(timeout))];
        Ok(Extras { until: condition, timeout: call.positive_if(timeout, "a timeout")?, parts })
    }
}

/// An action on a joint with its cause.
fn joint_action(
    interpreter: &mut Interpreter,
    call: &Call,
    joint: &JointValue,
    extras: Extras,
    command: impl FnOnce(JointId) -> Command,
) -> Eval<Value> {
    let Some(robot) = interpreter.robot_at(&joint.robot, call.at(0))? else { return Ok(Value::Unknown) };
    let cause = interpreter.action_cause(call.span, extras.parts, joint);
    let action = Action {
        command: command(robot.joint(joint)),
        until: extras.until,
        timeout: extras.timeout,
        otherwise: Otherwise::Proceed,
        cause,
    };
    Ok(behavior(Some(joint.robot.clone()), Node::Action(action)))
}

fn move_joint(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.joint(0)?;
    let (target, at) = match (call.number_if(1)?, call.number_if(2)?) {
        (Some(to), None) => (Target::To(to), call.at(1)),
        (None, Some(by)) => (Target::By(by), call.at(2)),
        (None, None) => return Err(bad_action(call.span, "`move` wants `to:` or `by:`", "where to?")),
        (Some(_), Some(_)) => {
            return Err(bad_action(call.at(2), "`move` wants `to:` or `by:`, not both", "one too many"));
        }
    };
    let duration = call.positive_if(3, "the duration of a motion")?;
    let profile = match call.word(4) {
        Some("trapezoid") => Profile::Trapezoid,
        Some("linear") => Profile::Linear,
        _ => Profile::Smooth,
    };
    let mut extras = Extras::read(interpreter, call, Some(&joint.robot), 5, 6)?;
    extras.parts.extend([(Part::Joint, call.at(0)), (Part::Target, at), (Part::Duration, call.at(3))]);
    extras.parts.push((Part::Speed, at));
    joint_action(interpreter, call, joint, extras, |joint| Command::Move { joint, target, duration, profile })
}

fn spin(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.joint(0)?;
    let speed = call.number(1)?;
    let duration = call.positive_if(2, "the duration of a motion")?;
    let mut extras = Extras::read(interpreter, call, Some(&joint.robot), 3, 4)?;
    extras.parts.extend([(Part::Joint, call.at(0)), (Part::Speed, call.at(1)), (Part::Duration, call.at(2))]);
    joint_action(interpreter, call, joint, extras, |joint| Command::Spin { joint, speed, duration })
}

fn follow(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.joint(0)?;
    let duration = call.positive(2, "the duration of a motion")?;
    let Some(keyframes) = sample(interpreter, call, call.function(1)?.clone(), duration)? else {
        return Ok(Value::Unknown);
    };
    let parts =
        [(Part::Joint, 0), (Part::Keyframes, 1), (Part::Target, 1), (Part::Speed, 1), (Part::Duration, 2)];
    let parts = parts.map(|(part, index)| (part, call.at(index))).to_vec();
    let extras = Extras { until: None, timeout: None, parts };
    joint_action(interpreter, call, joint, extras, |joint| Command::Follow { joint, keyframes })
}

/// Positions and speeds of a function of time at even steps; `None` where a value is unknown.
fn sample(
    interpreter: &mut Interpreter,
    call: &Call,
    function: Rc<Callable>,
    duration: f64,
) -> Eval<Option<Vec<[f64; 3]>>> {
    let count = libm::ceil(duration / FOLLOW_STEP).max(FOLLOW_POINTS_MIN);
    if count > FOLLOW_POINTS_MAX {
        return Err(call.refuse(2, "this is too long to follow a function"));
    }
    let step = duration / count;
    let near = step * FOLLOW_SLOPE;
    let mut at = |t: f64| -> Eval<Option<f64>> {
        Ok(interpreter.apply(&function, vec![Value::time(t)], call.at(1))?.as_number())
    };
    let mut keyframes = Vec::new();
    for k in 0..=count as usize {
        let time = if k == count as usize { duration } else { step * k as f64 };
        // The function need not be defined before 0 or after the end.
        let (before, after) = ((time - near).max(0.0), (time + near).min(duration));
        let (Some(position), Some(a), Some(b)) = (at(time)?, at(before)?, at(after)?) else {
            return Ok(None);
        };
        let slope = if k == 0 || k == count as usize {
            one_sided(&mut at, time, if k == 0 { near } else { -near }, position)?
        } else {
            Some((b - a) / (after - before))
        };
        let Some(slope) = slope else { return Ok(None) };
        keyframes.push([time, position, slope]);
    }
    Ok(Some(keyframes))
}

/// Second-order difference to one side.
fn one_sided(
    at: &mut impl FnMut(f64) -> Eval<Option<f64>>,
    time: f64,
    near: f64,
    position: f64,
) -> Eval<Option<f64>> {
    let (Some(a), Some(b)) = (at(time + near)?, at(time + 2.0 * near)?) else { return Ok(None) };
    Ok(Some((4.0 * a - b - 3.0 * position) / (2.0 * near)))
}

fn wait(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let duration = call.number(0)?;
    if duration < 0.0 {
        return Err(call.refuse(0, "a time to wait must not be negative"));
    }
    let (until, robot) = match call.arg(1) {
        Value::Condition(condition) => (Some(condition.condition.clone()), condition.robot.clone()),
        _ => (None, None),
    };
    let parts = vec![(Part::Duration, call.at(0)), (Part::Until, call.at(1))];
    let cause = interpreter.cause(call.span, parts, "");
    let command = Command::Wait { duration };
    let action = Action { command, until, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(robot, Node::Action(action)))
}

fn dock(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (call.port(0)?, call.port(1)?);
    let robot = interpreter.common_robot(Some(&a.robot), Some(&b.robot), call.span)?;
    let command = Command::Dock { a: port_ref(a), b: port_ref(b) };
    let subject = format!("{} -- {}", a.name(), b.name());
    let parts = vec![(Part::Ports, call.span)];
    let cause = interpreter.cause(call.span, parts, &subject);
    let action = Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(robot, Node::Action(action)))
}

fn undock(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let port = call.port(0)?;
    let command = Command::Undock { port: port_ref(port) };
    let cause = interpreter.cause(call.span, vec![(Part::Ports, call.at(0))], &port.name());
    let action = Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(Some(port.robot.clone()), Node::Action(action)))
}

/// An action that has no time to wait and aborts at once: `else` takes its message.
fn abort(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let otherwise = Otherwise::Abort(call.text(0)?.to_string());
    let cause = interpreter.cause(call.span, Vec::new(), "");
    let never =
        Condition::Compare { signal: Signal::Elapsed, compare: crate::plan::Compare::Less, value: 0.0 };
    let command = Command::Wait { duration: 0.0 };
    let action = Action { command, until: Some(never), timeout: Some(0.0), otherwise, cause };
    Ok(behavior(None, Node::Action(action)))
}

/// `action else b`; `None` where `action` is no single action with a timeout.
pub fn with_otherwise(action: &Node, otherwise: &Arc<Node>) -> Option<Node> {
    let mut action = action.as_action()?.clone();
    action.timeout?;
    action.otherwise = match &**otherwise {
        Node::Series(nodes) if nodes.is_empty() => Otherwise::Proceed,
        Node::Action(Action { otherwise: Otherwise::Abort(message), timeout: Some(0.0), .. }) => {
            Otherwise::Abort(message.clone())
        }
        _ => Otherwise::Node(otherwise.clone()),
    };
    Some(Node::Action(action))
}

fn signal_value(robot: Option<Rc<Design>>, signal: Signal) -> Value {
    Value::Signal(Rc::new(SignalValue { robot, signal }))
}

fn signal(interpreter: &mut Interpreter, call: &Call, make: fn(JointId) -> Signal) -> Eval<Value> {
    let joint = call.joint(0)?;
    let Some(robot) = interpreter.robot_at(&joint.robot, call.at(0))? else { return Ok(Value::Unknown) };
    Ok(signal_value(Some(joint.robot.clone()), make(robot.joint(joint))))
}

fn docked(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let port = call.port(0)?;
    let condition = Condition::Docked(port_ref(port));
    Ok(Value::Condition(Rc::new(ConditionValue { robot: Some(port.robot.clone()), condition })))
}

fn compose(interpreter: &mut Interpreter, call: &Call, make: fn(Vec<Arc<Node>>) -> Node) -> Eval<Value> {
    let mut robot = None;
    let mut nodes = Vec::new();
    for part in call.list(0)?.iter() {
        let Value::Behavior(part) = part else { return Err(call.refuse(0, "behaviours are wanted")) };
        robot = interpreter.common_robot(robot.as_ref(), part.robot.as_ref(), call.span)?;
        nodes.push(part.node.clone());
    }
    Ok(behavior(robot, make(nodes)))
}

fn repeat(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.behavior(0)?;
    let times = call.count(1, "the number of repetitions")? as u64;
    Ok(behavior(body.robot.clone(), Node::Repeat { body: body.node.clone(), times }))
}

fn phase(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.behavior(0)?;
    let shift = call.number(1)?;
    let cause = interpreter.cause(call.span, Vec::new(), "");
    // A whole cycle more is the same place in the cycle.
    let shift = shift - libm::floor(shift);
    Ok(behavior(body.robot.clone(), Node::Phase { body: body.node.clone(), shift, cause }))
}

fn stretch(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.behavior(0)?;
    let duration = call.positive(1, "the duration of a behaviour")?;
    let cause = interpreter.cause(call.span, vec![(Part::Duration, call.at(1))], "");
    Ok(behavior(body.robot.clone(), Node::Stretch { body: body.node.clone(), duration, cause }))
}

fn cycle(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (bodies, phases) = (call.list(0)?, call.list(1)?);
    if bodies.len() != phases.len() {
        let message = format!("{} behaviours and {} phases", bodies.len(), phases.len());
        return Err(call.refuse(1, message));
    }
    let duration = call.positive(2, "the period of a cycle")?;
    let times = call.count(3, "the number of cycles")? as u64;
    let mut robot = None;
    let cause = interpreter.cause(call.span, vec![(Part::Duration, call.at(2))], "");
    let mut parts = Vec::new();
    for (body, phase) in bodies.iter().zip(phases.iter()) {
        let (Value::Behavior(body), Some(shift)) = (body, phase.as_number()) else {
            return Err(call.refuse(0, "behaviours and their phases are wanted"));
        };
        robot = interpreter.common_robot(robot.as_ref(), body.robot.as_ref(), call.at(0))?;
        parts.push((body.node.clone(), shift - libm::floor(shift)));
    }
    Ok(behavior(robot, gait::cycle(&parts, duration, times, cause)))
}

fn mirror(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.behavior(0)?;
    let Some(design) = &body.robot else { return Ok(behavior(None, (*body.node).clone())) };
    let Some(robot) = interpreter.robot_at(design, call.span)? else { return Ok(Value::Unknown) };
    let plane = match call.word(1) {
        Some("XY") => Plane::XY,
        Some("YZ") => Plane::YZ,
        _ => Plane::XZ,
    };
    let holds = vec![true; robot.assembly.bonds.len()];
    match mirrored(&robot.assembly, &holds, &body.node, plane) {
        Ok(node) => Ok(behavior(body.robot.clone(), (*node).clone())),
        Err(lopsided) => Err(call.refuse(1, lopsided.to_string())),
    }
}

fn table(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joints = call.list(0)?;
    let step = call.positive(1, "the time of a row")?;
    let unit = crate::units::unit(call.word(2).unwrap_or("deg")).map_or(1.0, |unit| unit.factor);
    let mut robot = None;
    let mut rows = Vec::new();
    for (number, row) in call.list(3)?.iter().enumerate() {
        let Value::List(row) = row else { return Err(call.refuse(3, "rows of numbers are wanted")) };
        if row.len() != joints.len() {
            let message = format!("row {number} has {} numbers for {} joints", row.len(), joints.len());
            return Err(call.refuse(3, message));
        }
        let mut actions = vec![Arc::new(hold(interpreter, call, step))];
        for (joint, position) in joints.iter().zip(row.iter()) {
            let (Value::Joint(joint), Some(position)) = (joint, position.as_number()) else { continue };
            let parts = [(Part::Joint, 0), (Part::Duration, 1), (Part::Target, 3), (Part::Speed, 3)];
            let parts = parts.map(|(part, index)| (part, call.at(index))).to_vec();
            let extras = Extras { until: None, timeout: None, parts };
            let target = Target::To(crate::units::to_si(position, unit));
            let action = joint_action(interpreter, call, joint, extras, |joint| Command::Move {
                joint,
                target,
                duration: Some(step),
                profile: Profile::Smooth,
            })?;
            let Value::Behavior(action) = action else { return Ok(Value::Unknown) };
            robot = interpreter.common_robot(robot.as_ref(), action.robot.as_ref(), call.at(0))?;
            actions.push(action.node.clone());
        }
        rows.push(Arc::new(Node::Parallel(actions)));
    }
    Ok(behavior(robot, Node::Series(rows)))
}

/// A row takes its time even where it leaves every joint alone.
fn hold(interpreter: &mut Interpreter, call: &Call, duration: f64) -> Node {
    let cause = interpreter.cause(call.span, Vec::new(), "");
    let command = Command::Wait { duration };
    Node::Action(Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause })
}

fn bad_action(span: Span, message: &str, label: &str) -> crate::interpret::stop::Stop {
    fault(code::BAD_ACTION, span, message, label)
}
