//! RoFI's JSON format of configurations ("configuration 2.0"): `modules`, `moduleJoints`, `spaceJoints`.
//!
//! The frames of its shoes are those of the text format turned by half a turn about z. So its docks +X
//! and -X have each other's names there: what is `A+X` here is `-X` of shoe A in the text format. Docks
//! -Z, orientations and angles are the same.

use super::rofi::{Dock, Edge, Face, FileError, Module, Reader, Side, World};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

/// The docks of a universal module, in the order of their numbers in the format.
const CONNECTORS: [(&str, Side, Face); 6] = [
    ("A-X", Side::A, Face::PlusX),
    ("A+X", Side::A, Face::MinusX),
    ("A-Z", Side::A, Face::MinusZ),
    ("B-X", Side::B, Face::PlusX),
    ("B+X", Side::B, Face::MinusX),
    ("B-Z", Side::B, Face::MinusZ),
];

const ORIENTATIONS: [&str; 4] = ["North", "East", "South", "West"];

/// The component of a universal module that is its shoe A.
const SHOE_A: u32 = 6;

#[derive(Deserialize)]
struct Configuration<'t> {
    #[serde(borrow)]
    modules: Vec<&'t RawValue>,
    #[serde(borrow, default, rename = "moduleJoints")]
    joints: Vec<&'t RawValue>,
}

#[derive(Serialize, Deserialize)]
struct Universal {
    id: u64,
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    alpha: f64,
    #[serde(default)]
    beta: f64,
    #[serde(default)]
    gamma: f64,
}

#[derive(Serialize, Deserialize)]
struct Connection {
    from: End,
    to: End,
    orientation: String,
}

#[derive(Serialize, Deserialize)]
struct End {
    id: u64,
    connector: Connector,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Connector {
    Name(String),
    Number(usize),
}

#[derive(Serialize)]
struct Written {
    modules: Vec<Universal>,
    #[serde(rename = "moduleJoints")]
    joints: Vec<Connection>,
    #[serde(rename = "spaceJoints")]
    space: Vec<SpaceJoint>,
}

/// The joint between the first module and space.
#[derive(Serialize)]
struct SpaceJoint {
    point: [f64; 3],
    joint: RigidJoint,
    to: Component,
}

#[derive(Serialize)]
struct RigidJoint {
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(rename = "sourceToDestination")]
    pose: &'static str,
    positions: [f64; 0],
}

#[derive(Serialize)]
struct Component {
    id: u64,
    component: u32,
}

/// Reads the one configuration of a text in RoFI's JSON format: an object, or a list of one. Its pose in space is not
/// read; angles (degrees) that are left out are 0.
///
/// # Errors
/// [`FileError`] at the first piece that does not follow the format, for a module of another type, for a second
/// connection of a dock, for a sequence of configurations, and for a text without modules.
pub fn read(text: &str) -> Result<World, FileError> {
    let locator = Locator { text };
    let one: Vec<&RawValue> =
        if text.trim_start().starts_with('[') { locator.parsed(text)? } else { vec![locator.parsed(text)?] };
    let [raw] = one[..] else {
        let what = format!("{} configurations: the file is a sequence, not one robot", one.len());
        return Err(locator.at(text, what));
    };
    let configuration: Configuration = locator.parsed(raw.get())?;
    let mut reader = Reader::default();
    for raw in configuration.modules {
        let module: Universal = locator.parsed(raw.get())?;
        if module.kind != "universal" {
            let what = format!("a module of type `{}`: only `universal` is known", module.kind);
            return Err(locator.at(raw.get(), what));
        }
        let joints = [module.alpha, module.beta, module.gamma];
        let line = locator.position(raw.get()).0;
        reader
            .add_module(Module { id: module.id, joints, line })
            .map_err(|what| locator.at(raw.get(), what))?;
    }
    for raw in configuration.joints {
        let connection: Connection = locator.parsed(raw.get())?;
        let edge = edge(&reader, &connection, locator.position(raw.get()).0)
            .and_then(|edge| reader.add_edge(edge).map_err(|(_, what)| what));
        edge.map_err(|what| locator.at(raw.get(), what))?;
    }
    reader.finish()
}

