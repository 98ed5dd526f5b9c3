//! Built-ins that make behaviours: actions, the paper's (J, X, ξ, T), and their composition.

use super::Native;
use crate::behavior::mirror::{Plane, mirrored};
use crate::behavior::{Part, gait};
use crate::interpret::argument::{Choice, Positive, parameters};
use crate::interpret::design::{Subject, port_ref};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{
    Behavior, Callable, ConditionValue, JointValue, Measure, PortValue, SignalValue, Value,
};
use crate::plan::{Action, Command, Condition, Node, Otherwise, Profile, Signal, Target};
use crate::robot::JointId;
use crate::source::{Diagnostic, Span, code};
use std::rc::Rc;
use std::sync::Arc;

/// The built-ins for actions, behaviours and conditions, such as `move`, `wait`, `repeat` and `docked`: the key of each
/// with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure(
        "move",
        parameters![joint: &JointValue, to: Option<f64>, by: Option<f64>, in: Option<Positive>, profile: Profile, until: Option<&ConditionValue>, timeout: Option<Positive>],
        move_joint,
    ),
    Native::pure(
        "spin",
        parameters![joint: &JointValue, speed: f64, for: Option<Positive>, until: Option<&ConditionValue>, timeout: Option<Positive>],
        spin,
    ),
    Native::pure("follow", parameters![joint: &JointValue, path: &Rc<Callable>, for: Positive], follow),
    Native::pure("wait", parameters![time: f64, until: Option<&ConditionValue>], wait),
    Native::pure("dock", parameters![a: &PortValue, b: &PortValue], dock),
    Native::pure("undock", parameters![port: &PortValue], undock),
    Native::pure("abort", parameters![message: &str], abort),
    Native::pure("angle", parameters![joint: &JointValue], |i, call| signal(i, call, Signal::Angle)),
    Native::pure("displacement", parameters![joint: &JointValue], |i, call| signal(i, call, Signal::Angle)),
    Native::pure("speed", parameters![joint: &JointValue], |i, call| signal(i, call, Signal::Speed)),
    Native::pure("elapsed", parameters![], |_, _| Ok(signal_value(None, Signal::Elapsed))),
    Native::pure("docked", parameters![port: &PortValue], docked),
    Native::pure("Sc", parameters![behaviors: &[Value]], |i, call| compose(i, call, Node::Series)),
    Native::pure("Pc", parameters![behaviors: &[Value]], |i, call| compose(i, call, Node::Parallel)),
    Native::pure(
        "repeat",
        parameters![behavior: &Rc<Behavior>, times: Option<usize>, until: Option<&ConditionValue>, max: Option<usize>],
        repeat,
    ),
    Native::pure("phase", parameters![behavior: &Rc<Behavior>, shift: f64], phase),
    Native::pure("stretch", parameters![behavior: &Rc<Behavior>, to: Positive], stretch),
    Native::pure(
        "cycle",
        parameters![behaviors: &[Value], phases: &[Value], period: Positive, times: usize],
        cycle,
    ),
    Native::pure("mirror", parameters![behavior: &Rc<Behavior>, across: Plane], mirror),
    Native::pure(
        "table",
        parameters![joints: &[Value], step: Positive, unit: AngleUnit, rows: &[Value]],
        table,
    ),
];

/// The greatest time between two points of a followed function, s.
const FOLLOW_STEP: f64 = 0.02;
/// The least number of steps of a followed function.
const FOLLOW_POINTS_MIN: f64 = 8.0;
/// The greatest number of steps of a followed function.
const FOLLOW_POINTS_MAX: f64 = 100_000.0;
/// The part of a step over which the speed of a followed function is measured, to either side.
const FOLLOW_SLOPE: f64 = 1e-3;

impl Choice for Profile {
    const WORDS: &'static [(&'static str, Profile)] =
        &[("smooth", Profile::Smooth), ("trapezoid", Profile::Trapezoid), ("linear", Profile::Linear)];
}

