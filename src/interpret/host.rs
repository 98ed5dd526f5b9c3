//! The interface of a running program to the outside, and the outcome of a run.

use super::printed::PrintedValue;
use crate::interrupt::CancelState;
use crate::plan::Plan;
use crate::source::{Diagnostic, Span};

/// The reason that an output can't be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteError {
    /// The path, or a link on it, leads out of the output folder.
    Outside,
    /// Another failure, as a message in the words of the operating system.
    Failed(String),
}

/// The environment of a run: the command line gives it a terminal and an output folder, tests a buffer.
pub trait Host {
    /// Prints one line of the program, without its line end.
    fn print(&mut self, line: &str);

    /// Receives a value that the next printed line, or lines, show; only where [`Options::values`] asks for that.
    fn print_value(&mut self, _value: PrintedValue) {}

    /// Writes a whole file below the output folder, or nothing; returns the path to show. `path` is relative to the
    /// output folder, with forward slashes. `bytes`: the contents of the file.
    ///
    /// # Errors
    /// [`WriteError`] where the path leads out of the output folder, or the system refuses.
    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError>;

    /// Shows a line about the progress of long work, on terminals only.
    fn progress(&mut self, line: &str);

    /// Returns the state by which the user cancels the run; long work checks it every few milliseconds. By
    /// default a new one, which nobody cancels.
    fn cancel_state(&self) -> CancelState {
        CancelState::default()
    }

    /// Returns the time since some fixed instant, s, for timeouts, which refuse and choose nothing. Without a clock,
    /// 0: then there are no timeouts.
    fn elapsed(&self) -> f64 {
        0.0
    }
}

/// A host that discards what a program prints and writes.
pub struct SilentHost(pub CancelState);

impl Host for SilentHost {
    fn print(&mut self, _: &str) {}

    fn write(&mut self, path: &str, _: &[u8]) -> Result<String, WriteError> {
        Ok(path.to_owned())
    }

    fn progress(&mut self, _: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.0.clone()
    }
}

/// The part of a program that is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Checking: every declaration is elaborated with its defaults, and every instance that statements make; nothing
    /// is planned, verified, printed or written.
    Check,
    /// Running: the statements of the file are executed.
    Run,
    /// Testing: the tests of the file are executed, and none of its statements.
    Test,
}

/// The choices of a user for a run, such as seed, limits and threads.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The text that the names of the tests to run contain; `None`, the default: all tests.
    pub filter: Option<String>,
    /// The seed of planners that are given none by `seed:`; every plan records the seed that it was made with. Default
    /// 0.
    pub seed: u64,
    /// True if a page is drawn of every plan that is emitted, and of the declared robots if the run wrote no `.html`.
    /// Default false.
    pub pages: bool,
    /// The name of the pages that are drawn of each plan that is verified, without the ending; `None`, the default: none
    /// are.
    pub verified_pages: Option<String>,
    /// True if the plans that are emitted are collected in [`Outcome::plans`], good or not: nothing judges them, and no file
    /// is written. Default false.
    pub collects: bool,
    /// The command that runs the program again, for the pages that the run draws; may be empty, as by default.
    pub command: String,
    /// The width and the height of still pictures, pixels; `None`, the default: their natural size.
    pub picture: Option<(usize, usize)>,
    /// The bounds on what the program may use, with the defaults that its fields state.
    pub limits: Limits,
    /// True if the host is told the values that are printed, besides their text. Default false.
    pub values: bool,
    /// True if the values of top-level `let`s are listed in [`Outcome::constants`]. Default false.
    pub constants: bool,
    /// The number of threads that a planner may use; 0, the default, counts as 1. No result depends on it.
    pub threads: usize,
}

/// The bounds on what a program may use. Going beyond one is an error: it ends the run, leaves a value unknown, or
/// a plan unverified.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The greatest number of evaluation steps: expressions, and passes of loops over ranges. Default 50 million.
    pub steps: u64,
    /// The greatest depth of calls within calls. Default 20 000.
    pub recursion: usize,
    /// The greatest number of elements of one list. Default 1 million.
    pub list: usize,
    /// The greatest length of one text, bytes. Default 2^24.
    pub text: usize,
    /// The greatest number of decimal digits of one whole number. Default 10 000.
    pub digits: usize,
    /// The greatest number of modules of one robot. Default 10 000.
    pub modules: usize,
    /// The greatest number of robots of one scene, what they carry included. Default 256.
    pub robots: usize,
    /// The greatest number of samples of one verification. Default 2 million.
    pub samples: usize,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits {
            steps: 50_000_000,
            recursion: 20_000,
            list: 1_000_000,
            text: 1 << 24,
            digits: 10_000,
            modules: 10_000,
            robots: 256,
            samples: 2_000_000,
        }
    }
}

/// The outcome of a `test` of the program in [`Mode::Test`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestResult {
    /// The name of the test as the program states it.
    pub name: String,
    /// True if the test passed. The first diagnostic of a failed test is also in [`Outcome::diagnostics`].
    pub passed: bool,
}

/// The verdict on a plan, in short.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// True if nothing failed.
    pub ok: bool,
    /// The headline with the least margin, or with the first failure: `verified under full dynamics, least margin 12 %
    /// (torque)`.
    pub words: String,
}

/// The outcome of a run: all that it found, tested and wrote, also if it was cancelled.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The diagnostics: errors first, then warnings, then notes; else as they were found.
    pub diagnostics: Vec<Diagnostic>,
    /// The tests that were run, in the order of the text; empty but in [`Mode::Test`].
    pub tests: Vec<TestResult>,
    /// The paths written, in the order of writing, as the host showed them.
    pub written: Vec<String>,
    /// The plans that were emitted, each with its path, where [`Options::collects`].
    pub plans: Vec<(String, Plan)>,
    /// The verdicts on plans that the run judged, by the calls that asked for them: of each call the first that failed, or
    /// else the one with the least margin.
    pub judgements: Vec<(Span, Judgement)>,
    /// The values of top-level `let`s of the files of the project that are numbers or quantities, as text, by the places of their
    /// expressions; empty unless [`Options::constants`].
    pub constants: Vec<(Span, String)>,
    /// True if the user ended the run.
    pub cancelled: bool,
}
