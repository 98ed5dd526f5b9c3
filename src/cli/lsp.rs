//! `modl lsp`: the language server on standard input and output.

use super::arguments::Globals;
use super::disk::Project;
use super::{CallError, Ending};
use crate::language_server::{Opened, Workspace, serve};
use lsp_server::Connection;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The projects on disk: of each document the folder that it is in, or the one that is stated for all.
struct Disk {
    root: Option<PathBuf>,
    stdlib: Option<PathBuf>,
}

impl Workspace for Disk {
    fn open(&self, path: &Path) -> Option<Opened> {
        let (folder, file) = (path.parent()?, path.file_name()?.to_str()?);
        let root = self.root.as_deref().unwrap_or(folder);
        let project = Project::of_folder(Some(root), self.stdlib.as_deref()).ok()?;
        let below = project.path_below(folder)?;
        let name = if below.is_empty() { file.to_owned() } else { format!("{below}/{file}") };
        Some(Opened { root: project.root().to_owned(), files: Arc::new(project), name })
    }
}

/// Serves an editor until it ends the conversation.
///
/// # Errors
/// A message where the editor does not begin as the protocol says.
pub(super) fn run(globals: &Globals) -> Result<Ending, CallError> {
    let workspace = Disk { root: globals.root.clone(), stdlib: globals.stdlib.clone() };
    let (connection, threads) = Connection::stdio();
    let ended = serve(&connection, &workspace).map_err(CallError)?;
    // The writing thread ends with the connection.
    drop(connection);
    if ended {
        threads
            .join()
            .map_err(|error| CallError(format!("the conversation ended with an error: {error}")))?;
    }
    Ok(if ended { Ending::Fine } else { Ending::Wrong })
}
