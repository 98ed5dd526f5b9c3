//! A program that is typed, checked.

use super::documents::Opened;
use crate::check::{self, Checked};
use crate::session::complete::Knowledge;
use crate::session::{FileSnapshot, Project};
use crate::source::{Diagnostic, FileId, SourceFile, code};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A checked program, whose root is an open document.
#[derive(Clone)]
pub(super) struct Analysis {
    /// The typed program with its diagnostics.
    pub checked: Arc<Checked>,
    /// The files that it was read from; each is read once.
    pub files: Arc<FileSnapshot>,
    /// The document in it.
    pub file: FileId,
    /// The root of its project.
    root: PathBuf,
    /// The path of the document relative to the root.
    pub name: String,
}

impl Analysis {
    /// Checks a document with all that it imports. `None` if its text can't be read as a program at all. `files`: with the
    /// texts of open documents; `text`: that of the document.
    pub(super) fn of(files: Project, project: &Opened, text: &str) -> Option<Analysis> {
        let files = Arc::new(FileSnapshot::new(files));
        let checked = Arc::new(check::check(&*files, &project.name));
        let own = |(_, file): &(FileId, &SourceFile)| !file.library && *file.name == *project.name;
        let (file, known) = checked.sources.files().find(own)?;
        if *known.text != *text {
            return None;
        }
        Some(Analysis { checked, files, file, root: project.root.clone(), name: project.name.clone() })
    }

    /// Returns the same program as another file of it sees it.
    pub(super) fn seen_from(&self, file: FileId) -> Analysis {
        Analysis { file, ..self.clone() }
    }

    /// Returns the text of a file of the program.
    pub(super) fn text(&self, file: FileId) -> &str {
        &self.checked.sources.file(file).text
    }

    /// Returns the absolute path of a file of the program; `None` for one of the library, which is part of the command.
    pub(super) fn path(&self, file: FileId) -> Option<String> {
        let source = self.checked.sources.file(file);
        let path = self.root.join(&*source.name);
        if source.library { None } else { path.to_str().map(str::to_owned) }
    }

    /// Returns true if the program was read from the file of this path, or tried to.
    pub(super) fn has_read(&self, path: &Path) -> bool {
        let own = self.checked.sources.files().filter(|(_, file)| !file.library);
        let unread = |found: &Diagnostic| matches!(found.code, code::CANNOT_READ | code::UNKNOWN_IMPORT);
        let missing = self.checked.diagnostics.iter().any(unread);
        missing || own.map(|(_, file)| self.root.join(&*file.name)).any(|read| read == path)
    }

    /// Returns what completion needs to know of the program.
    pub(super) fn knowledge(&self) -> Knowledge {
        self.knowledge_with(self.text(self.file))
    }

    /// Returns what completion needs to know of the program whose document has this text now.
    pub(super) fn knowledge_with(&self, text: &str) -> Knowledge {
        Knowledge::of_program(self.files.clone(), self.checked.clone(), text)
    }
}
