//! The door of the room: text in, tree out. The only user of pest, together with the builders.

use super::ast;
use super::build::Builder;
use super::recover::Parser;
use super::scan::scan;
use crate::source::{Diagnostic, FileId, Span, code};
use pest::Parser as _;
use pest::error::ErrorVariant;
use std::sync::{Mutex, PoisonError};

/// How deep brackets, comments and types may nest.
pub const NESTING_MAX: usize = 200;
/// How high the tree of one expression may grow: later rooms walk it by recursion.
pub const HEIGHT_MAX: usize = 500;
/// How long a text may be, in bytes.
pub const TEXT_MAX: usize = 8 << 20;

#[derive(pest_derive::Parser)]
#[grammar = "../grammar/modl.pest"]
struct Grammar;

/// A piece of text as pest saw it.
pub(super) type Node<'i> = pest::iterators::Pair<'i, Rule>;

/// How many mistakes of one file are told.
pub const DIAGNOSTICS_MAX: usize = 200;

/// What parsing a file yields.
#[derive(Clone, Debug)]
pub struct Parsed {
    pub file: ast::File,
    /// In order of position.
    pub diagnostics: Vec<Diagnostic>,
}

/// The tree of a file. Never fails: pieces that cannot be parsed become `Error` nodes, each with a
/// diagnostic.
pub fn parse(id: FileId, text: &str) -> Parsed {
    if text.len() > TEXT_MAX {
        return too_large(id, text);
    }
    let scan = scan(id, text);
    let mut parser = Parser::new(Builder::new(id, text, &scan.text, &scan.comments), &scan);
    let mut items = Vec::new();
    for range in scan.ranges() {
        parser.chunk(range, &mut items);
    }
    let doc = parser.builder.file_doc();
    let Builder { mut diagnostics, unread, .. } = parser.builder;
    diagnostics.extend(scan.diagnostics);
    diagnostics.sort_by_key(|d| d.span().map(|span| (span.start, span.end)));
    diagnostics.truncate(DIAGNOSTICS_MAX);
    Parsed { file: ast::File { id, doc, items, comments: scan.comments, unread }, diagnostics }
}

fn too_large(id: FileId, text: &str) -> Parsed {
    let message = format!("the text has {} bytes, and {TEXT_MAX} is the limit", text.len());
    let diagnostic = Diagnostic::error(code::TOO_LARGE, message)
        .label(Span::new(id, 0, 0), "")
        .hint("put parts of it into files of their own and import them with `use`");
    let file = ast::File { id, doc: None, items: Vec::new(), comments: Vec::new(), unread: Vec::new() };
    Parsed { file, diagnostics: vec![diagnostic] }
}

/// The root of the parse of a whole text by a rule, if it is sound.
pub(super) fn nodes(rule: Rule, text: &str) -> Option<Node<'_>> {
    Grammar::parse(rule, text).ok()?.next()
}

/// Whether a text breaks off: its last piece can't be read, but only because it ends where it does.
pub fn breaks_off(text: &str) -> bool {
    if text.len() > TEXT_MAX {
        return false;
    }
    let scan = scan(FileId(0), text);
    let last = scan.chunks.last().map_or("", |&start| scan.text[start..].trim_end());
    failure(Rule::chunk, last).is_some_and(|failure| failure.at >= last.len())
}

/// Where parsing came to a halt, and what would have let it go on.
#[derive(Clone, Debug)]
pub(super) struct Failure {
    pub(super) at: usize,
    /// Texts of the grammar that would fit there.
    pub(super) wanted: Vec<String>,
    /// Whether a name or number would fit, or a longer one.
    pub(super) wants_word: bool,
    /// Whether the parser ran out of stack.
    pub(super) too_deep: bool,
}

/// pest's switch for detailed errors is one for the whole process.
static DETAIL: Mutex<()> = Mutex::new(());

/// Parses a faulty text once more to learn what was wanted at the furthest place.
pub(super) fn failure(rule: Rule, text: &str) -> Option<Failure> {
    let _guard = DETAIL.lock().unwrap_or_else(PoisonError::into_inner);
    pest::set_error_detail(true);
    let parsed = Grammar::parse(rule, text);
    pest::set_error_detail(false);
    let error = parsed.err()?;
    let mut failure = Failure { at: 0, wanted: Vec::new(), wants_word: false, too_deep: false };
    failure.too_deep = matches!(error.variant, ErrorVariant::CustomError { .. });
    if let Some(attempts) = error.parse_attempts() {
        failure.at = attempts.max_position;
        // pest names the type of these tokens nowhere, but it prints them: a range as `a..z`.
        failure.wanted = attempts.expected_tokens().iter().map(ToString::to_string).collect();
        failure.wants_word = failure.wanted.iter().any(|wanted| wanted == "a..z");
    }
    Some(failure)
}