impl Choice for Plane {
    const WORDS: &'static [(&'static str, Plane)] =
        &[("XY", Plane::XY), ("XZ", Plane::XZ), ("YZ", Plane::YZ)];
}

/// The unit of the numbers of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AngleUnit {
    Degree,
    Radian,
    Turn,
}

impl Choice for AngleUnit {
    const WORDS: &'static [(&'static str, AngleUnit)] =
        &[("deg", AngleUnit::Degree), ("rad", AngleUnit::Radian), ("turn", AngleUnit::Turn)];
}

impl AngleUnit {
    /// Returns the size of the unit, rad.
    fn radians(self) -> f64 {
        crate::units::unit(self.word()).expect("the words are units").factor
    }
}

fn behavior(robot: Option<Subject>, node: Node) -> Value {
    Value::Behavior(Rc::new(Behavior { robot, node: Arc::new(node) }))
}

/// The parts of an action beside its command: condition, timeout, spans of its arguments.
struct Extras {
    until: Option<Condition>,
    timeout: Option<f64>,
    parts: Vec<(Part, Span)>,
}

impl Extras {
    /// Reads `until` and `timeout`; the condition must be about the same robot.
    fn read(interpreter: &Interpreter, call: &Call, robot: Option<&Subject>) -> Eval<Extras> {
        let condition: Option<&ConditionValue> = call.get("until")?;
        if let Some(condition) = condition {
            interpreter.common_subject(robot, condition.robot.as_ref(), call.at("until"))?;
        }
        let until = condition.map(|condition| condition.condition.clone());
        let parts = vec![(Part::Until, call.at("until")), (Part::Timeout, call.at("timeout"))];
        Ok(Extras { until, timeout: call.positive_if("timeout", "a timeout")?, parts })
    }
}

