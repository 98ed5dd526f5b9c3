//! RoFI's text format of configurations: modules with the positions of their joints, and connections.
//!
//! One thing a line: `C` begins a configuration, `M id alpha beta gamma` (degrees) is a module,
//! `E id side dock orientation dock side id` a connection of two docks. Sides are `A` and `B`, docks
//! `+X`, `-X` and `-Z` of a side's shoe, orientations `N`, `E`, `S`, `W`: quarter turns.

use std::collections::HashMap;
use std::fmt::{self, Write};

/// A configuration of universal modules of the RoFI platform, as a file states it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct World {
    /// The modules ascending by their ids; edges name them by their indices here, from 0.
    pub modules: Vec<Module>,
    /// The connections in the order of the file, each once.
    pub edges: Vec<Edge>,
}

/// A universal module and its joint positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// The id of the module in the file; ids may have gaps.
    pub id: u64,
    /// The positions of the joints alpha, beta and gamma, in this order, in degrees, as files have them.
    pub joints: [f64; 3],
    /// The line of the file that states the module, from 1; 0 if there is none.
    pub line: usize,
}

/// A connection: two docks that hold each other at a quarter turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// The dock that the file names first.
    pub a: Dock,
    /// The dock that the file names second.
    pub b: Dock,
    /// The turn about the common normal in quarter turns: 0 is north (N), 1 east (E), 2 south (S), 3 west (W).
    pub turn: u32,
    /// The line of the file that states the connection, from 1; 0 if there is none.
    pub line: usize,
}

/// A dock of a module by its shoe and face: one of six, at which modules are connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dock {
    /// The index of the module in [`World::modules`].
    pub module: usize,
    /// The shoe that carries the dock.
    pub side: Side,
    /// The face of that shoe which carries the dock.
    pub face: Face,
}

/// One of the two shoes of a universal module, the bodies at its ends, which carry three docks each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The shoe A, whose frame is that of the module.
    A,
    /// The shoe B, which the joints turn against shoe A.
    B,
}

/// A face of a shoe that carries a dock, by its direction in the shoe's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// The face on the +x side of the shoe.
    PlusX,
    /// The face on the -x side of the shoe.
    MinusX,
    /// The face on the -z side, at the end of the shoe.
    MinusZ,
}

/// The first error in a file, with its position.
#[derive(Clone, Debug, PartialEq)]
pub struct FileError {
    /// The line of the error, from 1.
    pub line: usize,
    /// The column of the error in characters, from 1.
    pub column: usize,
    /// The error as a message in words.
    pub what: String,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.what)
    }
}

impl std::error::Error for FileError {}

const SIDES: [(&str, Side); 2] = [("A", Side::A), ("B", Side::B)];
const FACES: [(&str, Face); 3] = [("+X", Face::PlusX), ("-X", Face::MinusX), ("-Z", Face::MinusZ)];
const TURNS: [&str; 4] = ["N", "E", "S", "W"];

impl Dock {
    /// Returns the name of the dock's port in the library's module, such as `a_plus_x`.
    pub fn port(&self) -> &'static str {
        match (self.side, self.face) {
            (Side::A, Face::PlusX) => "a_plus_x",
            (Side::A, Face::MinusX) => "a_minus_x",
            (Side::A, Face::MinusZ) => "a_minus_z",
            (Side::B, Face::PlusX) => "b_plus_x",
            (Side::B, Face::MinusX) => "b_minus_x",
            (Side::B, Face::MinusZ) => "b_minus_z",
        }
    }

    /// Returns the dock with this port name of the module of an index; `None` for a name that is none of the six.
    pub fn of_port(module: usize, port: &str) -> Option<Dock> {
        let all = SIDES.iter().flat_map(|(_, side)| FACES.iter().map(move |(_, face)| (*side, *face)));
        all.map(|(side, face)| Dock { module, side, face }).find(|dock| dock.port() == port)
    }
}

