//! A project in memory, and a host that keeps what a program prints and writes.

use modl::interpret::{Host, WriteError};
use modl::source::{Files, ReadError};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The files of a project, by their paths, with the library.
#[derive(Default)]
pub struct Project(pub BTreeMap<String, Vec<u8>>);

impl Project {
    /// Returns a project whose `main.mod` has this text.
    pub fn of(main: &str) -> Project {
        Project(BTreeMap::from([("main.mod".to_owned(), main.as_bytes().to_vec())]))
    }
}

impl Files for Project {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.0.get(path).cloned().ok_or(ReadError::NotFound)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        modl::source::library::text(path).map(Cow::Borrowed)
    }
}

/// A host that keeps what is printed and written.
#[derive(Default)]
pub struct Desk {
    /// The lines that were printed.
    pub printed: Vec<String>,
    /// The files that were written, by their paths.
    pub written: BTreeMap<String, Vec<u8>>,
}

impl Host for Desk {
    fn print(&mut self, line: &str) {
        self.printed.push(line.to_owned());
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        let path = modl::source::files::join("", path).ok_or(WriteError::Outside)?;
        self.written.insert(path.clone(), bytes.to_vec());
        Ok(path)
    }

    fn progress(&mut self, _: &str) {}
}
