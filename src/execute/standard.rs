//! Declarations of the standard library, by the names that plan files give them: `Smores`, `Mori(side: 40mm)`.

use super::ROUTINES;
use crate::check;
use crate::elaborate;
use crate::interpret::WriteError;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::{Host, Options, with_interpreter};
use crate::robot::Library;
use crate::source::{Files, ReadError, Symbol, library};
use std::borrow::Cow;

/// The greatest length of a name with its arguments, in bytes.
const NAME_MAX: usize = 2000;
/// The evaluation steps that a declaration of the library may take.
const STEPS_MAX: u64 = 200_000;
/// Threshold: the relative tolerance of numbers of a declaration whose name states arguments: names show six digits.
const TOL_ARGUMENT: f64 = 2e-5;

/// A declaration of the standard library, as [`standard`] finds it by the name that a plan file gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Standard {
    /// The path of the declaration in programs: `std.smores.Smores`.
    pub path: String,
    /// The declaration with the arguments of the name: as a module type, cell or strut the first of its kind (index
    /// 0), with the connectors that it needs. `None` where it does not take these arguments.
    pub library: Option<Library>,
    /// The relative tolerance with which numbers of a declaration of this name agree: the rounding of arguments
    /// in the name; 0 without arguments.
    pub tolerance: f64,
}

/// Returns the declaration of the standard library that has a name such as `Mori(side: 40mm)`, with the name's
/// arguments; `None` where the library has none of that name. The arguments are evaluated only if they are
/// names, numbers and lists.
pub fn standard(name: &str) -> Option<Standard> {
    let (own, arguments) =
        name.split_once('(').map_or((name, ""), |(own, rest)| (own, rest.trim_end_matches(')')));
    let file = library::declares(own)?;
    let path = format!("std.{file}.{own}");
    let tolerance = if arguments.is_empty() { 0.0 } else { TOL_ARGUMENT };
    let library = if is_plain(arguments) { elaborated(&path, own, arguments) } else { None };
    Some(Standard { path, library, tolerance })
}

/// Returns true for arguments that are nothing but names, numbers with units, and lists of them. A name in a file that
/// somebody altered is text of theirs, and is not run as a program.
fn is_plain(arguments: &str) -> bool {
    let is_sign = |c: char| " .,:[]*/^+-_".contains(c);
    let sound =
        arguments.len() <= NAME_MAX && arguments.chars().all(|c| c.is_ascii_alphanumeric() || is_sign(c));
    let mut words = arguments.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    sound && !words.any(|word| matches!(word, "for" | "in" | "if" | "else" | "match" | "fn"))
}

/// Returns the library of a declaration with arguments, by a program of two lines; `None` where that has an
/// error.
fn elaborated(path: &str, own: &str, arguments: &str) -> Option<Library> {
    const ROBOT: &str = "It";
    let with = |text: String, name: &str| {
        let files = Only(text);
        let checked = check::check(&files, FILE);
        if checked.has_errors() {
            return None;
        }
        let name = Symbol::new(name);
        let (def, _) = checked.program.identified().find(|(_, def)| def.name == name)?;
        let mut options = Options::default();
        options.limits.steps = STEPS_MAX;
        let work = |interpreter: &mut Interpreter| elaborate::library_of(interpreter, def);
        with_interpreter(&ROUTINES, &checked, &files, &mut Nowhere, &options, work).flatten()
    };
    let module = || with(format!("use {path}\nconfig {ROBOT} {{ part it: {own}({arguments}) }}\n"), ROBOT);
    // Cells and struts are parts of nothing but lattices and trusses.
    module().or_else(|| with(format!("use {path}\n"), own))
}

/// The name of the program's file.
const FILE: &str = "standard.mod";

/// The program, and nothing of any project.
struct Only(String);

impl Files for Only {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        if path == FILE { Ok(self.0.clone().into_bytes()) } else { Err(ReadError::NotFound) }
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        library::text(path).map(Cow::Borrowed)
    }
}

/// A host to which nothing is said and by whom nothing is written.
struct Nowhere;

impl Host for Nowhere {
    fn print(&mut self, _: &str) {}

    fn write(&mut self, _: &str, _: &[u8]) -> Result<String, WriteError> {
        Err(WriteError::Outside)
    }

    fn progress(&mut self, _: &str) {}
}
