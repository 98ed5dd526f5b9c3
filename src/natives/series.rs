//! Time series of plans: values of signals, and states.

use super::Native;
use super::one_robot::{has_joint, has_modules};
use super::robot::pose_in;
use super::sequence::STEP_ROUNDING;
use crate::geometry::pose::lean;
use crate::interpret::argument::{Positive, parameters};
use crate::interpret::design::{Instance, Subject, port_ref};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::planning::state_value;
use crate::interpret::record::{Field, NativeRecord, Record, StateValue, field_names, read_field};
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{
    ConditionValue, JointValue, Measure, MovingFrame, PortValue, SignalValue, Value,
};
use crate::plan::verify::articulated::{ClusterPaths, Detail, GroundForce, Instant};
use crate::plan::{Condition, Ground, Signal, Tracks, World};
use crate::robot::{JointId, Kinematics};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::cell::OnceCell;
use std::rc::Rc;

/// The built-ins for signals of a robot and for samples of a plan, such as `torque`, `clearance` and `Plan.series`: the
/// key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("torque", parameters![joint: &JointValue], effort),
    Native::pure("force", parameters![joint: &JointValue], effort),
    Native::pure("margin", parameters![], |_, _| Ok(signal(None, Measure::Margin))),
    Native::pure("clearance", parameters![], |_, _| Ok(signal(None, Measure::Clearance))),
    Native::pure("ground_force", parameters![on: &Rc<Instance>], ground_force),
    Native::pure("tilt", parameters![on: &Rc<Instance>], tilt_of),
    Native::pure("touching", parameters![on: &Rc<Instance>, other: Option<&Rc<Instance>>], touching),
    Native::pure("separation", parameters![a: &PortValue, b: &PortValue], separation),
    Native::on_run("Plan.times", parameters![self: &Value, step: Positive], plan_times),
    Native::on_run("Plan.series", parameters![self: &Value, of: &Value, step: Positive], plan_series),
    Native::on_run("Plan.states", parameters![self: &Value, step: Positive], plan_states),
    Native::on_run("State.speed", parameters![self: &StateValue, joint: &JointValue], state_speed),
    Native::on_run("State.torque", parameters![self: &StateValue, joint: &JointValue], state_effort),
    Native::on_run("State.force", parameters![self: &StateValue, joint: &JointValue], state_effort),
    Native::on_run(
        "State.ground_force",
        parameters![self: &StateValue, on: &Rc<Instance>],
        state_ground_force,
    ),
    Native::on_run("State.contacts", parameters![self: &StateValue], state_contacts),
];

fn signal(robot: Option<Subject>, measure: Measure) -> Value {
    Value::Signal(Rc::new(SignalValue { robot, measure }))
}

fn effort(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let joint: &JointValue = call.get("joint")?;
    let Some(robot) = interpreter.robot_at(&joint.robot, call.at("joint"))? else {
        return Ok(Value::Unknown);
    };
    Ok(signal(Some(joint.robot.clone()), Measure::Sensed(Signal::Effort(robot.joint(joint)))))
}

fn ground_force(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let on = call.get::<&Rc<Instance>>("on")?;
    Ok(signal(Some(on.robot.clone()), Measure::GroundForce(modules_of(on))))
}

fn tilt_of(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let on = call.get::<&Rc<Instance>>("on")?;
    Ok(signal(Some(on.robot.clone()), Measure::Sensed(Signal::Tilt(on.modules.index(0)))))
}

fn touching(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let on = call.get::<&Rc<Instance>>("on")?;
    let other = call.get::<Option<&Rc<Instance>>>("other")?;
    let modules = modules_of(on).to_vec();
    let (robot, condition) = match other {
        None => (Some(on.robot.clone()), Condition::Touching(modules)),
        Some(other) => {
            let robot = interpreter.common_subject(Some(&on.robot), Some(&other.robot), call.span)?;
            (robot, Condition::TouchingEachOther(modules, modules_of(other).to_vec()))
        }
    };
    Ok(Value::Condition(Rc::new(ConditionValue { robot, condition })))
}

fn separation(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (call.get::<&PortValue>("a")?, call.get::<&PortValue>("b")?);
    let robot = interpreter.common_subject(Some(&a.robot), Some(&b.robot), call.span)?;
    Ok(signal(robot, Measure::Sensed(Signal::Separation(port_ref(a), port_ref(b)))))
}

