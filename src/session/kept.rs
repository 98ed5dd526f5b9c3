//! A snapshot of the project's files: a file that a session has read stays the same until the session reads
//! it again.

use crate::source::{Files, ReadError};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The files that a session can read, shared with completion on another thread.
pub type Project = Arc<dyn Files + Send + Sync>;

/// A project with the files read from it so far: each is read once, also one that can't be read. Lists of
/// folders and the library are not kept.
pub struct FileSnapshot {
    project: Project,
    read: Mutex<BTreeMap<String, Result<Vec<u8>, ReadError>>>,
}

impl FileSnapshot {
    /// Returns a snapshot with nothing read yet.
    pub fn new(project: Project) -> FileSnapshot {
        FileSnapshot { project, read: Mutex::default() }
    }

    /// Returns another snapshot of the same project with nothing read yet, so that it reads every file anew; this one
    /// keeps what it has read.
    pub fn fresh(&self) -> FileSnapshot {
        FileSnapshot::new(self.project.clone())
    }
}

impl Files for FileSnapshot {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.entry(path.to_owned()).or_insert_with(|| self.project.read(path)).clone()
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        self.project.library(path)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        self.project.list(folder)
    }
}
