//! Built-ins that ask about robots, lattices and trusses.

use super::Native;
use super::one_robot::{has_joint, has_modules};
use crate::geometry::{Pose, Vec3};
use crate::interpret::argument::parameters;
use crate::interpret::design::{Design, DesignKind, Instance, Subject, port_ref};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::record::{DeclaredRecord, Record, StateValue};
use crate::interpret::robot::Robot;
use crate::interpret::stop::Eval;
use crate::interpret::value::{JointValue, Measure, MovingFrame, PortValue, SignalValue, Value};
use crate::plan::TOLERANCES;
use crate::robot::{Bond, PortRef, matching};
use crate::units::Dimension;
use std::f64::consts::TAU;
use std::rc::Rc;

/// The built-ins for robots and their states, such as `mass`, `ports`, `pose` and `State.angle`: the key of each with
/// its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("order", parameters![of: &Rc<Instance>], |_, call| {
        Ok(Value::count(call.get::<&Rc<Instance>>("of")?.design.order()))
    }),
    Native::pure("count", parameters![of: &Value], count),
    Native::pure("mass", parameters![of: &Value], mass),
    Native::pure("com", parameters![of: &Rc<Instance>], com),
    Native::on_run("footprint", parameters![of: &Rc<Instance>], footprint),
    Native::pure("ports", parameters![of: &Rc<Instance>], ports),
    Native::pure("modules", parameters![of: &Rc<Instance>, kind: &Rc<Instance>], modules),
    Native::pure("connections", parameters![of: &Rc<Instance>], connections),
    Native::pure("same", parameters![a: &Rc<Instance>, b: &Rc<Instance>], same),
    Native::pure("pose", parameters![of: &Value], pose),
    Native::pure("distance", parameters![a: &Value, b: &Value], distance),
    Native::pure("nodes", parameters![of: &Rc<Instance>], |_, call| {
        Ok(truss(call)?.map_or(Value::Unknown, |t| Value::count(t.nodes.len())))
    }),
    Native::pure("struts", parameters![of: &Rc<Instance>], |_, call| {
        Ok(truss(call)?.map_or(Value::Unknown, |t| Value::count(t.struts.len())))
    }),
    Native::pure("rigidity", parameters![of: &Rc<Instance>], rigidity),
    Native::on_run("State.angle", parameters![self: &StateValue, joint: &JointValue], state_position),
    Native::on_run("State.displacement", parameters![self: &StateValue, joint: &JointValue], state_position),
    Native::on_run("State.pose", parameters![self: &StateValue, of: &Value], state_pose),
];

/// Returns the instance in the argument `of`, for natives that declare several types of instances for it.
fn instance<'c>(call: &Call<'c>) -> Eval<&'c Rc<Instance>> {
    match call.get::<&Value>("of")? {
        Value::Instance(instance) => Ok(instance),
        _ => unreachable!("`check` lets only instances through to `{}`", call.native.key),
    }
}

fn count(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::count(instance(call)?.design.element_count()))
}

fn mass(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Quantity(instance(call)?.design.mass(), Dimension::MASS))
}

/// Returns the robot of the design in the argument `of`, which may be a part of another: it is then taken by
/// itself. `None` where it can't be assembled.
fn own_robot(interpreter: &mut Interpreter, call: &Call) -> Eval<Option<Rc<Robot>>> {
    robot_in(interpreter, call, "of")
}

/// Returns the robot of the design in the argument `name`, taken by itself; `None` where it can't be assembled.
fn robot_in(interpreter: &mut Interpreter, call: &Call, name: &str) -> Eval<Option<Rc<Robot>>> {
    let design = call.get::<&Rc<Instance>>(name)?.design.clone();
    interpreter.robot_at(&design, call.at(name))
}

