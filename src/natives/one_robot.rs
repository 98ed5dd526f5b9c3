//! Built-ins that ask about one of the robots of a scene.

use super::Native;
use crate::interpret::argument::parameters;
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::record::{OneRobot, Record, StateValue};
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::{Behavior, JointValue, Value};
use crate::plan::Verdict;
use crate::plan::verify::articulated;
use crate::robot::{Bond, JointOwner, Kinematics, Misalignment, PortRef, State};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

/// The built-ins `Report.of` and `State.of`: the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("Report.of", parameters![self: &Rc<Verdict>, robot: &Rc<Instance>], report_of),
    Native::on_run("State.of", parameters![self: &StateValue, robot: &Rc<Instance>], state_of),
];

/// Runs `Report.of`: the report on one of the robots of a scene.
///
/// # Errors
/// A fault where the plan has no robot to which the modules belong, or several.
fn report_of(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (verdict, robot) = (call.get::<&Rc<Verdict>>("self")?, call.get::<&Rc<Instance>>("robot")?);
    let bases: Vec<&str> = verdict.robots.iter().map(|one| one.reference.as_str()).collect();
    let found = &verdict.robots[asked(call, robot, "report", (&bases, true))?];
    let headline = if found.verdict.ok() { "verified" } else { "not verified" };
    Ok(Value::Record(Rc::new(Record::Report(Rc::new(found.verdict.clone()), headline.to_owned()))))
}

/// Runs `State.of`: the state of one of the robots of a scene.
///
/// # Errors
/// A fault where the plan has no robot to which the modules belong, or several.
fn state_of(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (state, robot) = (call.get::<&StateValue>("self")?, call.get::<&Rc<Instance>>("robot")?);
    let of_scene = Rc::ptr_eq(&state.robot, &robot.robot.design);
    let tracks = state.planned.plan.body.tracks().expect("a state is one of a robot");
    let (whole, start) = (&tracks.robot, &tracks.start);
    let mut bases: Vec<usize> = start.clusters.iter().map(|cluster| cluster.reference).collect();
    if !bases.is_empty() {
        bases.insert(0, whole.base);
    }
    if let Some(one) = &state.only {
        bases.retain(|base| *base == one.reference);
    }
    let names: Vec<&str> = bases.iter().map(|base| whole.modules[*base].name.as_str()).collect();
    let reference = bases[asked(call, robot, "state", (&names, of_scene))?];
    let reached = Kinematics::new(whole, &start.bonds, reference);
    let mut modules: Vec<usize> = reached.tree.order.iter().map(|(module, _)| *module).collect();
    modules.sort_unstable();
    let one = state.of(OneRobot { instance: robot.clone(), reference, modules });
    Ok(Value::Record(Rc::new(Record::State(Box::new(one)))))
}

/// Returns which of some robots, given by the names of their bases, an instance means, by its index. `about`: what is asked;
/// `of_scene`: false if the instance is none of the scene's, whatever its modules are called.
///
/// # Errors
/// A fault where none of the bases is one of its modules, or several are.
fn asked(call: &Call, robot: &Rc<Instance>, about: &str, (bases, of_scene): (&[&str], bool)) -> Eval<usize> {
    let count = robot.design.module_count();
    let names: Vec<String> =
        robot.modules.indices(count).map(|module| robot.robot.module_name(module).to_string()).collect();
    let meant = |base: &&str| of_scene && names.iter().any(|name| name == base);
    let found: Vec<usize> = (0..bases.len()).filter(|index| meant(&bases[*index])).collect();
    if let [one] = found.as_slice() {
        return Ok(*one);
    }
    let name = if robot.path.is_empty() { robot.design.name.as_str() } else { &robot.path };
    let (message, label) = match found.len() {
        0 => (
            format!("`{name}` is no robot with which the scene of this {about} begins"),
            format!("none of the {about}'s"),
        ),
        several => {
            (format!("`{name}` is {several} robots: a {about} `of` is of one"), "several robots".to_owned())
        }
    };
    let diagnostic = Diagnostic::error(code::BAD_VALUE, message).label(call.at("robot"), label);
    if bases.is_empty() {
        return Err(diagnostic.hint(format!("the {about} is on one robot: ask it itself")).into());
    }
    let known: Vec<String> = bases.iter().map(|base| format!("the robot of `{base}`")).collect();
    Err(diagnostic.hint(format!("it is about {}", known.join(", "))).into())
}