/// Returns the indices of an instance's modules in the whole robot, ascending.
fn modules_of(instance: &Instance) -> Rc<[usize]> {
    let mut modules: Vec<usize> = instance.modules.indices(instance.design.module_count()).collect();
    modules.sort_unstable();
    modules.into()
}

/// Returns the plan that a method is called of; `None` where it could not be made, which has been reported.
fn planned(interpreter: &mut Interpreter, call: &Call) -> Eval<Option<Rc<PlanValue>>> {
    interpreter.plan_of(call.arg("self"), call.at("self"))
}

/// Returns evenly spaced times from the start of a plan to its end, both included, no further apart than `step`.
fn times(interpreter: &mut Interpreter, call: &Call, plan: &PlanValue) -> Eval<Rc<Vec<f64>>> {
    let step = call.positive("step", "the time between values")?;
    let duration = plan.plan.body.duration();
    let count = (duration / step - STEP_ROUNDING).ceil().max(0.0);
    // A list's limit is far below what a machine word holds.
    interpreter.check_list((count + 1.0) as usize, call.at("step"))?;
    let count = count as usize;
    let time = |i: usize| if i == count { duration } else { duration * i as f64 / count as f64 };
    Ok(Rc::new((0..=count).map(time).collect()))
}

fn plan_times(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(plan) = planned(interpreter, call)? else { return Ok(Value::Unknown) };
    let times = times(interpreter, call, &plan)?;
    Ok(Value::list(times.iter().map(|time| Value::time(*time)).collect()))
}

fn plan_states(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(plan) = planned(interpreter, call)? else { return Ok(Value::Unknown) };
    interpreter.require_joints(&plan, call.at("self"))?;
    let times = times(interpreter, call, &plan)?;
    let known = instants(call, &plan, &times, Detail::Stance)?;
    let states = states(&plan, &times, &known);
    Ok(Value::list(states.map(|state| Value::Record(Rc::new(Record::State(Box::new(state))))).collect()))
}

/// Returns the states of a plan's robot at these times (s), with the poses of its base that the judge knows; none for
/// plans of lattices and trusses.
fn states<'p>(
    plan: &'p Rc<PlanValue>,
    times: &'p Rc<Vec<f64>>,
    known: &'p [Instant],
) -> impl Iterator<Item = StateValue> + 'p {
    (0..times.len()).filter_map(|own| state_value(plan, times, own, OnceCell::from(known[own].base)))
}

/// Returns what the judge knows at these times (s) of a plan, one for each.
///
/// # Errors
/// A fault where the judge took all samples that are allowed before the last time.
fn instants(call: &Call, plan: &PlanValue, times: &Rc<Vec<f64>>, detail: Detail) -> Eval<Rc<Vec<Instant>>> {
    let instants = plan.instants(times, detail, None);
    if instants.len() == times.len() {
        return Ok(instants);
    }
    let reached = quantity(instants.last().map_or(0.0, |last| last.time), Dimension::TIME);
    let message = format!("the judge took all samples that are allowed, and got to {reached} only");
    Err(fault(code::NOT_VERIFIED, call.at("self"), message, "of this plan"))
}

