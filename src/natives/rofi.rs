//! Robots of RoFI modules from and to RoFI's files.

use super::Native;
use crate::check::typed::{Def, DefId};
use crate::elaborate::outside;
use crate::interpret::argument::parameters;
use crate::interpret::design::{BondRecord, ConfigDesign, Design, DesignKind, FlatModule, SetRecord};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{Value, arguments_key};
use crate::planners::tosnake::conversion::{from_world, to_world};
use crate::planners::tosnake::random_configuration::random_configuration;
use crate::planners::tosnake::repair::{Unrepairable, repair};
use crate::planners::tosnake::{InvalidStart, TOLERANCES};
use crate::robot::rofi::{self, Dock, Edge, Module, World};
use crate::robot::rofi_json;
use crate::robot::{JointOwner, ModuleType, Residual};
use crate::source::{Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The built-ins `load`, which reads a RoFI file, and `tangle`, which makes a random configuration: the key of each
/// with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("load", parameters![file: &str], load),
    Native::pure("tangle", parameters![n: usize, actions: usize, seed: usize], tangle),
];

/// The file of the library that declares the module.
const LIBRARY: &str = "std/rofi.mod";

/// The joints of a module in the order of the files.
const JOINTS: [&str; 3] = ["alpha", "beta", "gamma"];

fn load(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let path = call.get::<&str>("file")?.to_string();
    let (kind, loaded) = library(interpreter, call)?;
    let (file, bytes) = interpreter.project_file(call, "file")?;
    let args = [Value::Text(file.as_str().into())];
    let known = |design: &Design| matches!(&design.args[..], [Value::Text(text)] if **text == *file);
    if let Some(design) = interpreter.memory.designs[loaded.0 as usize].find(arguments_key(&args), known) {
        return Ok(instance(interpreter, &design));
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        fault(code::CANNOT_READ, call.at("file"), format!("`{path}` is not UTF-8 text"), "no text")
    })?;
    let read = if path.ends_with(".json") { rofi_json::read } else { rofi::read };
    let world = read(&text).map_err(|f| faulty(call, &path, f.line, f.column, &f.what))?;
    made(interpreter, call, (kind, loaded), &file, &path, world)
}

/// Runs `tangle`: returns a random configuration to unwind; see `docs/planners/tosnake.md`.
fn tangle(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let kinds = library(interpreter, call)?;
    let modules = call.count("n", "a number of modules")?;
    let actions = call.count("actions", "a number of actions")?;
    let seed = call.count("seed", "a seed")?;
    if modules == 0 {
        return Err(call.refuse("n", "a robot has a module at least"));
    }
    check_count(interpreter, call, modules)?;
    if actions > ACTIONS_MAX {
        let message = format!("more than {ACTIONS_MAX} actions are not made");
        return Err(fault(code::SIZE_LIMIT, call.at("actions"), message, "too many actions"));
    }
    let name = format!("tangle({modules}, {actions}, seed: {seed})");
    crate::interrupt::start_task(format!("tangling {modules} modules"));
    let world = to_world(&random_configuration(modules, actions, seed as u64));
    made(interpreter, call, kinds, &name, &name, world)
}

/// The greatest number of actions of one tangle.
const ACTIONS_MAX: usize = 1_000_000;

/// Returns the library's module, and its configuration that stands for robots made from data.
///
/// # Errors
/// A fault where the program does not import them.
fn library(interpreter: &Interpreter, call: &Call) -> Eval<(DefId, DefId)> {
    match (declared(interpreter, "Rofi"), declared(interpreter, "_Loaded")) {
        (Some(kind), Some(loaded)) => Ok((kind, loaded)),
        _ => {
            let message = "a robot of RoFI modules needs the library's module";
            Err(fault(code::UNKNOWN_IMPORT, call.span, message, "`use std.rofi.Rofi` is missing"))
        }
    }
}

/// Returns the span of the first argument, the origin of the robot: a file, or a number of modules.
fn origin(call: &Call) -> Span {
    call.at(call.native.parameters[0].name)
}

fn check_count(interpreter: &Interpreter, call: &Call, modules: usize) -> Eval<()> {
    let limit = interpreter.limits().modules;
    if modules > limit {
        let message = format!("a robot of more than {limit} modules is not allowed");
        return Err(fault(code::SIZE_LIMIT, origin(call), message, "too many modules"));
    }
    Ok(())
}