/// Returns an action on a joint with its cause; `Value::Unknown` where the robot can't be assembled. `at`: the argument
/// that names the joint.
fn joint_action(
    interpreter: &mut Interpreter,
    call: &Call,
    joint: &JointValue,
    at: Span,
    extras: Extras,
    command: impl FnOnce(JointId) -> Command,
) -> Eval<Value> {
    let Some(robot) = interpreter.robot_at(&joint.robot, at)? else { return Ok(Value::Unknown) };
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

/// Runs `move`, which wants one of `to` and `by`.
fn move_joint(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.get::<&JointValue>("joint")?;
    let (target, at) = match (call.get::<Option<f64>>("to")?, call.get::<Option<f64>>("by")?) {
        (Some(to), None) => (Target::To(to), call.at("to")),
        (None, Some(by)) => (Target::By(by), call.at("by")),
        (None, None) => return Err(bad_action(call.span, "`move` wants `to:` or `by:`", "where to?")),
        (Some(_), Some(_)) => {
            return Err(bad_action(call.at("by"), "`move` wants `to:` or `by:`, not both", "one too many"));
        }
    };
    let duration = call.positive_if("in", "the duration of a motion")?;
    let profile: Profile = call.get("profile")?;
    let mut extras = Extras::read(interpreter, call, Some(&joint.robot))?;
    extras.parts.extend([
        (Part::Joint, call.at("joint")),
        (Part::Target, at),
        (Part::Duration, call.at("in")),
    ]);
    extras.parts.push((Part::Speed, at));
    joint_action(interpreter, call, joint, call.at("joint"), extras, |joint| Command::Move {
        joint,
        target,
        duration,
        profile,
    })
}

fn spin(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.get::<&JointValue>("joint")?;
    let speed = call.get::<f64>("speed")?;
    let duration = call.positive_if("for", "the duration of a motion")?;
    let mut extras = Extras::read(interpreter, call, Some(&joint.robot))?;
    extras.parts.extend([
        (Part::Joint, call.at("joint")),
        (Part::Speed, call.at("speed")),
        (Part::Duration, call.at("for")),
    ]);
    joint_action(interpreter, call, joint, call.at("joint"), extras, |joint| Command::Spin {
        joint,
        speed,
        duration,
    })
}

fn follow(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint = call.get::<&JointValue>("joint")?;
    let duration = call.positive("for", "the duration of a motion")?;
    let Some(keyframes) = sample(interpreter, call, call.get::<&Rc<Callable>>("path")?.clone(), duration)?
    else {
        return Ok(Value::Unknown);
    };
    let parts = [
        (Part::Joint, "joint"),
        (Part::Keyframes, "path"),
        (Part::Target, "path"),
        (Part::Speed, "path"),
        (Part::Duration, "for"),
    ];
    let parts = parts.map(|(part, name)| (part, call.at(name))).to_vec();
    let extras = Extras { until: None, timeout: None, parts };
    joint_action(interpreter, call, joint, call.at("joint"), extras, |joint| Command::Follow {
        joint,
        keyframes,
    })
}

/// Returns (time, position, speed) of a function of time at even steps, from 0 to `duration` (s); `None` where
/// a value is unknown. Speeds are central differences, at the ends one-sided ones of second order.
fn sample(
    interpreter: &mut Interpreter,
    call: &Call,
    function: Rc<Callable>,
    duration: f64,
) -> Eval<Option<Vec<[f64; 3]>>> {
    let count = libm::ceil(duration / FOLLOW_STEP).max(FOLLOW_POINTS_MIN);
    if count > FOLLOW_POINTS_MAX {
        return Err(call.refuse("for", "this is too long to follow a function"));
    }
    let step = duration / count;
    let near = step * FOLLOW_SLOPE;
    let mut at = |t: f64| -> Eval<Option<f64>> {
        Ok(interpreter.apply(&function, vec![Value::time(t)], call.at("path"))?.as_number())
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

/// Returns the speed at `time` by a difference of second order to one side; `near`: its step, s, negative for
/// the side before. `position`: the value at `time`. `None` where a value is unknown.
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
    let duration = call.get::<f64>("time")?;
    if duration < 0.0 {
        return Err(call.refuse("time", "a time to wait must not be negative"));
    }
    let condition: Option<&ConditionValue> = call.get("until")?;
    let until = condition.map(|condition| condition.condition.clone());
    let robot = condition.and_then(|condition| condition.robot.clone());
    let parts = vec![(Part::Duration, call.at("time")), (Part::Until, call.at("until"))];
    let cause = interpreter.cause(call.span, parts, "");
    let command = Command::Wait { duration };
    let action = Action { command, until, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(robot, Node::Action(action)))
}

fn dock(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (call.get::<&PortValue>("a")?, call.get::<&PortValue>("b")?);
    let robot = interpreter.common_subject(Some(&a.robot), Some(&b.robot), call.span)?;
    let command = Command::Dock { a: port_ref(a), b: port_ref(b) };
    let subject = format!("{} -- {}", a.name(), b.name());
    let parts = vec![(Part::Ports, call.span)];
    let cause = interpreter.cause(call.span, parts, &subject);
    let action = Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(robot, Node::Action(action)))
}

fn undock(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let port = call.get::<&PortValue>("port")?;
    let command = Command::Undock { port: port_ref(port) };
    let cause = interpreter.cause(call.span, vec![(Part::Ports, call.at("port"))], &port.name());
    let action = Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause };
    Ok(behavior(Some(port.robot.clone()), Node::Action(action)))
}

/// Runs `abort`: an action whose condition never holds and whose timeout is 0, so that it aborts at once.
fn abort(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let otherwise = Otherwise::Abort(call.get::<&str>("message")?.to_string());
    let cause = interpreter.cause(call.span, Vec::new(), "");
    let never =
        Condition::Compare { signal: Signal::Elapsed, compare: crate::plan::Compare::Less, value: 0.0 };
    let command = Command::Wait { duration: 0.0 };
    let action = Action { command, until: Some(never), timeout: Some(0.0), otherwise, cause };
    Ok(behavior(None, Node::Action(action)))
}