fn edge(reader: &Reader, connection: &Connection, line: usize) -> Result<Edge, String> {
    let orientation = &connection.orientation;
    let turn = ORIENTATIONS
        .iter()
        .position(|name| name == orientation || name[..1] == **orientation)
        .ok_or_else(|| format!("`{orientation}` is no orientation: {} are", ORIENTATIONS.join(", ")))?;
    let dock = |end: &End| {
        let module = reader.index(end.id).ok_or_else(|| format!("there is no module {}", end.id))?;
        let known = match &end.connector {
            Connector::Name(name) => CONNECTORS.iter().find(|(known, ..)| known == name),
            Connector::Number(number) => CONNECTORS.get(*number),
        };
        let names = || CONNECTORS.map(|(name, ..)| name).join(", ");
        let (_, side, face) = known.ok_or_else(|| format!("no such connector: {} are", names()))?;
        Ok::<Dock, String>(Dock { module, side: *side, face: *face })
    };
    Ok(Edge { a: dock(&connection.from)?, b: dock(&connection.to)?, turn: turn as u32, line })
}

/// Returns a configuration in RoFI's JSON format, in which shoe A of the first module is fixed at the origin. A
/// configuration as [`read`] returns it reads back to the same but for the line numbers. Panics if a connection has an
/// index that is not a module.
pub fn write(world: &World) -> String {
    let module = |m: &Module| {
        let [alpha, beta, gamma] = m.joints;
        Universal { id: m.id, kind: "universal".into(), alpha, beta, gamma }
    };
    let end = |dock: &Dock| {
        let named = CONNECTORS.iter().find(|(_, side, face)| (*side, *face) == (dock.side, dock.face));
        let name = named.map_or("", |(name, ..)| name);
        End { id: world.modules[dock.module].id, connector: Connector::Name(name.into()) }
    };
    let connection = |edge: &Edge| Connection {
        from: end(&edge.a),
        to: end(&edge.b),
        orientation: ORIENTATIONS[edge.turn as usize % ORIENTATIONS.len()].into(),
    };
    let space = world.modules.first().map(|first| SpaceJoint {
        point: [0.0; 3],
        joint: RigidJoint { kind: "rigid", pose: "identity", positions: [] },
        to: Component { id: first.id, component: SHOE_A },
    });
    let written = Written {
        modules: world.modules.iter().map(module).collect(),
        joints: world.edges.iter().map(connection).collect(),
        space: space.into_iter().collect(),
    };
    let mut text = serde_json::to_string_pretty(&written).expect("numbers and names are JSON");
    text.push('\n');
    text
}

/// A text, to find the positions of its pieces.
#[derive(Clone, Copy)]
struct Locator<'t> {
    text: &'t str,
}

impl<'t> Locator<'t> {
    fn parsed<T: Deserialize<'t>>(&self, piece: &'t str) -> Result<T, FileError> {
        serde_json::from_str(piece).map_err(|error| {
            let (line, column) = self.position(piece);
            let within = error.line().max(1);
            let column = if within == 1 { column + error.column().max(1) - 1 } else { error.column().max(1) };
            let what = error.to_string();
            let what = what.rsplit_once(" at line ").map_or(what.as_str(), |(what, _)| what).to_owned();
            FileError { line: line + within - 1, column, what }
        })
    }

    fn at(&self, piece: &str, what: impl Into<String>) -> FileError {
        let (line, column) = self.position(piece);
        FileError { line, column, what: what.into() }
    }

    /// Returns the line and column, from 1, of the beginning of a piece of the text.
    fn position(&self, piece: &str) -> (usize, usize) {
        let before = &self.text[..piece.as_ptr() as usize - self.text.as_ptr() as usize];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |rest| rest.chars().count()) + 1;
        (line, column)
    }
}
