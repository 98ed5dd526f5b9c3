//! The terminal: what a program prints, progress, and the wish to end.

use super::arguments::Globals;
use super::output;
use super::watch::Watched;
use crate::interpret::{Host, WriteError};
use crate::interrupt::Interrupt;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// Whether the user wants the command to end.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// The wish that the run at hand ends; the user's, or that of a newer text.
static INTERRUPT: LazyLock<Interrupt> = LazyLock::new(Interrupt::default);

/// A run that is asked to end gets this long to do so by itself.
const PATIENCE: Duration = Duration::from_millis(400);

/// From here on Ctrl-C asks the run to end, and ends the process if it does not soon: files are
/// written whole or not at all, so nothing is lost by that.
pub fn listen_for_cancel() {
    let on_signal = || {
        CANCELLED.store(true, Ordering::Relaxed);
        INTERRUPT.raise();
        std::thread::park_timeout(PATIENCE);
        std::process::exit(130);
    };
    // Where signals can't be had, Ctrl-C ends the process, which is as good.
    drop(ctrlc::set_handler(on_signal));
}

/// What ends the run at hand.
pub fn interrupt() -> Interrupt {
    INTERRUPT.clone()
}

/// Whether work is going on that Ctrl-C is to end, in a session.
static BUSY: AtomicBool = AtomicBool::new(false);

/// From here on Ctrl-C ends what a session works on; whatever else wants the process to end has its way
/// while it waits for somebody to type.
pub fn listen_for_interrupt() {
    let on_signal = || {
        if !BUSY.load(Ordering::Relaxed) {
            std::process::exit(130);
        }
        INTERRUPT.raise();
    };
    drop(ctrlc::set_handler(on_signal));
}

/// Does work that Ctrl-C ends.
pub fn interruptible<T>(work: impl FnOnce() -> T) -> T {
    INTERRUPT.lower();
    BUSY.store(true, Ordering::Relaxed);
    let result = work();
    BUSY.store(false, Ordering::Relaxed);
    result
}

pub fn cancelled() -> bool {
    CANCELLED.load(Ordering::Relaxed)
}

/// Writes to standard output. That nobody reads it any more is no mistake: `modl ... | head` is quiet.
pub fn print(text: &str) {
    let mut out = io::stdout().lock();
    drop(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
}

/// Writes to standard error, as quietly.
pub fn print_error(text: &str) {
    drop(io::stderr().lock().write_all(text.as_bytes()));
}

/// The outside of a run as a terminal user sees it.
#[derive(Debug)]
pub struct Terminal {
    folder: PathBuf,
    /// Lines printed, where they go into a JSON object instead of to standard output.
    pub printed: Option<Vec<String>>,
    /// What the run depends on, if it is to end once that changes.
    pub watched: Option<Arc<Watched>>,
    shows_progress: bool,
    progress_shown: bool,
    begun: Instant,
}

impl Terminal {
    pub fn new(globals: &Globals) -> Terminal {
        Terminal {
            folder: globals.out.clone(),
            printed: globals.json.then(Vec::new),
            watched: None,
            shows_progress: !globals.json && io::stderr().is_terminal(),
            progress_shown: false,
            begun: Instant::now(),
        }
    }

    /// Takes a progress line away before something else is printed.
    pub fn clear_progress(&mut self) {
        if std::mem::take(&mut self.progress_shown) {
            print_error("\r\x1b[K");
        }
    }
}

impl Host for Terminal {
    fn print(&mut self, line: &str) {
        self.clear_progress();
        match &mut self.printed {
            Some(lines) => lines.push(line.to_owned()),
            None => print(&format!("{line}\n")),
        }
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        output::write(&self.folder, path, bytes)
    }

    fn progress(&mut self, line: &str) {
        if self.shows_progress {
            print_error(&format!("\r{line}\x1b[K"));
            self.progress_shown = true;
        }
    }

    fn interrupt(&self) -> Interrupt {
        interrupt()
    }

    fn elapsed(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}
