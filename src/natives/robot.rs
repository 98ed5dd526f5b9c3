//! Built-ins that ask about robots, lattices and trusses.

use super::{Effect, Native, on_run, pure};
use crate::elaborate::robot_of::Robot;
use crate::geometry::{Pose, Vec3};
use crate::interpret::call::Call;
use crate::interpret::design::{Design, DesignKind, Instance};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::{PortValue, Value};
use crate::units::Dimension;
use std::rc::Rc;

pub const TABLE: &[Native] = &[
    pure("order", 1, |_, call| Ok(Value::count(call.instance(0)?.design.order()))),
    pure("count", 1, count),
    pure("mass", 1, mass),
    pure("com", 1, com),
    Native { key: "footprint", params: 1, effect: Effect::OnRun, body: footprint },
    pure("ports", 1, ports),
    pure("modules", 2, modules),
    pure("pose", 1, pose),
    pure("distance", 2, distance),
    pure("nodes", 1, |_, call| Ok(truss(call)?.map_or(Value::Unknown, |t| Value::count(t.nodes.len())))),
    pure("struts", 1, |_, call| Ok(truss(call)?.map_or(Value::Unknown, |t| Value::count(t.struts.len())))),
    pure("rigidity", 1, rigidity),
    on_run("State.angle", 2, state_angle),
    on_run("State.pose", 2, state_pose),
];

fn count(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let design = &call.instance(0)?.design;
    Ok(Value::count(match &design.kind {
        DesignKind::Lattice(lattice) => lattice.cells.places.len(),
        _ => design.module_count(),
    }))
}

fn mass(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let design = &call.instance(0)?.design;
    let mass = match &design.kind {
        DesignKind::Cell(cell) => cell.mass,
        DesignKind::Strut(strut) => strut.mass,
        DesignKind::Lattice(lattice) => match &lattice.of.kind {
            DesignKind::Cell(cell) => cell.mass * lattice.cells.places.len() as f64,
            _ => 0.0,
        },
        DesignKind::Truss(truss) => truss.strut_kind().map_or(0.0, |s| s.mass) * truss.struts.len() as f64,
        DesignKind::Module(_) | DesignKind::Config(_) => (0..design.module_count())
            .map(|m| design.module_type(m).links.iter().map(|link| link.mass).sum::<f64>())
            .sum(),
    };
    Ok(Value::Quantity(mass, Dimension::MASS))
}

/// The part as a robot of its own: questions about a part are not about the whole.
fn own_robot(interpreter: &mut Interpreter, call: &Call) -> Eval<Option<Rc<Robot>>> {
    let design = call.instance(0)?.design.clone();
    interpreter.robot_at(&design, call.at(0))
}

fn com(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(robot) = own_robot(interpreter, call)? else { return Ok(Value::Unknown) };
    let (centre, _) = robot.centre_of_mass();
    Ok(Value::Vec3(centre, Dimension::LENGTH))
}

fn footprint(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(robot) = own_robot(interpreter, call)? else { return Ok(Value::Unknown) };
    let corners = crate::interpret::planning::footprint(&robot);
    Ok(Value::list(corners.into_iter().map(|p| Value::Vec3(p, Dimension::LENGTH)).collect()))
}

fn ports(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let instance = call.instance(0)?;
    let design = &instance.design;
    let mut free = Vec::new();
    for module in 0..design.module_count() {
        let count = design.module_type(module).ports.len();
        let taken = |port: usize| is_taken(&instance.robot, instance.offset + module, port);
        free.extend((0..count).filter(|&port| !taken(port)).map(|port| {
            Value::Port(PortValue { robot: instance.robot.clone(), module: instance.offset + module, port })
        }));
    }
    Ok(Value::list(free))
}

fn is_taken(robot: &Rc<Design>, module: usize, port: usize) -> bool {
    robot.config().is_some_and(|config| config.taken.borrow().contains_key(&(module, port)))
}

/// Modules of the kind of the second argument, whatever its arguments.
fn modules(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (whole, kind) = (call.instance(0)?, call.instance(1)?);
    let mut found = Vec::new();
    collect(whole, kind.design.def, &mut found);
    Ok(Value::list(found))
}

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

/// Where a port or a module's body is in the frame of its robot's base module.
fn place(interpreter: &mut Interpreter, call: &Call, index: usize) -> Eval<Option<(Rc<Design>, Pose)>> {
    match call.arg(index) {
        Value::Port(port) => {
            let Some(robot) = interpreter.robot_at(&port.robot, call.at(index))? else { return Ok(None) };
            Ok(Some((port.robot.clone(), robot.port_pose(port))))
        }
        Value::Instance(module) if module.design.module().is_some() => {
            let Some(robot) = interpreter.robot_at(&module.robot, call.at(index))? else { return Ok(None) };
            Ok(Some((module.robot.clone(), robot.kinematics.module_pose(module.offset, &robot.poses))))
        }
        _ => Err(call.refuse(index, "a port or a module is wanted")),
    }
}

fn pose(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(place(interpreter, call, 0)?.map_or(Value::Unknown, |(_, pose)| Value::Pose(Rc::new(pose))))
}

fn distance(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (a, b) = (place(interpreter, call, 0)?, place(interpreter, call, 1)?);
    let (Some((robot, a)), Some((other, b))) = (a, b) else { return Ok(Value::Unknown) };
    interpreter.common_robot(Some(&robot), Some(&other), call.span)?;
    let between: Vec3 = a.translation.vector - b.translation.vector;
    Ok(Value::length(between.norm()))
}

fn truss<'c>(call: &'c Call) -> Eval<Option<&'c crate::elaborate::truss::TrussDesign>> {
    Ok(match &call.instance(0)?.design.kind {
        DesignKind::Truss(truss) => Some(truss),
        _ => None,
    })
}

fn rigidity(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Record(Rc::new(Record::Rigidity(call.instance(0)?.design.clone()))))
}

fn state<'c>(call: &'c Call) -> Eval<&'c crate::interpret::record::StateValue> {
    match call.arg(0) {
        Value::Record(record) => match &**record {
            Record::State(state) => Ok(state),
            _ => Err(call.refuse(0, "a state is wanted")),
        },
        _ => Err(call.refuse(0, "a state is wanted")),
    }
}

fn state_angle(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, joint) = (state(call)?, call.joint(1)?);
    interpreter.common_robot(Some(&state.robot), Some(&joint.robot), call.span)?;
    let id = state.body.joint(joint);
    Ok(Value::Quantity(state.state.joints[id.0 as usize], joint.dimension))
}

fn state_pose(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, module) = (state(call)?, call.instance(1)?);
    interpreter.common_robot(Some(&state.robot), Some(&module.robot), call.span)?;
    Ok(Value::Pose(Rc::new(state.body.kinematics.module_pose(module.offset, &state.poses()))))
}
