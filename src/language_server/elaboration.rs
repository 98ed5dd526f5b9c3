//! The findings that depend on values: every declaration elaborated with its defaults, on a thread that a newer text
//! cancels.

use super::analysis::Analysis;
use crate::interpret::{Mode, Options, SilentHost};
use crate::interrupt::CancelState;
use crate::source::{Diagnostic, Span};

/// The findings of elaboration.
pub(super) struct Findings {
    /// The diagnostics.
    pub diagnostics: Vec<Diagnostic>,
    /// The values of `let`s, by the places of their expressions.
    pub constants: Vec<(Span, String)>,
}

/// Elaborates a program without errors of types, and returns what was found; `None` if it was cancelled.
pub(super) fn findings(analysis: &Analysis, cancel: &CancelState) -> Option<Findings> {
    let mut host = SilentHost(cancel.clone());
    let options = Options { constants: true, ..Options::default() };
    let outcome = crate::execute::run(&analysis.checked, Mode::Check, &*analysis.files, &mut host, &options);
    let findings = Findings { diagnostics: outcome.diagnostics, constants: outcome.constants };
    (!cancel.is_cancelled()).then_some(findings)
}
