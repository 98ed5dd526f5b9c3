//! The program that declares an imported configuration with its behaviours.

use super::super::module_text::{Imported, name_of, number, type_name};
use super::configuration::PITCH;
use super::order::Graph;
use super::parts::{Action, Face, JOINTS, Motion, Robot};
use std::collections::BTreeSet;

/// The steps to which angles are rounded, in degrees, with the distance within which they are, rad: files state a quarter turn as
/// 1.5708, and other whole degrees with seven digits.
const STEPS: [(f64, f64); 3] = [(15.0, 5e-6), (1.0, 1e-7), (1e-3, 1e-10)];

/// Returns the program of a robot with its motions. `file`: the name of the robot's file.
pub(super) fn write(file: &str, robot: &mut Robot, motions: &[Motion]) -> Imported {
    let plain = |text: &str| text.replace(char::is_control, " ");
    let config = type_name(stem(file));
    let module = module_type(robot);
    let mut taken = BTreeSet::from([module.to_lowercase()]);
    let names: Vec<String> =
        robot.members.iter().map(|member| name_of(&member.name, "m", &mut taken)).collect();
    let closed = if robot.bonds.len() >= robot.members.len() { " closed" } else { "" };
    let mut text = format!("//! {config}: the robot of `{}`.\nuse std.smores.{module}\n\n", plain(file));
    text.push_str(&format!("/// The robot of `{}`.\nconfig {config}{closed} {{\n", plain(file)));
    for (member, name) in robot.members.iter().zip(&names) {
        let original = plain(&member.name);
        let comment =
            if original.to_lowercase() == *name { String::new() } else { format!("  // `{original}`") };
        text.push_str(&format!("  part {name}: {module}{comment}\n"));
    }
    text.push('\n');
    let port = |(member, face): (usize, Face)| format!("{}.{}", names[member], face.port());
    for bond in &robot.bonds {
        let turn =
            if bond.turn == 0 { String::new() } else { format!(" turn {}deg", u16::from(bond.turn) * 90) };
        text.push_str(&format!("  connect {} -- {}{turn}\n", port(bond.ends[0]), port(bond.ends[1])));
    }
    for (member, name) in robot.members.iter().zip(&names) {
        for (position, joint) in member.state.iter().zip(JOINTS).filter(|(position, _)| **position != 0.0) {
            text.push_str(&format!("  set {name}.{joint} = {}\n", angle(*position, "")));
        }
    }
    let base = robot.upright();
    if base.is_none() {
        let first = &robot.members[0].name;
        robot
            .notes
            .push(format!("the file places no module upright: the robot is drawn with `{first}` upright"));
    }
    text.push_str(&format!("  base {}\n", names[base.unwrap_or(0)]));
    for motion in motions {
        let name = name_of(stem(&motion.file), "gait", &mut taken);
        let body = match body(&motion.graph, &names) {
            Some(body) => lines(&body, 2),
            None => "wait(0s)".to_owned(),
        };
        let source = plain(&motion.file);
        text.push_str(&format!("\n  /// The commands of `{source}`.\n  behavior {name} = {body}\n"));
    }
    text.push_str("}\n");
    Imported { what: "config", module: config, text, notes: robot.notes.clone() }
}

/// Returns the library's module for a robot; tells where it had to be another than the file's.
fn module_type(robot: &mut Robot) -> &'static str {
    if robot.pitch == PITCH {
        return "Smores";
    }
    match &robot.wide {
        None => "SmoresEP",
        Some(name) => {
            let note =
                format!("`{name}` tilts beyond the 80° of `SmoresEP`: the modules are `Smores`, of 100 mm");
            robot.notes.push(note);
            "Smores"
        }
    }
}

/// Returns a file's name without folder and ending.
fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| if stem.is_empty() { name } else { stem })
}

/// A call of a behaviour: one line, or a group of calls.
enum Call {
    Line(String),
    Group(&'static str, Vec<Call>),
}

/// Returns the calls of a graph; groups of one are that one, groups of nothing are none.
fn body(graph: &Graph<Action>, names: &[String]) -> Option<Call> {
    let (group, parts) = match graph {
        Graph::One(action) => return Some(Call::Line(call(action, names))),
        Graph::Series(parts) => ("Sc", parts),
        Graph::Parallel(parts) => ("Pc", parts),
    };
    let mut calls = Vec::new();
    for call in parts.iter().filter_map(|part| body(part, names)) {
        match call {
            Call::Group(inner, more) if inner == group => calls.extend(more),
            call => calls.push(call),
        }
    }
    match calls.len() {
        0 => None,
        1 => calls.pop(),
        _ => Some(Call::Group(group, calls)),
    }
}

/// Returns a call over lines; `indent`: the blanks before the line that it begins on.
fn lines(call: &Call, indent: usize) -> String {
    match call {
        Call::Line(line) => line.clone(),
        Call::Group(group, calls) => {
            let blanks = " ".repeat(indent);
            let inner: String =
                calls.iter().map(|call| format!("{blanks}  {},\n", lines(call, indent + 2))).collect();
            format!("{group}(\n{inner}{blanks})")
        }
    }
}

fn call(action: &Action, names: &[String]) -> String {
    let joint = |module: &usize, joint: &usize| format!("{}.{}", names[*module], JOINTS[*joint]);
    let port = |(module, face): &(usize, Face)| format!("{}.{}", names[*module], face.port());
    match action {
        Action::Move { module, joint: own, to, time } => {
            let time = time.map_or(String::new(), |time| format!(", in: {}s", number(time)));
            format!("move({}, to: {}{time})", joint(module, own), angle(*to, ""))
        }
        Action::Spin { module, joint: own, speed, time } => {
            format!("spin({}, {}, for: {}s)", joint(module, own), angle(*speed, "/s"), number(*time))
        }
        Action::Wait(time) => format!("wait({}s)", number(*time)),
        Action::Dock([a, b]) => format!("dock({}, {})", port(a), port(b)),
        Action::Undock(end) => format!("undock({})", port(end)),
    }
}

/// Returns an angle in degrees if it is one of few digits, else in radians.
fn angle(x: f64, per: &str) -> String {
    for (step, near) in STEPS {
        let steps = libm::round(x.to_degrees() / step);
        // A thousandth is no number, but a thousand is.
        let round = if step < 1.0 { steps / libm::round(1.0 / step) } else { steps * step };
        if (round.to_radians() - x).abs() < near {
            return format!("{}deg{per}", number(round));
        }
    }
    format!("{}rad{per}", number(x))
}
