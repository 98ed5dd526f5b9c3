//! `modl new`: a project folder with a program that runs, and a test.

use super::arguments::Globals;
use super::disk::system_words;
use super::terminal::{print, print_json};
use super::{CallError, Ending};
use std::fs;
use std::path::Path;

/// The program of a new project.
const PROGRAM: &str = include_str!("new_program.mod");

/// Runs the command `modl new`, which creates a project folder with a first program.
///
/// # Errors
/// A message if a file of that name exists, or the project can't be written.
pub(super) fn run(name: &Path, globals: &Globals) -> Result<Ending, CallError> {
    let cannot =
        |e: std::io::Error| CallError(format!("cannot make `{}`: {}", name.display(), system_words(&e)));
    // Making the last folder fails if anything has its name, so nothing is ever overwritten.
    if let Some(parent) = name.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        fs::create_dir_all(parent).map_err(cannot)?;
    }
    fs::create_dir(name).map_err(|e| match e.kind() {
        std::io::ErrorKind::AlreadyExists => {
            CallError(format!("`{}` exists; choose another name", name.display()))
        }
        _ => cannot(e),
    })?;
    let program = name.join("main.mod");
    fs::write(&program, PROGRAM).map_err(cannot)?;
    fs::write(name.join(".gitignore"), "/out\n").map_err(cannot)?;
    if globals.json {
        print_json(&format!("{:#}", serde_json::json!({ "ok": true, "written": [program] })));
    } else {
        let program = program.display();
        print(&format!("made {program}; now try\n  modl run {program}\n  modl test {program}\n"));
    }
    Ok(Ending::Fine)
}
