//! A host for tests: what a program prints and writes, kept.

use crate::support::suite::{MapFiles, Observed};
use modl::interpret::{Host, Mode, Options, Outcome, WriteError};
use modl::plan::{Plan, file};
use std::collections::BTreeMap;

#[derive(Default)]
pub struct Desk {
    pub printed: Vec<String>,
    pub written: BTreeMap<String, Vec<u8>>,
}

impl Host for Desk {
    fn print(&mut self, line: &str) {
        self.printed.extend(line.split('\n').map(str::to_string));
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        match modl::source::files::join("", path) {
            Some(path) => {
                self.written.insert(path.clone(), bytes.to_vec());
                Ok(path)
            }
            None => Err(WriteError::Outside),
        }
    }

    fn progress(&mut self, _: &str) {}
}

impl Desk {
    /// The text of a written file.
    pub fn text(&self, path: &str) -> &str {
        let bytes = self.written.get(path).unwrap_or_else(|| panic!("{path} was not written"));
        std::str::from_utf8(bytes).expect("plans are text")
    }

    /// Returns the plan of a written plan file.
    pub fn plan(&self, path: &str) -> Plan {
        file::read(self.text(path)).expect("a plan that was written is read")
    }
}

/// Returns the number before a unit in the part of a message that follows some words.
pub fn stated(message: &str, after: &str, unit: &str) -> f64 {
    let found = message.find(after).unwrap_or_else(|| panic!("{after} in {message}"));
    let rest = &message[found + after.len()..];
    let end = rest.find(unit).unwrap_or_else(|| panic!("{unit} in {rest}"));
    let begin = rest[..end].rfind([' ', ';']).map_or(0, |at| at + 1);
    rest[begin..end].parse().unwrap_or_else(|_| panic!("a number in {rest}"))
}

/// Checks and runs a program; the diagnostics of both are in the first result.
pub fn run(files: &MapFiles, mode: Mode) -> (Observed, Desk, Outcome) {
    let checked = modl::check::check(files, "main.mod");
    let mut desk = Desk::default();
    let mut diagnostics = checked.diagnostics.clone();
    let outcome = if checked.has_errors() {
        Outcome::default()
    } else {
        modl::execute::run(&checked, mode, files, &mut desk, &Options::default())
    };
    diagnostics.extend(outcome.diagnostics.iter().cloned());
    let file = checked.sources.files().find(|(_, f)| &*f.name == "main.mod").map(|(id, _)| id);
    let observed = Observed { sources: checked.sources, file, diagnostics, printed: desk.printed.clone() };
    (observed, desk, outcome)
}

/// Checks and runs a program, and returns the messages of its diagnostics.
pub fn messages(text: &str) -> Vec<String> {
    let (observed, ..) = run(&MapFiles::of(text), Mode::Run);
    observed.diagnostics.iter().map(|d| d.message.clone()).collect()
}

/// What a program that must be without mistakes prints and writes.
pub fn run_clean(text: &str) -> Desk {
    let (observed, desk, _) = run(&MapFiles::of(text), Mode::Run);
    let said: Vec<String> =
        observed.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect();
    assert!(said.is_empty(), "{said:#?}\nin\n{text}");
    desk
}