/// Reads the one configuration of a text in RoFI's text format, in which every line is `C`, `M id alpha beta gamma`
/// (degrees) or `E id side dock orientation dock side id`. Lines that begin with `#` are comments.
///
/// # Errors
/// [`FileError`] at the first word that does not follow the format, for a second connection of a dock, for a sequence
/// of configurations, and for a text without modules.
pub fn read(text: &str) -> Result<World, FileError> {
    let mut reader = Reader::default();
    for (index, line) in text.lines().enumerate() {
        let words = Words::new(index + 1, line);
        match words.words.first().map(|(_, word)| *word) {
            None => {}
            Some(word) if word.starts_with('#') => {}
            Some("C") if reader.begun => {
                return Err(words.fault(0, "a second configuration: the file is a sequence, not one robot"));
            }
            Some("C") => reader.begun = true,
            Some(_) if !reader.begun => return Err(words.fault(0, "a file begins with a line `C`")),
            Some("M") => reader.module(&words)?,
            Some("E") => reader.edge(&words)?,
            Some(other) => {
                return Err(words.fault(0, format!("`{other}` is none of `C`, `M` and `E`")));
            }
        }
    }
    reader.finish()
}

/// Returns a configuration in RoFI's text format. A configuration as [`read`] returns it reads back to the same but
/// for the line numbers. Panics if a connection has an index that is not a module.
pub fn write(world: &World) -> String {
    let mut text = String::from("C\n");
    for Module { id, joints: [alpha, beta, gamma], .. } in &world.modules {
        let _ = writeln!(text, "M {id} {alpha} {beta} {gamma}");
    }
    for Edge { a, b, turn, .. } in &world.edges {
        let (id_a, id_b) = (world.modules[a.module].id, world.modules[b.module].id);
        let [side_a, side_b] = [a, b].map(|dock| name_of(&SIDES, dock.side));
        let [face_a, face_b] = [a, b].map(|dock| name_of(&FACES, dock.face));
        let turn = TURNS[*turn as usize % TURNS.len()];
        let _ = writeln!(text, "E {id_a} {side_a} {face_a} {turn} {face_b} {side_b} {id_b}");
    }
    text
}

fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: T) -> &'static str {
    names.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

/// The modules and connections that a reader of any of RoFI's formats has read so far.
#[derive(Default)]
pub(super) struct Reader {
    begun: bool,
    modules: Vec<Module>,
    /// The index in `modules` of each id.
    indices: HashMap<u64, usize>,
    edges: Vec<Edge>,
    /// The edge at each dock.
    taken: HashMap<Dock, usize>,
}

impl Reader {
    fn module(&mut self, words: &Words) -> Result<(), FileError> {
        let id = words.id(1)?;
        let mut joints = [0.0; 3];
        for (k, joint) in joints.iter_mut().enumerate() {
            *joint = words.number(2 + k)?;
        }
        self.add_module(Module { id, joints, line: words.line }).map_err(|what| words.fault(1, what))
    }

    /// Adds a module, which gets the next index.
    ///
    /// # Errors
    /// A message in words, if there is a module of its id already.
    pub(super) fn add_module(&mut self, module: Module) -> Result<(), String> {
        if self.indices.insert(module.id, self.modules.len()).is_some() {
            return Err(format!("a second module {}", module.id));
        }
        self.modules.push(module);
        Ok(())
    }

    /// Returns the index, from 0 in the order of reading, of the module of an id; `None` if there is none.
    pub(super) fn index(&self, id: u64) -> Option<usize> {
        self.indices.get(&id).copied()
    }

    fn edge(&mut self, words: &Words) -> Result<(), FileError> {
        let a = self.dock(words, (1, 2, 3))?;
        let turn = words.one_of(4, &TURNS, "an orientation")?;
        let b = self.dock(words, (7, 6, 5))?;
        let edge = Edge { a, b, turn: turn as u32, line: words.line };
        self.add_edge(edge).map_err(|(end, what)| words.fault([1, 7][end], what))
    }

