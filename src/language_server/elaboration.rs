//! The diagnostics that depend on values: every declaration elaborated with its defaults, on a thread that a newer text
//! cancels.

use super::analysis::Analysis;
use crate::interpret::{Host, Mode, Options, WriteError};
use crate::interrupt::CancelState;
use crate::source::Diagnostic;

/// A host to which a program neither prints nor writes.
struct Silent(CancelState);

impl Host for Silent {
    fn print(&mut self, _line: &str) {}

    fn write(&mut self, path: &str, _bytes: &[u8]) -> Result<String, WriteError> {
        Ok(path.to_owned())
    }

    fn progress(&mut self, _line: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.0.clone()
    }
}

/// Elaborates a program without errors of types, and returns what was found; `None` if it was cancelled.
pub(super) fn diagnostics(analysis: &Analysis, cancel: &CancelState) -> Option<Vec<Diagnostic>> {
    let mut host = Silent(cancel.clone());
    let options = Options::default();
    let outcome = crate::execute::run(&analysis.checked, Mode::Check, &*analysis.files, &mut host, &options);
    (!cancel.is_cancelled()).then_some(outcome.diagnostics)
}
