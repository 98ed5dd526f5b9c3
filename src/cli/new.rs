//! `modl new`: a project folder with a program that runs, and a test.

use super::arguments::Globals;
use super::output;
use super::terminal::{print, print_json};
use super::{CallError, Ending};
use crate::interpret::WriteError;
use std::fs;
use std::path::Path;

/// The program of a new project.
const PROGRAM: &str = include_str!("new_program.mod");

/// Runs the command `modl new`, which creates a project folder with a first program.
///
/// # Errors
/// A message if a file of that name exists, or the project can't be written.
pub(super) fn run(name: &Path, globals: &Globals) -> Result<Ending, CallError> {
    let exists = || CallError(format!("`{}` exists; choose another name", name.display()));
    let Some(last) = name.file_name() else { return Err(exists()) };
    if fs::symlink_metadata(name).is_ok() {
        return Err(exists());
    }
    let parent = name.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = [("main.mod", PROGRAM.as_bytes()), (".gitignore", "/out\n".as_bytes())];
    // All of it is there, or nothing; what has got this name meanwhile stays.
    output::write_folder(parent, &last.to_string_lossy(), files.into_iter(), |_| false).map_err(|e| {
        let why = match e {
            WriteError::Outside => "this is no name of a folder".to_owned(),
            WriteError::Failed(why) => why,
        };
        CallError(format!("cannot make `{}`: {why}", name.display()))
    })?;
    let program = name.join("main.mod");
    if globals.json {
        print_json(&format!("{:#}", serde_json::json!({ "ok": true, "written": [program] })));
    } else {
        let program = program.display();
        print(&format!("made {program}; now try\n  modl run {program}\n  modl test {program}\n"));
    }
    Ok(Ending::Fine)
}
