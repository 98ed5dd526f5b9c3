//! The interface of a running program to the outside, and the outcome of a run.

use crate::interrupt::CancelState;
use crate::source::Diagnostic;

/// Why an output can't be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteError {
    /// The path, or a link on it, leads out of the output folder.
    Outside,
    /// Anything else, in the system's words.
    Failed(String),
}

/// The outside of a run: `main` gives it a terminal and an output folder, tests a buffer.
pub trait Host {
    /// One line that the program prints, without its line end.
    fn print(&mut self, line: &str);

    /// Writes a whole file below the output folder, or nothing; gives the path to show.
    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError>;

    /// A line about how far long work has come; shown on terminals only.
    fn progress(&mut self, line: &str);

    /// The token by which the user cancels the run; checked every few milliseconds.
    fn cancel_state(&self) -> CancelState {
        CancelState::default()
    }

    /// Seconds since some instant, for timeouts, which refuse and choose nothing. Without a clock there
    /// are none.
    fn elapsed(&self) -> f64 {
        0.0
    }
}

/// The part of a program that is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Elaborate every declaration with its defaults and every instance that statements make;
    /// plan, verify, print and write nothing.
    Check,
    /// Execute the statements of the file that is run.
    Run,
    /// Execute the tests of the file that is run, and none of its statements.
    Test,
}

/// The choices of a user for a run.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Tests whose name contains this are run.
    pub filter: Option<String>,
    /// Default seed of planners.
    pub seed: u64,
    /// True if every plan that is emitted is drawn, too; where there is none, the declared robots are.
    pub pages: bool,
    /// The command that runs the program again, for the pages that it draws.
    pub command: String,
    /// Width and height of still pictures; `None`: as large as they are by themselves.
    pub picture: Option<(usize, usize)>,
    /// Bounds on what the program may use.
    pub limits: Limits,
    /// Threads that a planner may use, at least one; no result depends on it.
    pub threads: usize,
}

/// Bounds on what a program may use. Reaching one is a diagnostic.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Evaluation steps: expressions evaluated.
    pub steps: u64,
    /// Calls within calls.
    pub recursion: usize,
    /// Elements of one list.
    pub list: usize,
    /// Bytes of one text.
    pub text: usize,
    /// Decimal digits of one whole number.
    pub digits: usize,
    /// Modules of one robot.
    pub modules: usize,
    /// Samples of one verification.
    pub samples: usize,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits {
            steps: 50_000_000,
            recursion: 200,
            list: 1_000_000,
            text: 1 << 24,
            digits: 10_000,
            modules: 10_000,
            samples: 2_000_000,
        }
    }
}

/// The outcome of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestResult {
    /// The name of the test.
    pub name: String,
    /// The first diagnostic of a failed test is also in [`Outcome::diagnostics`].
    pub passed: bool,
}

/// The outcome of a run.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Errors first, then warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
    /// The tests that were run, in order.
    pub tests: Vec<TestResult>,
    /// Paths written, as the host showed them.
    pub written: Vec<String>,
    /// True if the user ended the run.
    pub cancelled: bool,
}
