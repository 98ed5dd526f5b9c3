//! Why evaluation ends early.

use crate::source::{Code, Diagnostic, Span};

/// A fault ends the expression that it is in and leaves an unknown value; a halt ends the run.
#[derive(Debug)]
pub enum Stop {
    /// Not reported yet.
    Fault(Box<Diagnostic>),
    /// A limit was reached or the user wants the run to end; already reported.
    Halt,
}

/// The result of evaluating.
pub type Eval<T> = Result<T, Stop>;

impl From<Diagnostic> for Stop {
    fn from(diagnostic: Diagnostic) -> Stop {
        Stop::Fault(Box::new(diagnostic))
    }
}

/// A fault with one label that repeats nothing of the message.
pub fn fault(code: Code, span: Span, message: impl Into<String>, label: impl Into<String>) -> Stop {
    Diagnostic::error(code, message).label(span, label).into()
}
