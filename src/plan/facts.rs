//! The facts of a library that a verdict rests on: a line for each declaration, and every difference of a declaration
//! from another one.
//!
//! The judge believes the library of a plan as far as it is sound. A reader of the facts can tell if it is that of
//! the robots in the laboratory.

use super::file::digest;
use super::tolerances::TOLERANCES;
use crate::robot::{Cell, Joint, JointKind, Library, Limits, ModuleType, Servo, Strut};
use crate::units::{Dimension, counted, number, quantity};
use serde::Serialize;
use serde_json::Value;

/// The number of digits of a hash that are shown: enough to tell files apart that people compare.
const DIGITS: usize = 12;

/// A declaration of a library in a few words: kind, name, limits and digest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Facts {
    /// The kind of declaration: `module`, `cell` or `strut`.
    pub kind: &'static str,
    /// The declared name, with its arguments where they differ from the defaults.
    pub name: String,
    /// The masses, tolerances and limits of the declaration in words, with units.
    pub words: String,
    /// The first twelve hexadecimal digits of the SHA-256 of all that the file states of the declaration, its
    /// connectors included.
    pub digest: String,
}

/// A declaration of a library, by its index among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declared {
    /// A module type, by its index in [`Library::modules`].
    Module(usize),
    /// A type of cells, by its index in [`Library::cells`].
    Cell(usize),
    /// A type of struts, by its index in [`Library::struts`].
    Strut(usize),
}

/// Returns all declarations but connectors, which are facts of the modules that have them: modules, cells, struts,
/// each kind ascending by index.
pub fn declarations(library: &Library) -> Vec<Declared> {
    let modules = (0..library.modules.len()).map(Declared::Module);
    let cells = (0..library.cells.len()).map(Declared::Cell);
    modules.chain(cells).chain((0..library.struts.len()).map(Declared::Strut)).collect()
}

/// Returns the facts of a declaration. `declared`: the kind and index of the declaration. Panics if the library has
/// none of this index.
pub fn facts(library: &Library, declared: Declared) -> Facts {
    let (kind, words) = match declared {
        Declared::Module(index) => ("module", of_module(&library.modules[index])),
        Declared::Cell(index) => ("cell", of_cell(&library.cells[index])),
        Declared::Strut(index) => ("strut", of_strut(&library.struts[index])),
    };
    let mut digest = digest(&whole(library, declared).to_string());
    digest.truncate(DIGITS);
    Facts { kind, name: name(library, declared).to_owned(), words, digest }
}

/// Returns the name of a declaration, which shows the arguments that differ from the defaults. `declared`: the kind
/// and index of the declaration. Panics if the library has none of this index.
pub fn name(library: &Library, declared: Declared) -> &str {
    match declared {
        Declared::Module(index) => &library.modules[index].name,
        Declared::Cell(index) => &library.cells[index].name,
        Declared::Strut(index) => &library.struts[index].name,
    }
}

fn of_module(module: &ModuleType) -> String {
    let mass: f64 = module.links.iter().map(|link| link.mass).sum();
    let metres = |x: f64| quantity(x, Dimension::LENGTH);
    let mut words = vec![
        format!("{} in {}", quantity(mass, Dimension::MASS), counted(module.links.len(), "link")),
        format!("touch {}", metres(module.touch)),
        format!("contact {}", metres(module.contact)),
    ];
    let open = module.links.iter().filter(|link| link.left_out > 0.0);
    words.extend(open.map(|link| {
        format!("{} is drawn up to {} outside of what is judged", link.name, metres(link.left_out))
    }));
    words.extend(module.joints.iter().filter(|joint| joint.kind != JointKind::Fixed).map(of_joint));
    words.join(", ")
}

fn of_joint(joint: &Joint) -> String {
    if joint.mimic.is_some() {
        return format!("{} follows", joint.name);
    }
    let Limits { range, speed, acceleration, effort } = joint.limits;
    let (position, rate, change, load) = match joint.kind {
        JointKind::Prismatic => {
            (Dimension::LENGTH, Dimension::SPEED, Dimension::ACCELERATION, Dimension::FORCE)
        }
        JointKind::Revolute | JointKind::Fixed => {
            (Dimension::ANGLE, Dimension::ANGULAR_SPEED, Dimension::ANGULAR_ACCELERATION, Dimension::TORQUE)
        }
    };
    let range = range.map(|(low, high)| format!("{}..{}", quantity(low, position), quantity(high, position)));
    let stated = |limit: Option<f64>, dimension, what: &str| {
        limit.map_or_else(|| format!("no limit of {what}"), |limit| quantity(limit, dimension))
    };
    let range = range.unwrap_or_else(|| "no range".to_owned());
    let (speed, effort) = (stated(speed, rate, "speed"), stated(effort, load, "load"));
    // Few modules state it: it is left out where there is none.
    let acceleration =
        acceleration.map_or_else(String::new, |limit| format!("{}, ", quantity(limit, change)));
    let servo = of_servo(&joint.servo, joint.kind == JointKind::Prismatic);
    format!("{} [{range}, {speed}, {acceleration}{effort}{servo}]", joint.name)
}

