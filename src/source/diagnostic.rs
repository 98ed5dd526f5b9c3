//! Diagnostics: one type for every error, warning and note that a user sees.

use super::{Code, Span};

/// The severity of a diagnostic, the most severe first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// An error: the program (or plan) is wrong.
    Error,
    /// A warning: the program may be wrong.
    Warning,
    /// A note: information without fault.
    Note,
}

/// A span of a text with a few words about it: one place that a diagnostic points at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The span of source text that the label points at.
    pub span: Span,
    /// The words about the span that are shown beside it; may be empty.
    pub text: String,
}

/// A diagnostic: a stable code, a message, labels, and hints for correction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The code that names the kind of diagnostic, with a page of its own in `docs/errors/`.
    pub code: Code,
    /// The severity: error, warning or note.
    pub severity: Severity,
    /// The message in the user's words and units: one sentence without a final full stop.
    pub message: String,
    /// The labels, which point at the source; the first one is the primary one. Empty only if no text is at fault.
    pub labels: Vec<Label>,
    /// Hints for correction, each a sentence without a final full stop; may be empty.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// Returns an error with this code and message, and without labels and hints.
    pub fn error(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, Severity::Error, message)
    }

    /// Returns a warning with this code and message, and without labels and hints.
    pub fn warning(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, Severity::Warning, message)
    }

    /// Returns a note with this code and message, and without labels and hints.
    pub fn note(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, Severity::Note, message)
    }

    fn new(code: Code, severity: Severity, message: impl Into<String>) -> Diagnostic {
        Diagnostic { code, severity, message: message.into(), labels: Vec::new(), hints: Vec::new() }
    }

    /// Returns the diagnostic with one more label on `span`; the first one added is the primary one. `text`: the
    /// words about the span.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// Returns the diagnostic with one more hint for correction, a sentence without a final full stop.
    pub fn hint(mut self, text: impl Into<String>) -> Diagnostic {
        self.hints.push(text.into());
        self
    }

    /// Returns true if the severity is [`Severity::Error`].
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// Returns the span of the primary label; `None` if there is no label.
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }
}
