//! The entry of the room: [`parse`]. The only user of pest, together with the builders.

use super::ast;
use super::build::Builder;
use super::recover::Parser;
use super::scan::scan;
use crate::interrupt;
use crate::source::{Diagnostic, FileId, Span, code};
use pest::Parser as _;
use pest::error::ErrorVariant;
use std::sync::{Mutex, PoisonError};

/// The deepest nesting of brackets, comments and types, in levels, and the longest chain of `else if`, in branches.
/// The parser goes through them by recursion, which a deeper nesting could take beyond the stack.
pub const NESTING_MAX: usize = 200;
/// The greatest height of the tree of one expression, in nodes from the root to a leaf, both counted; later rooms walk
/// it by recursion.
pub const HEIGHT_MAX: usize = 500;
/// The greatest length of a text, in bytes. A longer one is not parsed. Checking a text of this length takes less than
/// 256 MB and, of most, less than a second.
pub const TEXT_MAX: usize = 750_000;

#[derive(pest_derive::Parser)]
#[grammar = "../grammar/modl.pest"]
struct Grammar;

/// A node of pest's parse of a piece of text.
pub(super) type Node<'i> = pest::iterators::Pair<'i, Rule>;

/// The greatest number of diagnostics that [`parse`] returns for one text; if there are more, the first ones in the
/// text are kept.
pub const DIAGNOSTICS_MAX: usize = 200;

/// The result of [`parse`]: the syntax tree, with `Error` nodes where the text is wrong, and what is wrong there.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// The syntax tree of the file.
    pub file: ast::File,
    /// The diagnostics, in order of position; at most [`DIAGNOSTICS_MAX`], the first ones of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// Returns the syntax tree of the file `id`, whose text is `text`, with diagnostics. Never fails: pieces that cannot
/// be parsed become `Error` nodes, and are reported. A text longer than [`TEXT_MAX`] is reported and gives an empty
/// tree.
pub fn parse(id: FileId, text: &str) -> Parsed {
    if text.len() > TEXT_MAX {
        let file = ast::File { id, doc: None, items: Vec::new(), comments: Vec::new(), unread: Vec::new() };
        return Parsed { file, diagnostics: vec![too_large(id, text.len())] };
    }
    let scan = scan(id, text);
    let mut parser = Parser::new(Builder::new(id, text, &scan.text, &scan.comments), &scan);
    let mut items = Vec::new();
    for range in scan.ranges() {
        interrupt::checkpoint();
        parser.chunk(range, &mut items);
    }
    let doc = parser.builder.file_doc();
    let Builder { mut diagnostics, unread, .. } = parser.builder;
    diagnostics.extend(scan.diagnostics);
    diagnostics.sort_by_key(|d| d.span().map(|span| (span.start, span.end)));
    diagnostics.truncate(DIAGNOSTICS_MAX);
    Parsed { file: ast::File { id, doc, items, comments: scan.comments, unread }, diagnostics }
}

/// Returns the diagnostic of a text that is longer than [`TEXT_MAX`]. `bytes`: its length.
pub fn too_large(id: FileId, bytes: usize) -> Diagnostic {
    let message = format!("the text has {bytes} bytes, and {TEXT_MAX} is the limit");
    Diagnostic::error(code::TOO_LARGE, message)
        .label(Span::new(id, 0, 0), "")
        .hint("put parts of it into files of their own and import them with `use`")
}

/// Returns the root of pest's parse of a whole text by a rule; `None` if it cannot be parsed.
pub(super) fn nodes(rule: Rule, text: &str) -> Option<Node<'_>> {
    Grammar::parse(rule, text).ok()?.next()
}

/// Returns true if a text is incomplete: its last item cannot be parsed, and the parser fails only at its end,
/// so that more text could complete it. False for a text longer than [`TEXT_MAX`].
pub fn breaks_off(text: &str) -> bool {
    if text.len() > TEXT_MAX {
        return false;
    }
    let scan = scan(FileId(0), text);
    let last = scan.chunks.last().map_or("", |&start| scan.text[start..].trim_end());
    failure(Rule::chunk, last).is_some_and(|failure| failure.at >= last.len())
}

/// A failed parse: the furthest offset, and what the grammar would have accepted there.
#[derive(Clone, Debug)]
pub(super) struct Failure {
    /// The offset in bytes at which parsing stopped: the furthest that the parser reached.
    pub(super) at: usize,
    /// The texts that would fit there, in pest's order; a range of characters is shown as `a..z`.
    pub(super) wanted: Vec<String>,
    /// True if a name or number, or a longer one, would fit there.
    pub(super) wants_word: bool,
    /// True if the parser ran out of stack.
    pub(super) too_deep: bool,
}

/// Guards pest's switch for detailed errors, which is global to the process.
static DETAIL: Mutex<()> = Mutex::new(());

/// Parses a text once more, by `rule`, to collect what the grammar would have accepted at the furthest offset reached;
/// `None` if the text parses after all.
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
        // pest has no accessor for the kind of these tokens, but displays a range of characters as `a..z`.
        failure.wanted = attempts.expected_tokens().iter().map(ToString::to_string).collect();
        failure.wants_word = failure.wanted.iter().any(|wanted| wanted == "a..z");
    }
    Some(failure)
}
