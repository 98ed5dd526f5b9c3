//! The XML of VSPARC: a configuration is a state of the robot with connections, a behaviour is a row of states.
//!
//! Its world is left-handed, with y up; a module is 1 wide. A part has the front along +x, the right along +y, and its mark
//! along +z. Angles are degrees. Joints turn their part about the positive axis of that frame by the left-hand rule, so that a
//! positive `Body` folds the front down and a positive `FrontWheel` turns it against the outward normal; both wheels turn as
//! they do here. The parts' places in published files say so.

use super::super::import_fault::ImportFault;
use super::configuration::{ends, place, turn};
use super::order::Graph;
use super::parts::{Action, Face, Member, Robot, tilt_fault};
use super::{COMMANDS_MAX, Document, MODULES_MAX, Node, xml};
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// The distance between opposite faces of these modules, m.
const PITCH: f64 = 0.08;
/// The greatest tilt of these modules in the library, rad.
const TILT_MAX: f64 = 80.0 * std::f64::consts::PI / 180.0;
/// The names of the joints with their factors, in the order of the library's.
const JOINTS: [(&str, f64); 4] =
    [("FrontWheel", -1.0), ("LeftWheel", 1.0), ("RightWheel", 1.0), ("Body", -1.0)];

/// Reads a configuration.
pub(super) fn read(document: &Document) -> Result<Robot, ImportFault> {
    let root = document.root_element();
    let mut robot = Robot::new(PITCH);
    let modules = xml::children(xml::child(root, "ModuleStates")?, "ModuleState")?;
    if modules.len() > MODULES_MAX {
        return Err(ImportFault::at_node(
            root,
            format!("{} modules are more than {MODULES_MAX}", modules.len()),
        ));
    }
    let mut names = BTreeMap::new();
    for node in modules {
        let name = name(node)?.to_owned();
        let mut state = [0.0; 4];
        for (joint, command) in commands(node)? {
            // A wheel that turns stands at some angle, which its file does not say.
            if command.speed {
                continue;
            }
            state[joint] = command.value;
        }
        if names.insert(name.clone(), robot.members.len()).is_some() {
            return Err(ImportFault::at_node(node, format!("the module `{name}` is there twice")));
        }
        let X = pose(node)?;
        robot.note_tilt(&name, state[3]);
        robot.members.push(Member { name, X, state });
    }
    for node in xml::children(xml::child(root, "Connections")?, "Connection")? {
        let ends = ends(node, &names, "moduleName", "nodeName", &face)?;
        let turn = turn(node)?;
        robot.connect(ends, turn, place(node))?;
    }
    Ok(robot)
}

impl Robot {
    /// Remembers a module that tilts farther than the later generation can.
    fn note_tilt(&mut self, name: &str, tilt: f64) {
        if tilt.abs() > TILT_MAX + 1e-9 && self.wide.is_none() {
            self.wide = Some(name.to_owned());
        }
    }
}

fn face(name: &str) -> Option<Face> {
    let names = ["FrontWheel", "LeftWheel", "RightWheel", "BackPlate"];
    names.iter().position(|known| *known == name).map(|number| Face::ALL[number])
}

fn name<'a>(node: Node<'a, 'a>) -> Result<&'a str, ImportFault> {
    let name = node.attribute("name").filter(|name| !name.is_empty());
    name.ok_or_else(|| ImportFault::at_node(node, "a module without a name"))
}

/// Returns the pose of a chassis, which is that of its back plate.
fn pose(node: Node) -> Result<Pose, ImportFault> {
    let (at, turn) = (xml::child(node, "position")?, xml::child(node, "rotation")?);
    let [x, y, z] = ["x", "y", "z"].map(|axis| xml::number(at, axis));
    let p = Vec3::new(x?, z?, y?) * PITCH;
    let [w, x, y, z] = ["w", "x", "y", "z"].map(|axis| xml::number(turn, axis));
    // y and z change places, which turns a rotation round.
    let q = nalgebra::Quaternion::new(w?, -x?, -z?, -y?);
    if (q.norm() - 1.0).abs() > 1e-2 {
        return Err(ImportFault::at_node(turn, "the orientation is no unit quaternion"));
    }
    let turn =
        Pose::from_parts(nalgebra::Translation3::identity(), nalgebra::UnitQuaternion::new_normalize(q));
    Ok(shifted(p) * turn * turned(Vec3::x(), -FRAC_PI_2))
}

/// A command for a joint, by the library's sign.
struct Command {
    /// True if it is a speed.
    speed: bool,
    /// A position, rad, or a speed, rad/s.
    value: f64,
    /// The time that it takes, s.
    period: f64,
}

