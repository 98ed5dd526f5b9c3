//! The documents that are open in the editor, and the files of their projects.

use super::analysis::Analysis;
use crate::session::Project;
use crate::source::{Files, ReadError};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The access of a language server to projects on disk.
pub trait Workspace {
    /// Opens the project of a program, given by its absolute path; the file itself need not be there. `None` where its folder
    /// can't be read, or the path is not below the project's root.
    fn open(&self, path: &Path) -> Option<Opened>;
}

/// The project of a program.
#[derive(Clone)]
pub struct Opened {
    /// The files of the project, and the library.
    pub files: Project,
    /// The root of the project: absolute.
    pub root: PathBuf,
    /// The path of the program relative to the root, with forward slashes.
    pub name: String,
}

/// A document that is open in the editor.
pub(super) struct Document {
    /// The path of its file: absolute.
    pub path: PathBuf,
    /// The version that the editor counts.
    pub version: i32,
    /// The text as it is in the editor.
    pub text: Arc<str>,
    /// Its project; `None` where it can't be read.
    pub project: Option<Opened>,
    /// The program that it is, checked; `None` if it has changed since.
    pub analysis: Option<Analysis>,
}

/// The open documents, by their URIs.
#[derive(Default)]
pub(super) struct Documents {
    open: BTreeMap<String, Document>,
}

impl Documents {
    /// Opens a document, or replaces one of its URI.
    pub(super) fn insert(&mut self, uri: &str, document: Document) {
        self.open.insert(uri.to_owned(), document);
        self.forget();
    }

    /// Closes a document.
    pub(super) fn close(&mut self, uri: &str) {
        self.open.remove(uri);
        self.forget();
    }

    /// Changes the text of a document, and counts its version.
    pub(super) fn change(&mut self, uri: &str, version: i32, change: impl FnOnce(&str) -> String) {
        if let Some(document) = self.open.get_mut(uri) {
            document.text = change(&document.text).into();
            document.version = version;
            self.forget();
        }
    }

    /// Forgets what was found of all documents: any may import the one that has changed.
    fn forget(&mut self) {
        self.open.values_mut().for_each(|document| document.analysis = None);
    }

    /// Returns the URIs of all documents, sorted.
    pub(super) fn uris(&self) -> Vec<String> {
        self.open.keys().cloned().collect()
    }

    /// Returns a document; `None` if it is not open.
    pub(super) fn get(&self, uri: &str) -> Option<&Document> {
        self.open.get(uri)
    }

    /// Returns the program that a document is, checked with the texts of all open documents; `None` if it is not open or has
    /// no project.
    pub(super) fn analysis(&mut self, uri: &str) -> Option<Analysis> {
        let document = self.open.get(uri)?;
        if let Some(known) = &document.analysis {
            return Some(known.clone());
        }
        let project = document.project.clone()?;
        let texts = self.open.values().map(|document| (document.path.clone(), document.text.clone()));
        let files =
            OpenFiles { files: project.files.clone(), root: project.root.clone(), open: texts.collect() };
        let found = Analysis::of(Arc::new(files), &project, &document.text)?;
        self.open.get_mut(uri)?.analysis = Some(found.clone());
        Some(found)
    }
}

/// The files of a project with the texts of open documents in place of theirs.
pub(super) struct OpenFiles {
    files: Project,
    root: PathBuf,
    open: BTreeMap<PathBuf, Arc<str>>,
}

impl Files for OpenFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        match self.open.get(&self.root.join(path)) {
            Some(text) => Ok(text.as_bytes().to_vec()),
            None => self.files.read(path),
        }
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        self.files.library(path)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        self.files.list(folder)
    }
}
