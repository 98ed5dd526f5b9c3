//! Diagnostics as data for tools; the form is described in `docs/json.md`.

use super::render::{Style, sorted};
use super::{Code, Diagnostic, Label, Severity, Sources};
use serde::Serialize;

/// One diagnostic with places that an editor can jump to.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub struct JsonDiagnostic {
    pub code: String,
    pub severity: Severity,
    pub message: String,
    /// The first one is the primary one.
    pub labels: Vec<JsonLabel>,
    pub hints: Vec<String>,
}

/// A place in a file. Lines and columns count from 1, columns count characters.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub struct JsonLabel {
    pub file: String,
    /// Whether the file belongs to the standard library and may not exist on disk.
    pub library: bool,
    /// In bytes from the beginning of the file.
    pub offset: usize,
    /// In bytes.
    pub length: usize,
    pub line: usize,
    pub column: usize,
    /// Where the first character after the label stands.
    pub end_line: usize,
    pub end_column: usize,
    pub text: String,
}

/// The diagnostics in order, each once, as [`render`](super::render::render) draws them.
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