/// Returns what is stated of a servo in words, each fact after a comma; `slides`: that of a joint that slides.
fn of_servo(servo: &Servo, slides: bool) -> String {
    let (stiffness, inertia) = if slides { ("N/m", "kg") } else { ("N*m/rad", "kg*m^2") };
    let (damping, rate) = if slides { ("N*s/m", "m/s") } else { ("N*m*s/rad", "rad/s") };
    let stated = [
        (servo.stiffness, "", stiffness),
        (servo.armature, "", inertia),
        (servo.damping, "", damping),
        (servo.no_load_speed, "no load at ", rate),
    ];
    let words = stated
        .into_iter()
        .filter_map(|(value, what, unit)| Some(format!(", {what}{}{unit}", number(value?))));
    words.collect()
}

fn of_cell(cell: &Cell) -> String {
    let metres = |x: f64| quantity(x, Dimension::LENGTH);
    format!(
        "{}, {} down to {}, {}, {}{}",
        quantity(cell.mass, Dimension::MASS),
        metres(cell.size),
        metres(cell.shrinks_to),
        quantity(cell.force, Dimension::FORCE),
        quantity(cell.speed, Dimension::SPEED),
        if cell.slides { "" } else { ", does not slide" }
    )
}

fn of_strut(strut: &Strut) -> String {
    let metres = |x: f64| quantity(x, Dimension::LENGTH);
    let told = |name: &str, value: Option<f64>, dimension: Dimension| {
        value.map_or_else(String::new, |value| format!(", {name} {}", quantity(value, dimension)))
    };
    format!(
        "{}, {}..{}, {}, {}, clearance {}{}{}{}",
        quantity(strut.mass, Dimension::MASS),
        metres(strut.length.0),
        metres(strut.length.1),
        quantity(strut.force, Dimension::FORCE),
        quantity(strut.speed, Dimension::SPEED),
        metres(strut.clearance),
        told("max_accel", strut.acceleration, Dimension::ACCELERATION),
        told("buckling", strut.buckling, Dimension::FORCE),
        told("node_mass", strut.node_mass, Dimension::MASS)
    )
}

/// Returns all that a library states of a declaration, with connectors in place of their indices.
fn whole(library: &Library, declared: Declared) -> Value {
    let value = match declared {
        Declared::Module(index) => serde_json::to_value(&library.modules[index]),
        Declared::Cell(index) => serde_json::to_value(&library.cells[index]),
        Declared::Strut(index) => serde_json::to_value(&library.struts[index]),
    };
    let mut value = value.expect("a library is plain data");
    let ports = value.get_mut("ports").and_then(Value::as_array_mut);
    for port in ports.into_iter().flatten() {
        let index = port["connector"].as_u64().and_then(|index| usize::try_from(index).ok());
        if let Some(index) = index {
            port["connector"] = connector(library, index);
        }
    }
    value
}

fn connector(library: &Library, index: usize) -> Value {
    let Some(connector) = library.connectors.get(index) else { return Value::Null };
    let mut value = serde_json::to_value(connector).expect("a library is plain data");
    let mates = connector.mates.iter().filter_map(|&mate| Some(library.connectors.get(mate)?.name.clone()));
    value["mates"] = mates.collect::<Vec<_>>().into();
    value
}

/// Returns the differences of a declaration from one of another library, one line each: `links.body.mass is 2, there
/// 1`. Numbers are in SI units, and equal within the fraction `tolerance` of the larger, on top of rounding. Names
/// of the declarations themselves are not compared. Panics if a library has no declaration of its index.
pub fn differences(
    (library, declared): (&Library, Declared),
    (other, counterpart): (&Library, Declared),
    tolerance: f64,
) -> Vec<String> {
    let (mut here, mut there) = (whole(library, declared), whole(other, counterpart));
    here["name"] = Value::Null;
    there["name"] = Value::Null;
    let mut found = Vec::new();
    compare("", &here, &there, tolerance + TOLERANCES.equal_facts, &mut found);
    found
}

fn compare(path: &str, here: &Value, there: &Value, tolerance: f64, found: &mut Vec<String>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (here, there) {
        (Value::Object(a), Value::Object(b)) => {
            let added = b.keys().filter(|key| !a.contains_key(*key));
            for key in a.keys().chain(added) {
                let of = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or_default();
                compare(&below(key), &of(a), &of(b), tolerance, found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                let name = a.get("name").and_then(Value::as_str).map_or(index.to_string(), str::to_owned);
                compare(&below(&name), a, b, tolerance, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            found.push(format!("{path} has {} entries, there {}", a.len(), b.len()));
        }
        (Value::Number(a), Value::Number(b)) if equal(a.as_f64(), b.as_f64(), tolerance) => {}
        (a, b) if a == b => {}
        (a, b) => found.push(format!("{path} is {}, there {}", short(a), short(b))),
    }
}

fn equal(a: Option<f64>, b: Option<f64>, tolerance: f64) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return false };
    (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(tolerance)
}

/// Returns a value in a few words: a list by its length only, an object as `stated`.
fn short(value: &Value) -> String {
    match value {
        Value::Null => "not stated".to_owned(),
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "stated".to_owned(),
        other => other.to_string(),
    }
}
