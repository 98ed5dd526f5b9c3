//! `modl watch`: runs a command again whenever a file changes that it read or searched.

use super::arguments::Globals;
use super::program::{self, Task};
use super::terminal::{cancel_state, cancelled, print_error, print_styled};
use super::watched::Watched;
use super::{CallError, Ending, report};
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The time between two polls of the files. Polling the metadata of a few files is cheap, and works on
/// every file system.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Runs the task with the programs, and again after each change of a file that it read, until the user cancels.
///
/// # Errors
/// A message if a file is standard input; at the first run also as for [`program::run`], while later runs only print
/// it.
pub(super) fn run(files: &[PathBuf], task: &Task, globals: &Globals) -> Result<Ending, CallError> {
    if let Some(file) = files.iter().find(|file| file.as_path() == Path::new("-")) {
        return Err(CallError(format!("`{}`: standard input does not change", file.display())));
    }
    let mut first = true;
    loop {
        let watched = Arc::new(Watched::default());
        // The last run was cancelled because of this newer text.
        if !cancelled() {
            cancel_state().reset();
        }
        files.iter().for_each(|file| watched.note(file));
        if !first {
            clear(globals);
        }
        let over = AtomicBool::new(false);
        let (over, depends) = (&over, &watched);
        let ran = std::thread::scope(|scope| {
            // A long run is cancelled for a newer text; without a thread it goes on to its end.
            let polls = move || {
                while !over.load(Ordering::Relaxed) && !depends.poll() {
                    std::thread::park_timeout(POLL_INTERVAL);
                }
                if depends.stale() {
                    cancel_state().cancel();
                }
            };
            drop(std::thread::Builder::new().spawn_scoped(scope, polls));
            let ran = program::run_watched(files, task, globals, &watched);
            over.store(true, Ordering::Relaxed);
            ran
        });
        match ran {
            // There is no file for a moment while an editor replaces it.
            Err(CallError(message)) if !first => report::call_error(globals, &message),
            ran => told(ran?, &watched, globals),
        }
        first = false;
        while !watched.poll() {
            if cancelled() {
                return Ok(Ending::Cancelled);
            }
            std::thread::park_timeout(POLL_INTERVAL);
        }
    }
}

/// Prints the outcome of a run and the number of watched files, unless the run is outdated.
fn told(ending: Ending, watched: &Watched, globals: &Globals) {
    if globals.json || watched.stale() {
        return;
    }
    let count = watched.count();
    let files = if count == 1 { "1 file".to_owned() } else { format!("{count} files") };
    let found = if ending == Ending::Fine { "nothing is wrong; " } else { "" };
    print_error(&format!("{found}watching {files}\n"));
}

/// Clears the screen of messages about an older text.
fn clear(globals: &Globals) {
    if stderr().is_terminal() && !globals.json {
        print_styled("\x1b[2J\x1b[3J\x1b[H");
    } else if !globals.json {
        print_error("--- changed\n");
    }
}
