//! The diagnostics that depend on values: every declaration elaborated with its defaults, on a thread that a newer text
//! cancels.

use super::analysis::Analysis;
use crate::interpret::{Mode, Options, SilentHost};
use crate::interrupt::CancelState;
use crate::source::Diagnostic;

/// Elaborates a program without errors of types, and returns what was found; `None` if it was cancelled.
pub(super) fn diagnostics(analysis: &Analysis, cancel: &CancelState) -> Option<Vec<Diagnostic>> {
    let mut host = SilentHost(cancel.clone());
    let options = Options::default();
    let outcome = crate::execute::run(&analysis.checked, Mode::Check, &*analysis.files, &mut host, &options);
    (!cancel.is_cancelled()).then_some(outcome.diagnostics)
}