/// Returns the commands of a module with their joints.
fn commands(node: Node) -> Result<Vec<(usize, Command)>, ImportFault> {
    let mut all: Vec<(usize, Command)> = Vec::new();
    for command in xml::children(xml::child(node, "JointCommands")?, "JointCommand")? {
        let name = command.attribute("name").unwrap_or("");
        let Some(joint) = JOINTS.iter().position(|(known, _)| *known == name) else {
            return Err(ImportFault::at_node(command, format!("`{name}` is no joint of a module")));
        };
        if all.iter().any(|(known, _)| *known == joint) {
            return Err(ImportFault::at_node(command, format!("two commands for `{name}`")));
        }
        let speed = match xml::text(command, "commandType")? {
            "Position" => false,
            "Velocity" => true,
            "Torque" => {
                let message =
                    "a torque: a joint of modl takes positions and speeds, and a plan proves their torques";
                return Err(ImportFault::at_node(command, message));
            }
            other => return Err(ImportFault::at_node(command, format!("`{other}` is no kind of command"))),
        };
        let value = xml::number(command, "targetValue")?;
        let period = period(command)?;
        if value.abs() > 1e6 {
            return Err(ImportFault::at_node(command, format!("{value} is out of any range")));
        }
        let value = (value * JOINTS[joint].1).to_radians();
        if let Some(message) = tilt_fault(value).filter(|_| joint == 3 && !speed) {
            return Err(ImportFault::at_node(command, message));
        }
        all.push((joint, Command { speed, value, period }));
    }
    Ok(all)
}

fn period(node: Node) -> Result<f64, ImportFault> {
    let period = xml::number(node, "period")?;
    if (0.0..=86_400.0).contains(&period) {
        return Ok(period);
    }
    Err(ImportFault::at_node(node, format!("a period of {period}: seconds of at most a day are wanted")))
}

/// Returns the actions of a behaviour, in their order.
pub(super) fn read_behavior(document: &Document, robot: &mut Robot) -> Result<Graph<Action>, ImportFault> {
    let root = document.root_element();
    if !root.has_tag_name("Behavior") {
        let found = root.tag_name().name();
        return Err(ImportFault::at_node(root, format!("`<Behavior>` is wanted, and this is `<{found}>`")));
    }
    let names: BTreeMap<String, usize> =
        robot.members.iter().enumerate().map(|(index, member)| (member.name.clone(), index)).collect();
    let mut states: Vec<[f64; 4]> = robot.members.iter().map(|member| member.state).collect();
    let mut parameters = Vec::new();
    let mut rows = Vec::new();
    let mut count = 0;
    for row in xml::children(xml::child(root, "RobotStates")?, "RobotState")? {
        let whole = period(row)?;
        let (mut actions, mut longest) = (Vec::new(), 0.0f64);
        for node in xml::children(xml::child(row, "ModuleStates")?, "ModuleState")? {
            let name = name(node)?;
            let Some(&module) = names.get(name) else {
                return Err(ImportFault::at_node(node, format!("the configuration has no module `{name}`")));
            };
            parameters.extend(node.descendants().filter_map(parameter));
            for (joint, command) in commands(node)? {
                let own = action(module, joint, &command, &mut states[module]);
                if let Some(own) = own {
                    robot.note_tilt(name, states[module][3]);
                    longest = longest.max(command.period);
                    actions.push(Graph::One(own));
                }
            }
        }
        if whole > longest + 1e-9 {
            actions.push(Graph::One(Action::Wait(whole)));
        }
        count += actions.len();
        if count > COMMANDS_MAX {
            return Err(ImportFault::at_node(row, format!("more than {COMMANDS_MAX} commands")));
        }
        rows.push(Graph::Parallel(actions));
    }
    if rows.is_empty() {
        return Err(ImportFault::at_node(root, "there are no states"));
    }
    parameters.sort();
    parameters.dedup();
    if !parameters.is_empty() {
        let names = parameters.join("`, `");
        robot.notes.push(format!("the parameters `{names}` have the values that the file states"));
    }
    Ok(Graph::Series(rows))
}

/// Returns the name of a parameter that an element states.
fn parameter(node: Node) -> Option<String> {
    let text = node.has_tag_name("parametricValue").then(|| node.text())??.trim();
    (!text.is_empty() && text.parse::<f64>().is_err()).then(|| text.to_owned())
}

/// Returns what a command does to a joint, if anything.
fn action(module: usize, joint: usize, command: &Command, state: &mut [f64; 4]) -> Option<Action> {
    let before = state[joint];
    if command.speed {
        state[joint] += command.value * command.period;
        let still = command.value == 0.0 || command.period == 0.0;
        let spin = Action::Spin { module, joint, speed: command.value, time: command.period };
        return (!still).then_some(spin);
    }
    // A wheel takes the shorter way round.
    let turn = std::f64::consts::TAU;
    let to = if joint == 3 {
        command.value
    } else {
        command.value + turn * libm::round((before - command.value) / turn)
    };
    state[joint] = to;
    let time = Some(command.period).filter(|period| *period > 0.0);
    ((to - before).abs() > 1e-9).then_some(Action::Move { module, joint, to, time })
}
