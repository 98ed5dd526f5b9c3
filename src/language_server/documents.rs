//! The documents that are open in the editor, and the files of their projects.

use super::analysis::Analysis;
use crate::session::Project;
use crate::source::{Files, ReadError};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, PoisonError};

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
    /// The program that it is, checked or being checked; `None` if it has changed since.
    present: Option<Arc<Awaited>>,
    /// The newest program that it has been and that is known.
    last: Option<Analysis>,
}

impl Document {
    /// Returns a document that is not checked yet.
    pub(super) fn new(path: PathBuf, version: i32, text: Arc<str>, project: Option<Opened>) -> Document {
        Document { path, version, text, project, present: None, last: None }
    }
}

/// A program that a thread checks.
#[derive(Default)]
pub(super) struct Awaited {
    found: Mutex<Found>,
    known: Condvar,
}

/// The findings of a thread so far.
#[derive(Default)]
struct Found {
    done: bool,
    /// The program; `None` as long as it is not checked, and where that was given up.
    analysis: Option<Analysis>,
}

impl Awaited {
    /// Hands over what was found to all that wait; what came first stays.
    pub(super) fn tell(&self, analysis: Option<Analysis>) {
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        if !found.done {
            *found = Found { done: true, analysis };
        }
        self.known.notify_all();
    }

    /// Waits for what is found; `None` where that was given up.
    fn wait(&self) -> Option<Analysis> {
        let found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let known = self.known.wait_while(found, |found| !found.done);
        known.unwrap_or_else(PoisonError::into_inner).analysis.clone()
    }

    /// Returns what was found, if it is known already.
    fn so_far(&self) -> Option<Analysis> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).analysis.clone()
    }
}

/// A document that is to be checked: its files as they are now, and who waits for what is found.
pub(super) struct Task {
    /// The URI of the document.
    pub uri: String,
    /// The version that the editor counts.
    pub version: i32,
    project: Opened,
    files: OpenFiles,
    text: Arc<str>,
    /// The place to which the program is handed.
    pub awaited: Arc<Awaited>,
}

impl Task {
    /// Checks the document.
    pub(super) fn check(self) -> Option<Analysis> {
        Analysis::of(Arc::new(self.files), &self.project, &self.text)
    }
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
        let Some(document) = self.open.get_mut(uri) else { return };
        document.text = change(&document.text).into();
        document.version = version;
        let path = document.path.clone();
        for (other, document) in &mut self.open {
            // Programs that are known not to have read the file stay as they are.
            let known = document.present.as_ref().and_then(|present| present.so_far());
            if other == uri || known.is_none_or(|known| known.has_read(&path)) {
                document.forget();
            }
        }
    }

    /// Forgets what was found of all documents: any may import a file that has changed.
    pub(super) fn forget(&mut self) {
        self.open.values_mut().for_each(Document::forget);
    }

    /// Returns true if a document of this path is open.
    pub(super) fn has(&self, path: &Path) -> bool {
        self.open.values().any(|document| document.path == path)
    }

    /// Returns a document; `None` if it is not open.
    pub(super) fn get(&self, uri: &str) -> Option<&Document> {
        self.open.get(uri)
    }

    /// Returns the open documents, sorted by URI.
    pub(super) fn all(&self) -> impl Iterator<Item = &Document> {
        self.open.values()
    }

    /// Returns what is to be checked: `first` before the others.
    pub(super) fn tasks(&mut self, first: &str) -> Vec<Task> {
        let unknown = self.open.iter().filter(|(_, document)| document.present.is_none());
        let mut uris: Vec<String> = unknown.map(|(uri, _)| uri.clone()).collect();
        uris.sort_by_key(|uri| uri != first);
        uris.iter().filter_map(|uri| self.task(uri)).collect()
    }

    /// Returns the check of a document, which is awaited from now on; `None` if it is not open or has no project.
    fn task(&mut self, uri: &str) -> Option<Task> {
        let document = self.open.get(uri)?;
        let (project, text, version) = (document.project.clone()?, document.text.clone(), document.version);
        let texts = self.open.values().map(|document| (document.path.clone(), document.text.clone()));
        let files =
            OpenFiles { files: project.files.clone(), root: project.root.clone(), open: texts.collect() };
        let awaited = Arc::<Awaited>::default();
        self.open.get_mut(uri)?.present = Some(awaited.clone());
        Some(Task { uri: uri.to_owned(), version, project, files, text, awaited })
    }

    /// Returns the program that a document is, checked with the texts of all open documents; `None` if it is not open or has
    /// no project. Waits where it is being checked.
    pub(super) fn analysis(&mut self, uri: &str) -> Option<Analysis> {
        if self.open.get(uri)?.present.is_none() {
            let task = self.task(uri)?;
            let awaited = task.awaited.clone();
            awaited.tell(task.check());
        }
        let document = self.open.get_mut(uri)?;
        let found = document.present.as_ref()?.wait();
        document.last.clone_from(&found);
        found
    }

    /// Returns the newest program that a document has been, without waiting for the present one if there is another.
    pub(super) fn newest(&mut self, uri: &str) -> Option<Analysis> {
        let document = self.open.get_mut(uri)?;
        if let Some(present) = document.present.as_ref().and_then(|present| present.so_far()) {
            document.last = Some(present);
        }
        match &self.open.get(uri)?.last {
            Some(last) => Some(last.clone()),
            None => self.analysis(uri),
        }
    }
}

impl Document {
    /// Forgets the program that it is, and keeps it as the newest that is known.
    fn forget(&mut self) {
        if let Some(present) = self.present.take().and_then(|present| present.so_far()) {
            self.last = Some(present);
        }
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