/// Returns a robot from data, without the connections that contradict others. `key` distinguishes it from
/// others, `path` is its name in messages.
///
/// # Errors
/// A fault where it has too many modules, a joint out of range, or several pieces.
fn made(
    interpreter: &mut Interpreter,
    call: &Call,
    (kind, loaded): (DefId, DefId),
    key: &str,
    path: &str,
    mut world: World,
) -> Eval<Value> {
    check_count(interpreter, call, world.modules.len())?;
    let Some(module) = interpreter.default_design(kind)? else { return Ok(Value::Unknown) };
    let repaired = repair(&mut from_world(&world));
    if let Ok(open) = &repaired
        && !open.is_empty()
    {
        let pitch = pitch(&module.module_type(0));
        let left_out: Vec<_> = open.iter().map(|open| (open.bond, open.gap * pitch)).collect();
        leave_out(interpreter, &mut world, &left_out, call, path);
    }
    let design = loop {
        let design = Rc::new(Design {
            def: loaded,
            name: path.to_owned(),
            args: vec![Value::text(key)],
            kind: DesignKind::Config(configuration(&world, &module, call, path)?),
            broken: false.into(),
        });
        let open = open_loops(interpreter, &world, &design, call, path)?;
        if open.is_empty() {
            break design;
        }
        if let Err(unrepairable) = &repaired {
            none_is_free(interpreter, &world, unrepairable, call, path);
        }
        let left_out: Vec<_> = open.iter().map(|open| (open.bond, open.distance)).collect();
        leave_out(interpreter, &mut world, &left_out, call, path);
    };
    interpreter.memory.designs[loaded.0 as usize].push(arguments_key(&design.args), design.clone());
    Ok(instance(interpreter, &design))
}

/// Warns that modules overlap in all choices of the connections that contradict each other, with the connections that
/// force it; `world` has all connections yet.
fn none_is_free(
    interpreter: &mut Interpreter,
    world: &World,
    unrepairable: &Unrepairable,
    call: &Call,
    path: &str,
) {
    let Unrepairable { reason, tried, complete, forced } = unrepairable;
    let InvalidStart::Overlap { modules, bonds, .. } = reason else { return };
    let [a, b] = modules.map(|module| world.modules[module].id);
    let lines: Vec<String> = bonds.iter().map(|&bond| world.edges[bond].line.to_string()).collect();
    let lines = crate::interpret::design::shorten(&lines);
    let message = format!(
        "`{path}`: connections contradict each other, and modules are in each other {}",
        match complete {
            true => "whichever of them are left out".to_owned(),
            false => format!("in {tried} choices of which are left out"),
        }
    );
    let by = if bonds.len() == 1 { "the connection of line" } else { "the connections of lines" };
    let label = match forced {
        true => format!("{by} {lines} put modules {a} and {b} into each other in any case"),
        false => format!("nearest to free: {by} {lines} put modules {a} and {b} into each other"),
    };
    interpreter.add_report(
        Diagnostic::warning(code::OPEN_LOOP, message).label(origin(call), label).hint(
            "no motion can be planned from there: one of these connections, or a joint, has to be mended",
        ),
    );
}

/// Returns the pitch of the library's module, m.
fn pitch(kind: &ModuleType) -> f64 {
    kind.ports[0].pose.translation.vector.norm() * 2.0
}

fn instance(interpreter: &mut Interpreter, design: &Rc<Design>) -> Value {
    Value::Instance(interpreter.whole(design))
}

/// Returns a declaration of the library's file; `None` if the program does not import it.
fn declared(interpreter: &Interpreter, name: &str) -> Option<DefId> {
    let shared = &interpreter.shared;
    let here = |def: &Def| def.name == name && *shared.sources.file(def.span.file).name == *LIBRARY;
    shared.program.identified().find(|(_, def)| here(def)).map(|(id, _)| id)
}

fn faulty(call: &Call, path: &str, line: usize, column: usize, what: &str) -> Stop {
    let message = format!("`{path}`, line {line}, column {column}: {what}");
    fault(code::CANNOT_READ, origin(call), message, format!("line {line}: {what}"))
}

/// Returns the design of modules, positions and connections, as the clauses of a configuration would have
/// made them.
fn configuration(world: &World, module: &Rc<Design>, call: &Call, path: &str) -> Eval<ConfigDesign> {
    let name = |m: &Module| -> Rc<str> { format!("m[{}]", m.id).into() };
    let modules = world.modules.iter().map(|m| FlatModule { name: name(m), design: module.clone() });
    let config = ConfigDesign { closed: true, ..ConfigDesign::of_modules(modules.collect()) };
    let kind = module.module_type(0);
    for (index, declared) in world.modules.iter().enumerate() {
        for (joint, degrees) in JOINTS.iter().zip(declared.joints) {
            let Some(joint) = kind.joints.iter().position(|j| j.name == *joint) else { continue };
            let value = degrees.to_radians();
            if let Some((low, high)) = kind.joints[joint].limits.range
                && !(low..=high).contains(&value)
            {
                let name = &kind.joints[joint].name;
                let what = outside(name, value, (low, high), Dimension::ANGLE);
                return Err(faulty(call, path, declared.line, 1, &what));
            }
            let instance = format!("module {}", declared.id).as_str().into();
            config.sets.borrow_mut().push(SetRecord {
                joint: JointOwner::Module { module: index, joint },
                value,
                span: call.span,
                instance,
            });
        }
    }
    let port = |dock: &Dock| {
        let port = kind.ports.iter().position(|p| p.name == dock.port());
        (dock.module, port.expect("the library's module has the docks of the format"))
    };
    for edge in &world.edges {
        config.add_bond(BondRecord {
            a: port(&edge.a),
            b: port(&edge.b),
            turn: edge.turn,
            span: call.span,
            ends: (call.span, call.span),
            instance: format!("line {}", edge.line).as_str().into(),
        });
    }
    config.base.set(Some(0));
    config.complete.set(true);
    Ok(config)
}