fn signal_value(robot: Option<Subject>, signal: Signal) -> Value {
    Value::Signal(Rc::new(SignalValue { robot, measure: Measure::Sensed(signal) }))
}

fn signal(interpreter: &mut Interpreter, call: &Call, make: fn(JointId) -> Signal) -> Eval<Value> {
    let joint: &JointValue = call.get("joint")?;
    let Some(robot) = interpreter.robot_at(&joint.robot, call.at("joint"))? else {
        return Ok(Value::Unknown);
    };
    Ok(signal_value(Some(joint.robot.clone()), make(robot.joint(joint))))
}

fn docked(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let port = call.get::<&PortValue>("port")?;
    let condition = Condition::Docked(port_ref(port));
    Ok(Value::Condition(Rc::new(ConditionValue { robot: Some(port.robot.clone()), condition })))
}

fn compose(interpreter: &mut Interpreter, call: &Call, make: fn(Vec<Arc<Node>>) -> Node) -> Eval<Value> {
    let mut robot = None;
    let mut nodes = Vec::new();
    for part in call.get::<&[Value]>("behaviors")?.iter() {
        let Value::Behavior(part) = part else {
            return Err(call.refuse("behaviors", "behaviours are wanted"));
        };
        robot = interpreter.common_subject(robot.as_ref(), part.robot.as_ref(), call.span)?;
        nodes.push(part.node.clone());
    }
    Ok(behavior(robot, make(nodes)))
}

/// Runs `repeat`: a number of `times`, or `until` a condition holds after one of at most `max`.
///
/// # Errors
/// A fault where the number is negative, or both are given, or none.
fn repeat(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.get::<&Rc<Behavior>>("behavior")?;
    let condition: Option<&ConditionValue> = call.get("until")?;
    let what = "the number of repetitions";
    let (times, max) = (call.optional_count("times", what)?, call.optional_count("max", what)?);
    let times = match (condition, times, max) {
        (None, Some(times), None) | (Some(_), None, Some(times)) => times as u64,
        _ => {
            let message = "`repeat` wants a number of times, or `until:` with `max:`";
            return Err(Diagnostic::error(code::BAD_ACTION, message)
                .label(call.span, "this repetition")
                .hint("write `repeat(b, 3)`, or `repeat(b, until: touching(m), max: 10)`")
                .into());
        }
    };
    let on = condition.and_then(|condition| condition.robot.as_ref());
    let robot = interpreter.common_subject(body.robot.as_ref(), on, call.span)?;
    let until = condition.map(|condition| condition.condition.clone());
    Ok(behavior(robot, Node::Repeat { body: body.node.clone(), times, until }))
}

fn phase(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.get::<&Rc<Behavior>>("behavior")?;
    let shift = call.get::<f64>("shift")?;
    let cause = interpreter.cause(call.span, Vec::new(), "");
    // A whole cycle more is the same phase of the cycle.
    let shift = shift - libm::floor(shift);
    Ok(behavior(body.robot.clone(), Node::Phase { body: body.node.clone(), shift, cause }))
}

fn stretch(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.get::<&Rc<Behavior>>("behavior")?;
    let duration = call.positive("to", "the duration of a behaviour")?;
    let cause = interpreter.cause(call.span, vec![(Part::Duration, call.at("to"))], "");
    Ok(behavior(body.robot.clone(), Node::Stretch { body: body.node.clone(), duration, cause }))
}

