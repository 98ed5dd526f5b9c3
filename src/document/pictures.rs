//! Facts that only an instance has (order, modules, mass), and its picture. They are found by running a
//! small program.

use super::outline::{Page, PageEntry};
use super::site::Request;
use crate::check::{self, Entry};
use crate::interpret::{Host, Mode, Options, WriteError};
use crate::interrupt::CancelState;
use crate::source::{Files, ReadError};
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Width and height of a picture in pixels.
const SIZE: (usize, usize) = (480, 300);

/// A drawing of a declaration: the facts and the picture that a small program gave, and all files that they were made
/// from.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The lines that the program printed: the order, then facts in words.
    pub facts: Vec<String>,
    /// The name of the picture (PNG) in the site, and its bytes; `None` where nothing was drawn.
    pub picture: Option<(String, Vec<u8>)>,
    /// The files from which the drawing was made, with the digests of what was read.
    pub sources: Sources,
}

/// The files that a drawing was made from, with the digests of what was read: while they are unchanged, it needs no
/// redrawing.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sources {
    /// Those of the project, by path; `None` for one that could not be read.
    project: BTreeMap<String, Option<String>>,
    /// Those of the standard library, by path; `None` for one that is not there.
    library: BTreeMap<String, Option<String>>,
}

impl Sources {
    /// Returns true if all files are still as they were read; `files` gives access to them.
    pub fn hold(&self, files: &dyn Files) -> bool {
        let mut project = self.project.iter();
        let mut library = self.library.iter();
        project.all(|(path, read)| files.read(path).ok().map(|bytes| digest(&bytes)) == *read)
            && library.all(|(path, read)| files.library(path).map(|text| digest(text.as_bytes())) == *read)
    }
}

/// Returns the SHA-256 digest of some bytes as 64 hexadecimal digits.
pub fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Files that note what is read of them.
struct Noted<'f> {
    files: &'f dyn Files,
    read: RefCell<Sources>,
}

impl Files for Noted<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let found = self.files.read(path);
        let read = found.as_ref().ok().map(|bytes| digest(bytes));
        self.read.borrow_mut().project.insert(path.to_owned(), read);
        found
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        let found = self.files.library(path);
        let read = found.as_ref().map(|text| digest(text.as_bytes()));
        self.read.borrow_mut().library.insert(path.to_owned(), read);
        found
    }
}

/// The host of that program: collects what it prints and writes.
struct Answers {
    lines: Vec<String>,
    picture: Option<Vec<u8>>,
    cancel_state: CancelState,
}

impl Host for Answers {
    fn print(&mut self, line: &str) {
        self.lines.push(line.to_owned());
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        self.picture = Some(bytes.to_vec());
        Ok(path.to_owned())
    }

    fn progress(&mut self, _: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.cancel_state.clone()
    }
}

/// Fills in the facts and the picture's name of every entry of a page that has a default instance. New drawings are
/// added to `drawings`, by the text of the program that makes them; a known drawing is not made anew, and one that was
/// cancelled is not added.
pub(super) fn draw(page: &mut Page, request: &Request, drawings: &mut BTreeMap<String, Drawing>) {
    let import = match page.title.strip_prefix("std.") {
        Some(_) => page.title.clone(),
        None => format!("\"{}\"", page.title),
    };
    let stem = page.file.trim_end_matches(".html").to_owned();
    for entry in page.entries.iter_mut().filter(|entry| entry.has_default) {
        let program = program(entry, &import);
        let drawing = request.known.get(&program).cloned().or_else(|| {
            let name = format!("pictures/{stem}-{}.png", entry.name);
            drawn(&program, name, request)
        });
        let Some(drawing) = drawing else { continue };
        entry.picture = drawing.picture.as_ref().map(|(name, _)| name.clone());
        let mut facts = drawing.facts.iter();
        entry.order = facts.next().and_then(|order| order.parse().ok()).filter(|_| entry.word == "config");
        if let Some(order) = entry.order {
            entry.facts.push(format!("order {order}"));
        }
        entry.facts.extend(facts.cloned());
        drawings.insert(program, drawing);
    }
}

/// Returns the program about one entry: it prints facts and draws a picture.
fn program(entry: &PageEntry, import: &str) -> String {
    let name = &entry.name;
    let facts = match entry.word {
        "config" => {
            format!("print(order({name}()))\nprint(count({name}()), \"modules\")\nprint(mass({name}()))\n")
        }
        "scene" => {
            format!("print(0)\nprint(count({name}()), \"modules\")\nprint(mass({name}()))\n")
        }
        "module" => format!("print(0)\nprint(mass({name}()))\n"),
        "lattice" => format!("print(0)\nprint(count({name}()), \"cells\")\n"),
        _ => String::new(),
    };
    format!("use {import}.{{{name}}}\n{facts}show({name}(), \"picture.png\")\n")
}

/// Runs the program about one entry, whose picture has this name in the site; `None` if it has an error, or the user
/// cancelled it.
fn drawn(program: &str, picture: String, request: &Request) -> Option<Drawing> {
    let files = Noted { files: request.files, read: RefCell::default() };
    let cell = Entry {
        name: "<documentation>".into(),
        text: program.to_owned(),
        first_line: 1,
        value: None,
        last: None,
    };
    let checked = check::check_session(&files, &[cell]);
    if checked.has_errors() {
        return None;
    }
    let cancel_state = request.cancel_state.clone();
    let mut answers = Answers { lines: Vec::new(), picture: None, cancel_state };
    // A robot that falls is drawn, too: no verdict is claimed.
    let options = Options { picture: Some(SIZE), ..Options::default() };
    let outcome = crate::execute::run(&checked, Mode::Run, &files, &mut answers, &options);
    let picture = answers.picture.map(|bytes| (picture, bytes));
    (!outcome.cancelled).then(|| Drawing { facts: answers.lines, picture, sources: files.read.into_inner() })
}