/// Returns the connections that close loops and do not meet, with what is missing. Refuses a robot of several
/// pieces.
fn open_loops(
    interpreter: &mut Interpreter,
    world: &World,
    design: &Rc<Design>,
    call: &Call,
    path: &str,
) -> Eval<Vec<Residual>> {
    let Some(robot) = interpreter.robot_of(design, origin(call))? else { return Ok(Vec::new()) };
    if let Some(&loose) = robot.kinematics.tree.loose.first() {
        let Module { id, line, .. } = &world.modules[loose];
        let what = format!("module {id} does not hang together with module {}", world.modules[0].id);
        return Err(faulty(call, path, *line, 1, &what));
    }
    let pitch = pitch(robot.assembly.module_type(0));
    let open = |r: &Residual| r.distance > TOLERANCES.closure * pitch || r.angle > TOLERANCES.closure;
    Ok(robot.residuals().into_iter().filter(open).collect())
}

/// Removes connections whose docks do not meet, given by their indices with the distances of their docks (m), and warns
/// of them: RoFI's own tangler writes such lines.
fn leave_out(
    interpreter: &mut Interpreter,
    world: &mut World,
    open: &[(usize, f64)],
    call: &Call,
    path: &str,
) {
    let lines: Vec<String> = open.iter().map(|(bond, _)| world.edges[*bond].line.to_string()).collect();
    let worst = open.iter().map(|(_, distance)| *distance).fold(0.0, f64::max);
    let message = format!(
        "`{path}`: {} that the docks of line {} do not meet: up to {} are missing",
        if open.len() == 1 { "a connection was left out, for" } else { "connections were left out, for" },
        crate::interpret::design::shorten(&lines),
        quantity(worst, Dimension::LENGTH),
    );
    interpreter.add_report(
        Diagnostic::warning(code::OPEN_LOOP, message)
            .label(origin(call), "the modules hang together without them")
            .hint(
                "the other connections decide where the modules are, from the lowest id outwards; of several ways the \
                 first in which no module is in another counts",
            ),
    );
    let mut index = 0;
    world.edges.retain(|_| {
        index += 1;
        open.iter().all(|(bond, _)| *bond != index - 1)
    });
}

/// Returns the robot in the argument `what` as the data of a RoFI file, each module's id its index from 0; `None` if
/// it can't be assembled, which has been reported.
///
/// # Errors
/// A fault where a module is not a RoFI module.
pub(super) fn world_of(interpreter: &mut Interpreter, call: &Call) -> Eval<Option<World>> {
    let Value::Instance(instance) = call.get::<&Value>("what")? else {
        unreachable!("`check` lets only robots and foldings through, and foldings have files of their own");
    };
    let design = instance.design.clone();
    let Some(robot) = interpreter.robot_at(&design, call.at("what"))? else { return Ok(None) };
    if !robot.start.clusters.is_empty() {
        let message = format!("`{}` is a scene: a file of RoFI's has one robot", design.name);
        return Err(call.refuse("what", message));
    }
    let mut world = World::default();
    for (index, module) in robot.assembly.modules.iter().enumerate() {
        let kind = robot.assembly.module_type(index);
        let position = |joint: &&str| {
            let joint = kind.joints.iter().position(|j| j.name == **joint)?;
            Some(degrees(robot.start.joints[robot.kinematics.joint(index, joint)]))
        };
        let positions: Option<Vec<f64>> = JOINTS.iter().map(position).collect();
        let (Some([alpha, beta, gamma]), Some(_)) =
            (positions.as_deref(), Dock::of_port(index, &kind.ports[0].name))
        else {
            let message = format!("{} is no RoFI module: no file of RoFI's can say what it is", module.name);
            return Err(call.refuse("what", message));
        };
        world.modules.push(Module { id: index as u64, joints: [*alpha, *beta, *gamma], line: 0 });
    }
    for bond in &robot.assembly.bonds {
        let dock = |at: crate::robot::PortRef| {
            Dock::of_port(at.module, &robot.assembly.module_type(at.module).ports[at.port].name)
        };
        if let (Some(a), Some(b)) = (dock(bond.a), dock(bond.b)) {
            world.edges.push(Edge { a, b, turn: bond.turn, line: 0 });
        }
    }
    Ok(Some(world))
}

/// Returns an angle (rad) in degrees, rounded to 1e-9 degrees.
fn degrees(angle: f64) -> f64 {
    const PARTS: f64 = 1e9;
    (angle.to_degrees() * PARTS).round() / PARTS
}
