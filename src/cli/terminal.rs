//! The terminal: printed lines, progress reports, and cancellation by Ctrl-C.

use super::arguments::Globals;
use super::disk::system_words;
use super::output;
use super::watched::Watched;
use crate::interpret::printed::PrintedValue;
use crate::interpret::{Host, WriteError};
use crate::interrupt::CancelState;
use crate::source::escape::{escaped, escaped_json};
use serde::Serialize;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, Once, PoisonError};
use std::time::{Duration, Instant};

/// True once Ctrl-C has cancelled the command.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// The cancellation token of the current run, cancelled by the user or by a newer text.
static CANCEL_STATE: LazyLock<Mutex<CancelState>> = LazyLock::new(Mutex::default);

/// The time that a cancelled run gets to end at a checkpoint before it is abandoned.
const CANCEL_GRACE: Duration = Duration::from_millis(400);

/// The grace period in a session, where the user waits for the prompt.
const CANCEL_GRACE_SESSION: Duration = Duration::from_millis(50);

/// A second Ctrl-C within this time of the first is taken as the same one.
const REPEAT_INTERVAL: Duration = Duration::from_secs(1);

/// The time between two progress requests.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// Installs the Ctrl-C handler of a command: it cancels the run, and exits the process with code 130 after
/// a grace period. Files are written whole or not at all, so nothing is lost by that.
pub(super) fn listen_for_cancel() {
    let on_signal = || {
        CANCELLED.store(true, Ordering::Relaxed);
        cancel_state().cancel();
        std::thread::park_timeout(CANCEL_GRACE);
        std::process::exit(130);
    };
    // Without a handler Ctrl-C ends the process, which is as good.
    drop(ctrlc::set_handler(on_signal));
}

/// Returns the cancellation token of the current run.
pub(super) fn cancel_state() -> CancelState {
    CANCEL_STATE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// False while a session waits for input.
static BUSY: AtomicBool = AtomicBool::new(true);

/// The instant of the last input.
static TYPED: Mutex<Option<Instant>> = Mutex::new(None);

/// The instant of the last Ctrl-C while a session worked.
static PRESSED: Mutex<Option<Instant>> = Mutex::new(None);

/// Installs the Ctrl-C handler of a session: it cancels the current work, and abandons it after a grace
/// period. While the session waits for input, it exits the process with code 130.
pub(super) fn listen_for_interrupt() {
    let on_signal = || {
        let mut pressed = PRESSED.lock().unwrap_or_else(PoisonError::into_inner);
        if !BUSY.load(Ordering::Relaxed) {
            if pressed.is_none_or(|before| before.elapsed() > REPEAT_INTERVAL) {
                std::process::exit(130);
            }
            return;
        }
        *pressed = Some(Instant::now());
        let cancel_state = cancel_state();
        cancel_state.cancel();
        abandon_after(CANCEL_GRACE_SESSION, cancel_state);
    };
    drop(ctrlc::set_handler(on_signal));
}

/// Calls `wait`, which waits for input; Ctrl-C meanwhile ends the process. Returns the input.
pub(super) fn idle<T>(wait: impl FnOnce() -> T) -> T {
    BUSY.store(false, Ordering::Relaxed);
    let typed = wait();
    *TYPED.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    BUSY.store(true, Ordering::Relaxed);
    typed
}

/// Abandons cancelled work after a grace period; at once where the system gives no thread to wait on.
fn abandon_after(grace: Duration, work: CancelState) {
    let overdue = work.clone();
    let wait = move || {
        std::thread::park_timeout(grace);
        overdue.abandon();
    };
    if std::thread::Builder::new().spawn(wait).is_err() {
        work.abandon();
    }
}

/// Resets the cancellation token for new work. A Ctrl-C pressed since the last input still cancels it.
pub(super) fn begin_work() {
    let cancel_state = cancel_state();
    cancel_state.reset();
    let at = |clock: &Mutex<Option<Instant>>| *clock.lock().unwrap_or_else(PoisonError::into_inner);
    if at(&PRESSED) > at(&TYPED) {
        cancel_state.cancel();
    }
}

/// Calls `settle`, which waits for cancelled work to end, and abandons that work after a grace period; returns the
/// result of `settle`, true if the work ended. If it did not, work started from here on has a new cancellation token.
pub(super) fn settled(settle: impl FnOnce() -> bool) -> bool {
    abandon_after(CANCEL_GRACE, cancel_state());
    let settled = settle();
    if !settled {
        *CANCEL_STATE.lock().unwrap_or_else(PoisonError::into_inner) = CancelState::default();
    }
    settled
}

/// Starts a thread that requests a progress report of the current run at each interval.
fn poll_progress() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let poll = || {
            loop {
                std::thread::park_timeout(PROGRESS_INTERVAL);
                cancel_state().request_progress();
            }
        };
        // Without the thread there are no progress reports, and all else is the same.
        drop(std::thread::Builder::new().name("progress".into()).spawn(poll));
    });
}