/// Runs `p.series(of, step)`: lists the values of a signal over a plan, at the times of `p.times(step)`.
///
/// # Errors
/// A fault where the plan's robot has no joints, the signal is of another robot, or a value is not known.
fn plan_series(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(plan) = planned(interpreter, call)? else { return Ok(Value::Unknown) };
    let Value::Signal(signal) = call.get::<&Value>("of")? else {
        unreachable!("`check` lets only signals through")
    };
    interpreter.require_joints(&plan, call.at("self"))?;
    let robot = signal.robot.as_deref();
    interpreter.common_robot(Some(&plan.robot), robot, call.span)?;
    let times = times(interpreter, call, &plan)?;
    let tracks = plan.plan.body.tracks().expect("a robot's plan has tracks");
    let judged = |detail, read: fn(&Instant, &Measure) -> Option<f64>| -> Eval<Vec<Option<f64>>> {
        let known = instants(call, &plan, &times, detail)?;
        Ok(known.iter().map(|known| read(known, &signal.measure)).collect())
    };
    let (values, dimension): (Vec<Option<f64>>, _) = match &signal.measure {
        Measure::Sensed(Signal::Effort(joint)) => {
            (judged(Detail::Loads, effort_of)?, effort_dimension(position_dimension(tracks, *joint)))
        }
        Measure::Sensed(Signal::Angle(joint)) => {
            let start = tracks.start.joints[joint.0 as usize];
            let position =
                |time: &f64| tracks.track(*joint).map_or(start, |track| track.position(start, *time));
            (times.iter().map(|time| Some(position(time))).collect(), position_dimension(tracks, *joint))
        }
        Measure::Sensed(Signal::Speed(joint)) => {
            let dimension = speed_dimension(position_dimension(tracks, *joint));
            (times.iter().map(|time| Some(speed(tracks, *joint, *time))).collect(), dimension)
        }
        Measure::Sensed(Signal::Elapsed) => (times.iter().copied().map(Some).collect(), Dimension::TIME),
        Measure::Sensed(Signal::Tilt(module)) => {
            let known = instants(call, &plan, &times, Detail::Stance)?;
            let turns = states(&plan, &times, &known)
                .map(|state| pose_in(&state, MovingFrame::Module(*module)).rotation)
                .collect::<Vec<_>>();
            let leans = turns.iter().map(|turn| Some(lean(&(turn * turns[0].inverse())))).collect();
            (leans, Dimension::ANGLE)
        }
        Measure::Sensed(Signal::Separation(a, b)) => {
            let paths = ClusterPaths::of(&plan.plan, tracks.duration);
            let at = |time: &f64| {
                let state = tracks.state(*time);
                let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
                let mut poses = vec![state.base; kinematics.link_count()];
                match &paths {
                    Some(paths) => paths.place(*time, &mut poses),
                    None => kinematics.link_poses(&state.joints, &state.base, &mut poses),
                }
                let [a, b] = [a, b].map(|port| kinematics.port_pose(&tracks.robot, *port, &poses));
                Some((a.translation.vector - b.translation.vector).norm())
            };
            (times.iter().map(at).collect(), Dimension::LENGTH)
        }
        Measure::Pose(frame) | Measure::Position(frame) => {
            let known = instants(call, &plan, &times, Detail::Stance)?;
            let whole = matches!(signal.measure, Measure::Pose(_));
            let value = |state: StateValue| match pose_in(&state, *frame) {
                pose if whole => Value::Pose(Rc::new(pose)),
                pose => Value::Vec3(pose.translation.vector, Dimension::LENGTH),
            };
            return Ok(Value::list(states(&plan, &times, &known).map(value).collect()));
        }
        Measure::Clearance => (plan.clearances(&times, None).to_vec(), Dimension::LENGTH),
        Measure::Margin => (judged(Detail::Stance, |known, _| known.margin)?, Dimension::LENGTH),
        Measure::GroundForce(_) => (judged(Detail::Loads, normal_force)?, Dimension::FORCE),
    };
    if let Some(at) = values.iter().position(Option::is_none) {
        return Err(unknown(call, &plan, &signal.measure, times[at]));
    }
    Ok(Value::list(values.into_iter().flatten().map(|x| Value::Quantity(x, dimension)).collect()))
}

/// Returns the dimension of a joint's position: a length where it is prismatic, otherwise an angle.
fn position_dimension(tracks: &Tracks, joint: JointId) -> Dimension {
    let owner =
        tracks.robot.joints().nth(joint.0 as usize).expect("signals are of joints of the plan's robot");
    if tracks.robot.slides(owner) { Dimension::LENGTH } else { Dimension::ANGLE }
}

fn speed_dimension(position: Dimension) -> Dimension {
    position.over(Dimension::TIME).expect("exponents of positions are 0 and 1")
}

/// Returns the dimension of what moves a joint with positions of this dimension: a force or a torque.
fn effort_dimension(position: Dimension) -> Dimension {
    if position == Dimension::LENGTH { Dimension::FORCE } else { Dimension::TORQUE }
}

fn speed(tracks: &Tracks, joint: JointId, time: f64) -> f64 {
    tracks.track(joint).map_or(0.0, |track| track.velocity(time))
}

fn effort_of(known: &Instant, measure: &Measure) -> Option<f64> {
    let Measure::Sensed(Signal::Effort(joint)) = measure else { return None };
    known.efforts[joint.0 as usize]
}

fn normal_force(known: &Instant, measure: &Measure) -> Option<f64> {
    let (Measure::GroundForce(modules), Some(forces)) = (measure, &known.forces) else { return None };
    Some(forces.iter().filter(|push| modules.contains(&push.module)).map(|push| push.normal).sum())
}