    /// Adds a connection of modules given by their indices in the order of reading. The same connection a second time
    /// is ignored.
    ///
    /// # Errors
    /// (end, message): the end that is wrong, 0 for `a` or 1 for `b`, and the reason in words.
    pub(super) fn add_edge(&mut self, edge: Edge) -> Result<(), (usize, String)> {
        let Edge { a, b, .. } = edge;
        for (end, dock) in [a, b].into_iter().enumerate() {
            if let Some(&other) = self.taken.get(&dock) {
                let known = &self.edges[other];
                // The same connection stated twice is no harm.
                if known.turn == edge.turn && [(known.a, known.b), (known.b, known.a)].contains(&(a, b)) {
                    return Ok(());
                }
                return Err((end, format!("this dock was connected in line {}", known.line)));
            }
        }
        if a == b {
            return Err((0, "a dock can't hold itself".into()));
        }
        self.taken.extend([(a, self.edges.len()), (b, self.edges.len())]);
        self.edges.push(edge);
        Ok(())
    }

    fn dock(&self, words: &Words, (id, side, face): (usize, usize, usize)) -> Result<Dock, FileError> {
        let number = words.id(id)?;
        let Some(&module) = self.indices.get(&number) else {
            return Err(words.fault(id, format!("no module {number} stands above")));
        };
        let side = SIDES[words.one_of(side, &SIDES.map(|(name, _)| name), "a side")?].1;
        let face = FACES[words.one_of(face, &FACES.map(|(name, _)| name), "a dock")?].1;
        Ok(Dock { module, side, face })
    }

    /// Returns the configuration, with modules ascending by their ids.
    ///
    /// # Errors
    /// [`FileError`] if there is no module.
    pub(super) fn finish(self) -> Result<World, FileError> {
        if self.modules.is_empty() {
            return Err(FileError { line: 1, column: 1, what: "there are no modules in it".into() });
        }
        let mut order: Vec<usize> = (0..self.modules.len()).collect();
        order.sort_by_key(|&m| self.modules[m].id);
        let mut index = vec![0; order.len()];
        order.iter().enumerate().for_each(|(to, &from)| index[from] = to);
        let moved = |dock: Dock| Dock { module: index[dock.module], ..dock };
        let edges = self.edges.into_iter().map(|e| Edge { a: moved(e.a), b: moved(e.b), ..e });
        let modules = order.iter().map(|&m| self.modules[m].clone()).collect();
        Ok(World { modules, edges: edges.collect() })
    }
}

/// The words of a line with their columns.
struct Words<'t> {
    line: usize,
    length: usize,
    words: Vec<(usize, &'t str)>,
}

impl<'t> Words<'t> {
    fn new(line: usize, text: &'t str) -> Words<'t> {
        let start = text.as_ptr() as usize;
        let column = |word: &str| text[..word.as_ptr() as usize - start].chars().count() + 1;
        let words = text.split_whitespace().map(|word| (column(word), word)).collect();
        Words { line, length: text.chars().count(), words }
    }

    fn fault(&self, index: usize, what: impl Into<String>) -> FileError {
        let column = self.words.get(index).map_or(self.length + 1, |(column, _)| *column);
        FileError { line: self.line, column, what: what.into() }
    }

    fn word(&self, index: usize, what: &str) -> Result<&'t str, FileError> {
        let word = self.words.get(index).map(|(_, word)| *word);
        word.ok_or_else(|| self.fault(index, format!("{what} is missing")))
    }

    fn id(&self, index: usize) -> Result<u64, FileError> {
        let word = self.word(index, "the id of a module")?;
        word.parse().map_err(|_| self.fault(index, format!("`{word}` is no id of a module")))
    }

    /// Parses an angle in degrees.
    fn number(&self, index: usize) -> Result<f64, FileError> {
        let word = self.word(index, "a joint's position")?;
        let number = word.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| self.fault(index, format!("`{word}` is no number of degrees")))
    }

    /// Parses the index of a word among some names, stated as a name or as the index itself.
    fn one_of(&self, index: usize, names: &[&str], what: &str) -> Result<usize, FileError> {
        let word = self.word(index, what)?;
        let by_number = word.parse().ok().filter(|n: &usize| *n < names.len());
        names
            .iter()
            .position(|name| *name == word)
            .or(by_number)
            .ok_or_else(|| self.fault(index, format!("`{word}` is not {what}: {} are", names.join(", "))))
    }
}