/// Runs `connections(of)`: a `Connection` for each bond of a robot.
fn connections(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let instance = call.get::<&Rc<Instance>>("of")?;
    if instance.design.module().is_some() {
        return Ok(Value::list(Vec::new()));
    }
    let Some(robot) = own_robot(interpreter, call)? else { return Ok(Value::Unknown) };
    let def = interpreter.prelude_record("Connection");
    let assembly = &robot.assembly;
    let port = |end: PortRef| {
        Value::Port(PortValue {
            robot: instance.robot.clone(),
            module: instance.modules.index(end.module),
            port: end.port,
        })
    };
    let connection = |bond: &Bond| {
        let turn = TAU * f64::from(bond.turn) / f64::from(assembly.connector(bond.a).turns);
        let fields = vec![port(bond.a), port(bond.b), Value::Quantity(turn, Dimension::ANGLE)];
        Value::Record(Rc::new(Record::Declared(DeclaredRecord { def, fields })))
    };
    Ok(Value::list(assembly.bonds.iter().map(connection).collect()))
}

/// Runs `same(a, b)`: true if there is an isomorphism of the two robots in their start states.
fn same(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (robot_in(interpreter, call, "a")?, robot_in(interpreter, call, "b")?);
    let (Some(a), Some(b)) = (a, b) else { return Ok(Value::Unknown) };
    let found = matching((&a.assembly, &a.start), (&b.assembly, &b.start), TOLERANCES.join_joint);
    Ok(Value::Bool(found.is_ok()))
}

fn com(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(robot) = own_robot(interpreter, call)? else { return Ok(Value::Unknown) };
    let (centre, _) = robot.centre_of_mass();
    Ok(Value::Vec3(centre, Dimension::LENGTH))
}

fn footprint(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(robot) = own_robot(interpreter, call)? else { return Ok(Value::Unknown) };
    if !robot.start.clusters.is_empty() {
        return Err(call.refuse("of", "a scene has several robots: name one, as in `footprint(s.a)`"));
    }
    let corners = crate::interpret::planning::footprint(&robot);
    Ok(Value::list(corners.into_iter().map(|p| Value::Vec3(p, Dimension::LENGTH)).collect()))
}

fn ports(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let instance = call.get::<&Rc<Instance>>("of")?;
    let design = &instance.design;
    let mut free = Vec::new();
    for module in 0..design.module_count() {
        let count = design.module_type(module).ports.len();
        let module = instance.modules.index(module);
        let taken = |port: usize| is_taken(&instance.robot, module, port);
        free.extend(
            (0..count)
                .filter(|&port| !taken(port))
                .map(|port| Value::Port(PortValue { robot: instance.robot.clone(), module, port })),
        );
    }
    Ok(Value::list(free))
}

fn is_taken(robot: &Rc<Design>, module: usize, port: usize) -> bool {
    robot.config().is_some_and(|config| config.taken.borrow().contains_key(&(module, port)))
}

/// Runs `modules`: returns the modules of the declaration of `kind`, whatever their arguments.
fn modules(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (whole, kind) = (call.get::<&Rc<Instance>>("of")?, call.get::<&Rc<Instance>>("kind")?);
    let mut found = Vec::new();
    collect(whole, kind.design.def, &mut found);
    Ok(Value::list(found))
}

/// Adds the instances of a declaration among an instance and its parts, in their order.
fn collect(instance: &Rc<Instance>, kind: crate::check::typed::DefId, found: &mut Vec<Value>) {
    // A robot that a planner put together has the declaration of its modules.
    if instance.design.def == kind && (instance.design.module().is_some() || instance.parts().is_none()) {
        found.push(Value::Instance(instance.clone()));
        return;
    }
    for part in instance.parts().unwrap_or_default() {
        match part {
            Value::Instance(part) => collect(part, kind, found),
            Value::List(parts) => {
                for part in parts.iter() {
                    if let Value::Instance(part) = part {
                        collect(part, kind, found);
                    }
                }
            }
            _ => {}
        }
    }
}

