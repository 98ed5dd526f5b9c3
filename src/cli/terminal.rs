//! The terminal: what a program prints, progress, and the wish to end.

use super::arguments::Globals;
use super::output;
use super::watch::Watched;
use crate::interpret::{Host, WriteError};
use crate::interrupt::Interrupt;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, Once, PoisonError};
use std::time::{Duration, Instant};

/// Whether the user wants the command to end.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// The wish that the run at hand ends; the user's, or that of a newer text.
static INTERRUPT: LazyLock<Mutex<Interrupt>> = LazyLock::new(Mutex::default);

/// A run that is asked to end gets this long to do so by itself.
const PATIENCE: Duration = Duration::from_millis(400);

/// Who presses Ctrl-C in a session waits no longer than this for work to end by itself.
const PATIENCE_OF_SESSION: Duration = Duration::from_millis(50);

/// A Ctrl-C this soon after another was meant for the same work.
const ECHO: Duration = Duration::from_secs(1);

/// How often work is asked how far it is.
const CURIOSITY: Duration = Duration::from_millis(100);

/// From here on Ctrl-C asks the run to end, and ends the process if it does not soon: files are
/// written whole or not at all, so nothing is lost by that.
pub fn listen_for_cancel() {
    let on_signal = || {
        CANCELLED.store(true, Ordering::Relaxed);
        interrupt().raise();
        std::thread::park_timeout(PATIENCE);
        std::process::exit(130);
    };
    // Where signals can't be had, Ctrl-C ends the process, which is as good.
    drop(ctrlc::set_handler(on_signal));
}

/// What ends the run at hand.
pub fn interrupt() -> Interrupt {
    INTERRUPT.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Whether nobody waits for somebody to type, in a session.
static BUSY: AtomicBool = AtomicBool::new(true);

/// When somebody last typed something.
static BEGUN: Mutex<Option<Instant>> = Mutex::new(None);

/// When Ctrl-C was last pressed while a session worked.
static PRESSED: Mutex<Option<Instant>> = Mutex::new(None);

/// From here on Ctrl-C ends what a session works on; whatever else wants the process to end has its way
/// while it waits for somebody to type.
pub fn listen_for_interrupt() {
    let on_signal = || {
        let mut pressed = PRESSED.lock().unwrap_or_else(PoisonError::into_inner);
        if !BUSY.load(Ordering::Relaxed) {
            if pressed.is_none_or(|before| before.elapsed() > ECHO) {
                std::process::exit(130);
            }
            return;
        }
        *pressed = Some(Instant::now());
        let interrupt = interrupt();
        interrupt.raise();
        std::thread::spawn(move || {
            std::thread::park_timeout(PATIENCE_OF_SESSION);
            interrupt.give_up();
        });
    };
    drop(ctrlc::set_handler(on_signal));
}

/// Waits for somebody to type, who may end the process by a signal.
pub fn idle<T>(wait: impl FnOnce() -> T) -> T {
    BUSY.store(false, Ordering::Relaxed);
    let typed = wait();
    *BEGUN.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    BUSY.store(true, Ordering::Relaxed);
    typed
}

/// Begins work that Ctrl-C ends: also one that was pressed since somebody typed what is to be done.
pub fn begin_work() {
    let interrupt = interrupt();
    interrupt.lower();
    let at = |clock: &Mutex<Option<Instant>>| *clock.lock().unwrap_or_else(PoisonError::into_inner);
    if at(&PRESSED) > at(&BEGUN) {
        interrupt.raise();
    }
}

/// Waits for the end of work that was interrupted, but not for long; says whether it came. If it did not,
/// what is begun now has another interrupt.
pub fn settled(settle: impl FnOnce() -> bool) -> bool {
    let old = interrupt();
    let impatient = old.clone();
    std::thread::spawn(move || {
        std::thread::park_timeout(PATIENCE);
        impatient.give_up();
    });
    let settled = settle();
    if !settled {
        *INTERRUPT.lock().unwrap_or_else(PoisonError::into_inner) = Interrupt::default();
    }
    settled
}

/// Asks whatever work goes on how far it is, again and again.
fn be_curious() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let asking = || {
            loop {
                std::thread::park_timeout(CURIOSITY);
                interrupt().ask();
            }
        };
        // Without it nothing is told, and all else is the same.
        drop(std::thread::Builder::new().name("curiosity".into()).spawn(asking));
    });
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
        let shows_progress = !globals.json && io::stderr().is_terminal();
        if shows_progress {
            be_curious();
        }
        Terminal {
            folder: globals.out.clone(),
            printed: globals.json.then(Vec::new),
            watched: None,
            shows_progress,
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
            // A line that is broken can't be taken back.
            let wide = super::report::width().saturating_sub(1);
            let shown: String = line.chars().take(wide).collect();
            print_error(&format!("\r{shown}\x1b[K"));
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