/// Returns true if Ctrl-C has cancelled the command.
pub(super) fn cancelled() -> bool {
    CANCELLED.load(Ordering::Relaxed)
}

/// The first failure to write to standard output.
static OUTPUT_FAILURE: Mutex<Option<String>> = Mutex::new(None);

/// Writes to standard output, with characters that control a terminal shown as escapes.
pub(super) fn print(text: &str) {
    print_exact(&escaped(text));
}

/// Writes a JSON object and a line end to standard output.
pub(super) fn print_json(json: &str) {
    print_exact(&format!("{}\n", escaped_json(json)));
}

/// Writes text to standard output as it is, without escaping. A failure is kept for [`output_failure`]; a closed output
/// is none: `modl ... | head` is quiet.
pub(super) fn print_exact(text: &str) {
    print_bytes(text.as_bytes());
}

/// Writes bytes to standard output, as [`print_exact`] writes text.
pub(super) fn print_bytes(bytes: &[u8]) {
    let mut out = io::stdout().lock();
    note_output(out.write_all(bytes).and_then(|()| out.flush()));
}

/// Stores the error of a failed write to standard output, unless an earlier one is stored; a pipe that its reader
/// closed counts as no failure.
pub(super) fn note_output(written: io::Result<()>) {
    if let Err(e) = written
        && e.kind() != io::ErrorKind::BrokenPipe
    {
        let mut failure = OUTPUT_FAILURE.lock().unwrap_or_else(PoisonError::into_inner);
        failure.get_or_insert_with(|| system_words(&e));
    }
}

/// Returns the operating system's message for the first failed write to standard output; `None` if none failed.
pub(super) fn output_failure() -> Option<String> {
    OUTPUT_FAILURE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Writes to standard error, with characters that control a terminal shown as escapes. Failures are ignored.
pub(super) fn print_error(text: &str) {
    print_styled(&escaped(text));
}

/// Writes text with its own colour codes to standard error; source text quoted in it must have been escaped. Failures
/// are ignored.
pub(super) fn print_styled(text: &str) {
    drop(io::stderr().lock().write_all(text.as_bytes()));
}

/// A value that a program printed, in the JSON object.
#[derive(Debug, Serialize)]
pub(super) struct JsonValue {
    /// The index in `printed` of the line that shows the value, or of the first of its lines, from 0.
    pub line: usize,
    /// The text that was printed for the value, and the value by its kind.
    #[serde(flatten)]
    pub printed: PrintedValue,
}

/// The host of a run: it prints to a terminal, and writes files below the output folder.
#[derive(Debug)]
pub(super) struct Terminal {
    folder: PathBuf,
    /// The lines that were printed, if they go into a JSON object; `None` if they go to standard output.
    pub printed: Option<Vec<String>>,
    /// The printed values, each with the index of its line in `printed`; empty without JSON.
    pub values: Vec<JsonValue>,
    /// The record of the files that the run depends on, for a run that ends once they change; `None` for others.
    pub watched: Option<Arc<Watched>>,
    shows_progress: bool,
    progress_shown: bool,
    begun: Instant,
}

impl Terminal {
    /// Returns the host for the options of a call. Progress is shown only if standard error is a terminal.
    pub(super) fn new(globals: &Globals) -> Terminal {
        let shows_progress = !globals.json && io::stderr().is_terminal();
        if shows_progress {
            poll_progress();
        }
        Terminal {
            folder: globals.out.clone(),
            printed: globals.json.then(Vec::new),
            values: Vec::new(),
            watched: None,
            shows_progress,
            progress_shown: false,
            begun: Instant::now(),
        }
    }

    /// Clears the progress line before something else is printed.
    pub(super) fn clear_progress(&mut self) {
        if std::mem::take(&mut self.progress_shown) {
            print_styled("\r\x1b[K");
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

    fn print_value(&mut self, value: PrintedValue) {
        if let Some(lines) = &self.printed {
            self.values.push(JsonValue { line: lines.len(), printed: value });
        }
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        output::write(&self.folder, path, bytes)
    }

    fn progress(&mut self, line: &str) {
        if self.shows_progress {
            // A line that wraps could not be cleared.
            let wide = super::report::width().saturating_sub(1);
            let shown: String = escaped(line).chars().take(wide).collect();
            print_styled(&format!("\r{shown}\x1b[K"));
            self.progress_shown = true;
        }
    }

    fn cancel_state(&self) -> CancelState {
        cancel_state()
    }

    fn elapsed(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}
