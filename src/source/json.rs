//! Diagnostics as JSON for tools; `docs/json.md` describes the format.

use super::render::{Style, sorted};
use super::{Code, Diagnostic, Label, Severity, Sources};
use serde::Serialize;

/// A diagnostic as JSON, with positions that an editor can jump to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct JsonDiagnostic {
    /// The code of the diagnostic, such as `E0201`.
    pub code: String,
    /// The severity in lower case: `error`, `warning` or `note`.
    pub severity: Severity,
    /// The message: one sentence without a final full stop, in the user's units.
    pub message: String,
    /// The labels, which point at the source; the first one is the primary one. Empty if no text is at fault.
    pub labels: Vec<JsonLabel>,
    /// The hints for correction; may be empty.
    pub hints: Vec<String>,
}

/// A label as JSON: a span in a file. Lines and columns count from 1; columns count characters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct JsonLabel {
    /// The name of the file, with the project folder before it as [`Style::name`] gives it.
    pub file: String,
    /// True if the file belongs to the standard library and may not exist on disk.
    pub library: bool,
    /// The offset of the span's first byte in the file, from 0.
    pub offset: usize,
    /// The length of the span in bytes.
    pub length: usize,
    /// The line of the span's first character, from 1.
    pub line: usize,
    /// The column of the span's first character, from 1, in characters.
    pub column: usize,
    /// The line of the first character after the span, from 1.
    pub end_line: usize,
    /// The column of the first character after the span, from 1, in characters.
    pub end_column: usize,
    /// A few words about the span; may be empty.
    pub text: String,
}

/// Returns the diagnostics in the form of JSON, sorted and without duplicates, as [`render`](super::render::render)
/// draws them. `sources` holds the texts that they point at; `style` gives the names of files. Panics if a label's text
/// is not among them.
pub fn to_json(sources: &Sources, diagnostics: &[Diagnostic], style: &Style) -> Vec<JsonDiagnostic> {
    let one = |diagnostic: &&Diagnostic| {
        let Code(code) = diagnostic.code;
        JsonDiagnostic {
            code: code.to_owned(),
            severity: diagnostic.severity,
            message: diagnostic.message.clone(),
            labels: diagnostic.labels.iter().map(|label| place(sources, label, style)).collect(),
            hints: diagnostic.hints.clone(),
        }
    };
    sorted(diagnostics).iter().map(one).collect()
}

/// Returns a label with its positions.
fn place(sources: &Sources, label: &Label, style: &Style) -> JsonLabel {
    let file = sources.file(label.span.file);
    let start = file.line_column(label.span.start as usize);
    let end = file.line_column(label.span.end as usize);
    JsonLabel {
        file: style.name(&file.name, file.library),
        library: file.library,
        offset: label.span.start as usize,
        length: (label.span.end - label.span.start) as usize,
        line: start.line,
        column: start.column,
        end_line: end.line,
        end_column: end.column,
        text: label.text.clone(),
    }
}