/// Returns the robot of a port or a module, and its pose in the start state in the frame of the robot's base
/// module; `None` where the robot can't be assembled.
///
/// # Errors
/// A fault where the argument `name` is neither.
fn pose_of(interpreter: &mut Interpreter, call: &Call, name: &str) -> Eval<Option<(Rc<Design>, Pose)>> {
    match call.arg(name) {
        Value::Port(port) => {
            let Some(robot) = interpreter.robot_at(&port.robot, call.at(name))? else { return Ok(None) };
            Ok(Some((port.robot.design.clone(), robot.port_pose(port))))
        }
        Value::Instance(module) if module.design.module().is_some() => {
            let Some(robot) = interpreter.robot_at(&module.robot, call.at(name))? else { return Ok(None) };
            Ok(Some((
                module.robot.design.clone(),
                robot.kinematics.module_pose(module.modules.index(0), &robot.poses),
            )))
        }
        _ => Err(call.refuse(name, "a port or a module is wanted")),
    }
}

fn pose(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    if call.signal {
        let (robot, frame) = frame(call.arg("of"));
        return Ok(Value::Signal(Rc::new(SignalValue { robot: Some(robot), measure: Measure::Pose(frame) })));
    }
    Ok(pose_of(interpreter, call, "of")?.map_or(Value::Unknown, |(_, pose)| Value::Pose(Rc::new(pose))))
}

fn distance(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (pose_of(interpreter, call, "a")?, pose_of(interpreter, call, "b")?);
    let (Some((robot, a)), Some((other, b))) = (a, b) else { return Ok(Value::Unknown) };
    interpreter.common_robot(Some(&robot), Some(&other), call.span)?;
    let between: Vec3 = a.translation.vector - b.translation.vector;
    Ok(Value::length(between.norm()))
}

fn truss<'c>(call: &'c Call) -> Eval<Option<&'c crate::interpret::design::TrussDesign>> {
    Ok(match &call.get::<&Rc<Instance>>("of")?.design.kind {
        DesignKind::Truss(truss) => Some(truss),
        _ => None,
    })
}

fn rigidity(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Record(Rc::new(Record::Rigidity(call.get::<&Rc<Instance>>("of")?.design.clone()))))
}

fn state_position(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, joint) = (call.get::<&StateValue>("self")?, call.get::<&JointValue>("joint")?);
    interpreter.common_robot(Some(&state.robot), Some(&joint.robot), call.span)?;
    has_joint(call, state, joint)?;
    let id = state.body.joint(joint);
    Ok(Value::Quantity(state.state.joints[id.0 as usize], joint.dimension))
}

/// Returns the robot that a port or a module belongs to, and its frame there.
fn frame(of: &Value) -> (Subject, MovingFrame) {
    match of {
        Value::Instance(module) => (module.robot.clone(), MovingFrame::Module(module.modules.index(0))),
        Value::Port(port) => (port.robot.clone(), MovingFrame::Port(port_ref(port))),
        _ => unreachable!("`check` lets only modules and ports through"),
    }
}

/// Returns the world pose `X_WF` (m) of a frame that moves with a robot, in a state of that robot.
pub(super) fn pose_in(state: &StateValue, frame: MovingFrame) -> Pose {
    let kinematics = &state.body.kinematics;
    match frame {
        MovingFrame::Module(module) => kinematics.module_pose(module, &state.poses()),
        MovingFrame::Port(port) => kinematics.port_pose(&state.body.assembly, port, &state.poses()),
    }
}

fn state_pose(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let state = call.get::<&StateValue>("self")?;
    let (robot, frame) = frame(call.get::<&Value>("of")?);
    interpreter.common_robot(Some(&state.robot), Some(&robot), call.span)?;
    let module = match frame {
        MovingFrame::Module(module) => module,
        MovingFrame::Port(port) => port.module,
    };
    has_modules(call, state, "of", &[module])?;
    Ok(Value::Pose(Rc::new(pose_in(state, frame))))
}