/// Runs `cycle`: behaviours with one period, each shifted by its phase, a part of the period.
fn cycle(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (bodies, phases) = (call.get::<&[Value]>("behaviors")?, call.get::<&[Value]>("phases")?);
    if bodies.len() != phases.len() {
        let message = format!("{} behaviours and {} phases", bodies.len(), phases.len());
        return Err(call.refuse("phases", message));
    }
    let duration = call.positive("period", "the period of a cycle")?;
    let times = call.count("times", "the number of cycles")? as u64;
    let mut robot = None;
    let cause = interpreter.cause(call.span, vec![(Part::Duration, call.at("period"))], "");
    let mut parts = Vec::new();
    for (body, phase) in bodies.iter().zip(phases.iter()) {
        let (Value::Behavior(body), Some(shift)) = (body, phase.as_number()) else {
            return Err(call.refuse("behaviors", "behaviours and their phases are wanted"));
        };
        robot = interpreter.common_subject(robot.as_ref(), body.robot.as_ref(), call.at("behaviors"))?;
        parts.push((body.node.clone(), shift - libm::floor(shift)));
    }
    Ok(behavior(robot, gait::cycle(&parts, duration, times, cause)))
}

fn mirror(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let body = call.get::<&Rc<Behavior>>("behavior")?;
    let Some(design) = &body.robot else { return Ok(behavior(None, (*body.node).clone())) };
    let Some(robot) = interpreter.robot_at(design, call.span)? else { return Ok(Value::Unknown) };
    let plane: Plane = call.get("across")?;
    let holds = vec![true; robot.assembly.bonds.len()];
    match mirrored(&robot.assembly, &holds, &body.node, plane) {
        Ok(node) => Ok(behavior(body.robot.clone(), (*node).clone())),
        Err(lopsided) => Err(call.refuse("across", lopsided.to_string())),
    }
}

/// Runs `table`: a series of rows, in each of which the joints move to their positions in one step of time.
fn table(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joints = call.get::<&[Value]>("joints")?;
    let step = call.positive("step", "the time of a row")?;
    let unit = call.get::<AngleUnit>("unit")?.radians();
    let mut robot = None;
    let mut rows = Vec::new();
    for (number, row) in call.get::<&[Value]>("rows")?.iter().enumerate() {
        let Value::List(row) = row else { return Err(call.refuse("rows", "rows of numbers are wanted")) };
        if row.len() != joints.len() {
            let message = format!("row {number} has {} numbers for {} joints", row.len(), joints.len());
            return Err(call.refuse("rows", message));
        }
        let mut actions = vec![Arc::new(hold(interpreter, call, step))];
        for (joint, position) in joints.iter().zip(row.iter()) {
            let (Value::Joint(joint), Some(position)) = (joint, position.as_number()) else { continue };
            let parts = [
                (Part::Joint, "joints"),
                (Part::Duration, "step"),
                (Part::Target, "rows"),
                (Part::Speed, "rows"),
            ];
            let parts = parts.map(|(part, name)| (part, call.at(name))).to_vec();
            let extras = Extras { until: None, timeout: None, parts };
            let target = Target::To(crate::units::to_si(position, unit));
            let action = joint_action(interpreter, call, joint, call.at("joints"), extras, |joint| {
                Command::Move { joint, target, duration: Some(step), profile: Profile::Smooth }
            })?;
            let Value::Behavior(action) = action else { return Ok(Value::Unknown) };
            robot = interpreter.common_subject(robot.as_ref(), action.robot.as_ref(), call.at("joints"))?;
            actions.push(action.node.clone());
        }
        rows.push(Arc::new(Node::Parallel(actions)));
    }
    Ok(behavior(robot, Node::Series(rows)))
}

/// Returns the wait of a row, which takes its time even where it leaves every joint alone.
fn hold(interpreter: &mut Interpreter, call: &Call, duration: f64) -> Node {
    let cause = interpreter.cause(call.span, Vec::new(), "");
    let command = Command::Wait { duration };
    Node::Action(Action { command, until: None, timeout: None, otherwise: Otherwise::Proceed, cause })
}

fn bad_action(span: Span, message: &str, label: &str) -> crate::interpret::stop::Stop {
    fault(code::BAD_ACTION, span, message, label)
}