/// Refuses modules that are not of the one robot that a state is of. `name`: the argument that names them; `modules`: their
/// indices in the plan's robot.
///
/// # Errors
/// A fault where one of them is another robot's.
pub(super) fn has_modules(call: &Call, state: &StateValue, name: &str, modules: &[usize]) -> Eval<()> {
    let other = modules.iter().find(|module| !state.has(**module));
    let (Some(other), Some(one)) = (other, &state.only) else { return Ok(()) };
    let module = &state.body.assembly.modules[*other].name;
    let message = format!("`{module}` is not of `{}`, whose state this is", one.instance.path);
    let diagnostic =
        Diagnostic::error(code::BAD_VALUE, message).label(call.at(name), "of another robot of the scene");
    Err(diagnostic.hint("ask the state of the scene, or that `of` the other robot").into())
}

/// Refuses a joint that is not of the one robot that a state is of.
///
/// # Errors
/// A fault where it is another robot's.
pub(super) fn has_joint(call: &Call, state: &StateValue, joint: &JointValue) -> Eval<()> {
    has_modules(call, state, "joint", &[state.body.assembly.module_of(joint.owner)])
}

/// Returns the state in which a behaviour of a robot alone begins, from that of the same robot in a scene; `None` where the
/// robot can't be assembled, which has been reported.
///
/// # Errors
/// A fault where the behaviour is not one of that robot alone, or the robot is in parts.
pub(super) fn beginning(
    interpreter: &mut Interpreter,
    call: &Call,
    behavior: &Behavior,
    (state, one): (&StateValue, &OneRobot),
) -> Eval<Option<State>> {
    let path = &one.instance.path;
    let refused = |message: String, label: &str, hint: &str| -> Stop {
        Diagnostic::error(code::OTHER_ROBOT, message).label(call.at("from"), label).hint(hint).into()
    };
    let design = &one.instance.design;
    let alone = behavior.robot.as_deref().is_none_or(|robot| Rc::ptr_eq(robot, design));
    let count = design.module_count();
    let modules: Vec<usize> = one.instance.modules.indices(count).collect();
    if !alone || modules.len() != one.modules.len() {
        let message =
            format!("this is the state of `{path}` alone, and the behaviour is not one of `{path}` alone");
        let hint = "a behaviour of the scene begins with the state of all its robots: leave out `of(..)`";
        return Err(refused(message, "the state of one robot", hint));
    }
    let Some(own) = interpreter.robot_at(design, call.at("from"))? else { return Ok(None) };
    let own: &Robot = &own;
    let (robot, whole) = (&own.assembly, &state.body.assembly);
    let in_whole = |port: PortRef| PortRef { module: modules[port.module], ..port };
    let of_whole = |bond: &Bond| {
        let (a, b) = (in_whole(bond.a), in_whole(bond.b));
        whole.bonds.iter().position(|known| (known.a, known.b) == (a, b) || (known.b, known.a) == (a, b))
    };
    let bonds: Vec<Option<usize>> = robot.bonds.iter().map(of_whole).collect();
    let joint = |owner: JointOwner| {
        let owner = match owner {
            JointOwner::Module { module, joint } => JointOwner::Module { module: modules[module], joint },
            JointOwner::Bond(bond) => JointOwner::Bond(bonds[bond]?),
        };
        Some(state.state.joints[state.body.joint_of(owner).0 as usize])
    };
    let holds: Vec<bool> =
        bonds.iter().map(|bond| bond.is_some_and(|bond| state.state.bonds[bond])).collect();
    if !Kinematics::new(robot, &holds, robot.base).tree.loose.is_empty() {
        let message = format!("`{path}` is in parts then");
        let hint = "`plan(..., from: p.end)` begins with all robots, and parts of robots, of the scene";
        return Err(refused(message, "a robot that has come apart", hint));
    }
    let base = state.body.kinematics.module_pose(modules[robot.base], &state.poses());
    let joints = robot.joints().zip(&own.start.joints).map(|(owner, start)| joint(owner).unwrap_or(*start));
    let then = articulated::standing(&state.planned.plan, state.time);
    let errors = then.map_or(vec![], |then| then.misalignments);
    let own_bond = |bond: usize| bonds.iter().position(|known| *known == Some(bond));
    let own_error =
        |error: &Misalignment| Some(Misalignment { bond: own_bond(error.bond)?, ..error.clone() });
    let mut misalignments: Vec<Misalignment> = errors.iter().filter_map(own_error).collect();
    misalignments.sort_by_key(|error| error.bond);
    Ok(Some(State { joints: joints.collect(), bonds: holds, base, clusters: vec![], misalignments }))
}