/// Returns the fault of a series with a value that nobody knows.
fn unknown(call: &Call, plan: &PlanValue, measure: &Measure, time: f64) -> Stop {
    let World { ground, gravity, .. } = plan
        .plan
        .worlds
        .iter()
        .take_while(|from| from.from <= time)
        .last()
        .map_or_else(World::default, |w| w.world);
    let weightless = gravity == 0.0 || ground == Ground::Off;
    let (what, why) = match measure {
        Measure::Sensed(Signal::Effort(_)) | Measure::GroundForce(_) if weightless => {
            ("load", "nothing is weighed without gravity and a ground")
        }
        Measure::Sensed(Signal::Effort(_)) | Measure::GroundForce(_) => {
            ("load", "no forces of the ground are known that carry the robot")
        }
        Measure::Margin if weightless => ("margin", "there is no ground to stand on"),
        Measure::Margin if ground == Ground::Held => ("margin", "what is held fast does not stand"),
        Measure::Margin => ("margin", "support is missing there"),
        _ => ("clearance", "no two links are there that may not touch"),
    };
    let message = format!("at {} the judge knows no {what}: {why}", quantity(time, Dimension::TIME));
    Diagnostic::error(code::BAD_VALUE, message)
        .label(call.at("of"), "not known throughout the plan")
        .hint("`p.states()` tells what is known at each time: `[s.margin for s in p.states()]` has gaps")
        .into()
}

fn state_speed(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, joint) = (call.get::<&StateValue>("self")?, call.get::<&JointValue>("joint")?);
    interpreter.common_robot(Some(&state.robot), Some(&joint.robot), call.span)?;
    has_joint(call, state, joint)?;
    let tracks = state.planned.plan.body.tracks().expect("a state is one of a robot");
    let speed = speed(tracks, state.body.joint(joint), state.time);
    Ok(Value::Quantity(speed, speed_dimension(joint.dimension)))
}

fn state_effort(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, joint) = (call.get::<&StateValue>("self")?, call.get::<&JointValue>("joint")?);
    interpreter.common_robot(Some(&state.robot), Some(&joint.robot), call.span)?;
    has_joint(call, state, joint)?;
    let dimension = effort_dimension(joint.dimension);
    let joint = Measure::Sensed(Signal::Effort(state.body.joint(joint)));
    let known = state.judged(Detail::Loads, |known| effort_of(known, &joint)).flatten();
    Ok(Value::optional(known.map(|effort| Value::Quantity(effort, dimension))))
}

fn state_ground_force(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, on) = (call.get::<&StateValue>("self")?, call.get::<&Rc<Instance>>("on")?);
    interpreter.common_robot(Some(&state.robot), Some(&on.robot), call.span)?;
    has_modules(call, state, "on", &modules_of(on))?;
    let modules = Measure::GroundForce(modules_of(on));
    let known = state.judged(Detail::Loads, |known| normal_force(known, &modules)).flatten();
    Ok(Value::optional(known.map(|force| Value::Quantity(force, Dimension::FORCE))))
}

fn state_contacts(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let state = call.get::<&StateValue>("self")?;
    let Some(mut forces) = state.judged(Detail::Loads, |known| known.forces.clone()).flatten() else {
        return Ok(Value::Missing);
    };
    forces.retain(|push| state.has(push.module));
    let contact = |push: &GroundForce| {
        let module = state.body.assembly.modules[push.module].name.clone();
        Value::Record(Rc::new(Record::Native(Rc::new(Contact { module, push: *push }))))
    };
    Ok(Value::list(forces.iter().map(contact).collect()))
}

/// A force of the ground, with the name of the module that it acts on.
#[derive(Debug)]
struct Contact {
    module: String,
    push: GroundForce,
}

/// The fields of a `Contact`.
const CONTACT: &[Field<Contact>] = &[
    ("module", |contact| Value::text(&contact.module)),
    ("point", |contact| Value::Vec3(contact.push.point, Dimension::LENGTH)),
    ("force", |contact| Value::Vec3(contact.push.force, Dimension::FORCE)),
];

impl NativeRecord for Contact {
    fn read(&self, field: &str) -> Value {
        read_field(CONTACT, self, field)
    }

    fn show(&self) -> String {
        format!("{} on {}", quantity(self.push.force.norm(), Dimension::FORCE), self.module)
    }
}

/// Returns the records of this file, each as (name, names of its fields in order).
pub(super) fn records() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![("Contact", field_names(CONTACT))]
}
