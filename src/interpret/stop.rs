//! The reasons that evaluation ends early.

use crate::source::{Code, Diagnostic, Span};

/// The reason that evaluation ends early. A fault ends the expression that it is in, whose value becomes unknown; a
/// halt ends the run.
#[derive(Debug)]
pub enum Stop {
    /// A fault: a mistake of the program, not reported yet.
    Fault(Box<Diagnostic>),
    /// A halt: a limit was reached or the user wants the run to end, which has been reported.
    Halt,
}

/// The result of an evaluation.
///
/// Every function that returns it may end early: with [`Stop::Fault`] where the program is mistaken at that point,
/// which [`recover`](super::interpreter::Interpreter::recover) and
/// [`attempt`](super::interpreter::Interpreter::attempt) turn into a report and an unknown value; with [`Stop::Halt`]
/// where a limit is reached or the user cancels, which passes through to the end of the run. A function with an `#
/// Errors` section also refuses something by itself.
pub type Eval<T> = Result<T, Stop>;

impl From<Diagnostic> for Stop {
    fn from(diagnostic: Diagnostic) -> Stop {
        Stop::Fault(Box::new(diagnostic))
    }
}

/// Returns a fault with this code and message, and one label at `span`, whose text should add to the message.
pub fn fault(code: Code, span: Span, message: impl Into<String>, label: impl Into<String>) -> Stop {
    Diagnostic::error(code, message).label(span, label).into()
}
