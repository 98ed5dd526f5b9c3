//! `modl watch`: the same command again whenever a file changes that it read, or looked for.

use super::arguments::Globals;
use super::program::{self, Task};
use super::terminal::{cancel_state, cancelled, print_error};
use super::{CallError, Ending, report};
use std::collections::BTreeMap;
use std::fs;
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Between two looks at the files. They are few, and are only asked when they were written: that is
/// cheaper than it sounds, and works on every file system.
const LOOK: Duration = Duration::from_millis(20);

/// What tells one version of a file from another; `None` where there is no file.
type Stamp = Option<(SystemTime, u64)>;

/// The files that a run depends on.
#[derive(Debug, Default)]
pub(super) struct Watched {
    stamps: Mutex<BTreeMap<PathBuf, Stamp>>,
    /// Whether one of them changed since the run began.
    stale: AtomicBool,
}

impl Watched {
    /// The run depends on this file, which need not be there; called before it is read, so that no
    /// change is missed.
    pub(super) fn note(&self, file: &Path) {
        let mut stamps = self.stamps.lock().unwrap_or_else(PoisonError::into_inner);
        stamps.entry(file.to_owned()).or_insert_with(|| stamp(file));
    }

    /// Whether the run is not worth ending any more.
    pub(super) fn stale(&self) -> bool {
        self.stale.load(Ordering::Relaxed)
    }

    /// Looks at the files.
    fn look(&self) -> bool {
        let stamps = self.stamps.lock().unwrap_or_else(PoisonError::into_inner);
        let changed = stamps.iter().any(|(file, before)| stamp(file) != *before);
        if changed {
            self.stale.store(true, Ordering::Relaxed);
            cancel_state().cancel();
        }
        changed
    }
}

fn stamp(file: &Path) -> Stamp {
    let found = fs::metadata(file).ok()?;
    Some((found.modified().ok()?, found.len()))
}

/// Runs, and runs again after each change, until the user wants it to end.
pub(super) fn run(files: &[PathBuf], task: &Task, globals: &Globals) -> Result<Ending, CallError> {
    if let Some(file) = files.iter().find(|file| file.as_path() == Path::new("-")) {
        return Err(CallError(format!("`{}`: standard input does not change", file.display())));
    }
    let mut first = true;
    loop {
        let watched = Arc::new(Watched::default());
        // The wish to end the last run was that of this text.
        if !cancelled() {
            cancel_state().reset();
        }
        files.iter().for_each(|file| watched.note(file));
        if !first {
            clear(globals);
        }
        let over = AtomicBool::new(false);
        let (over, look) = (&over, &watched);
        let ran = std::thread::scope(|scope| {
            // A run that takes long is given up for the newer text.
            scope.spawn(move || {
                while !over.load(Ordering::Relaxed) && !look.look() {
                    std::thread::park_timeout(LOOK);
                }
            });
            let ran = program::run_watched(files, task, globals, &watched);
            over.store(true, Ordering::Relaxed);
            ran
        });
        match ran {
            // While an editor puts a new file in the place of the old, there is none.
            Err(CallError(message)) if !first => report::call_error(globals, &message),
            ran => told(ran?, &watched, globals),
        }
        first = false;
        while !watched.look() {
            if cancelled() {
                return Ok(Ending::Cancelled);
            }
            std::thread::park_timeout(LOOK);
        }
    }
}

/// That nothing is said need not mean that nothing is wrong: so something is said.
fn told(ending: Ending, watched: &Watched, globals: &Globals) {
    if globals.json || watched.stale() {
        return;
    }
    let count = watched.stamps.lock().unwrap_or_else(PoisonError::into_inner).len();
    let files = if count == 1 { "1 file".to_owned() } else { format!("{count} files") };
    let found = if ending == Ending::Fine { "nothing is wrong; " } else { "" };
    print_error(&format!("{found}watching {files}\n"));
}

/// Takes what was said of an older text from the screen.
fn clear(globals: &Globals) {
    if stderr().is_terminal() && !globals.json {
        print_error("\x1b[2J\x1b[3J\x1b[H");
    } else if !globals.json {
        print_error("--- changed\n");
    }
}
