//! Construction of the tree from pest's pairs: the parts common to all of the grammar.

use super::ast::*;
use super::parse::{Node, Rule};
use crate::source::{Code, Diagnostic, FileId, Span, Symbol};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// The builder of the syntax tree of one file from pest's parse trees, piece by piece.
pub(super) struct Builder<'t> {
    /// The identity of the file.
    pub(super) file: FileId,
    /// The whole text, as written.
    pub(super) text: &'t str,
    /// The whole text as the grammar reads it: of the same length, comments and odd characters replaced.
    pub(super) read: &'t str,
    /// All comments of the file, in order of position.
    pub(super) comments: &'t [Comment],
    /// The offset in bytes, in the whole text, of the piece being built.
    pub(super) base: usize,
    /// The number of bytes by which the first word of the piece is longer than the misspelt one in the file.
    pub(super) longer: usize,
    /// The smallest offset in bytes at which a span may begin or end; smaller ones are raised to it.
    pub(super) least: usize,
    /// The largest offset in bytes at which a span may begin or end: text after it was added so that the piece can be
    /// parsed.
    pub(super) limit: usize,
    /// The offset in bytes of a hole `_` that stands for a value that could not be parsed; `None` if there is none.
    pub(super) faulty_value: Option<usize>,
    /// The diagnostics so far.
    pub(super) diagnostics: Vec<Diagnostic>,
    /// The recursion depth of the expression builder: the number of expressions that are open.
    pub(super) depth: usize,
    /// The recursion depth of the type builder: the number of types that are open.
    pub(super) type_depth: usize,
    /// The offset in bytes of the last piece for which deep nesting was reported; `None` if it was for none.
    pub(super) deep_reported: Option<usize>,
    /// The names that unreadable pieces would have declared.
    pub(super) unread: Vec<Symbol>,
    symbols: HashMap<&'t str, Symbol, BuildHasherDefault<NameHasher>>,
}

impl<'t> Builder<'t> {
    /// Returns a builder at the start of the file. `text`: the text of the file; `read`: the text of equal length that
    /// the grammar reads, with comments blanked; `comments`: the comments, in order.
    pub(super) fn new(file: FileId, text: &'t str, read: &'t str, comments: &'t [Comment]) -> Builder<'t> {
        Builder {
            file,
            text,
            read,
            comments,
            base: 0,
            longer: 0,
            least: 0,
            limit: text.len(),
            faulty_value: None,
            diagnostics: Vec::new(),
            depth: 0,
            type_depth: 0,
            deep_reported: None,
            unread: Vec::new(),
            symbols: HashMap::default(),
        }
    }

    /// Returns the span of a node in the file, extended to whole characters.
    pub(super) fn span(&self, node: &Node) -> Span {
        let span = node.as_span();
        self.at(span.start(), span.end())
    }

    /// Returns the bytes `start..end` of the piece being built as a span of the file, extended to whole characters.
    pub(super) fn at(&self, start: usize, end: usize) -> Span {
        whole_characters(self.text, Span::new(self.file, self.offset(start), self.offset(end)))
    }

    /// Returns an offset in the piece being built as one in the file.
    fn offset(&self, offset: usize) -> usize {
        (self.base + offset).saturating_sub(self.longer).max(self.least).min(self.limit)
    }

    /// Adds an error at `span`, and returns it so that hints can be added.
    pub(super) fn error(&mut self, code: Code, message: impl Into<String>, span: Span) -> &mut Diagnostic {
        self.diagnostics.push(Diagnostic::error(code, message).label(span, ""));
        self.diagnostics.last_mut().expect("one was just added")
    }

    /// Returns the text of a span as a symbol.
    pub(super) fn symbol(&mut self, span: Span) -> Symbol {
        let text = &self.text[span.range()];
        *self.symbols.entry(text).or_insert_with(|| Symbol::new(text))
    }

    /// Returns the text of a node as a name, with its span.
    pub(super) fn word(&mut self, node: Node) -> Name {
        let span = self.span(&node);
        Name { text: self.symbol(span), span }
    }

    /// Returns a declared name; reports a reserved word, such as `true` or `X`, which can't be declared.
    pub(super) fn declared(&mut self, node: Node) -> Name {
        let name = self.word(node);
        if let taken @ ("true" | "false" | "X" | "Y" | "Z") = name.text.as_str() {
            let what = if matches!(taken, "true" | "false") { "a truth value" } else { "an axis" };
            self.error(
                crate::source::code::SYNTAX,
                format!("`{taken}` is {what} and cannot be a name"),
                name.span,
            );
        }
        name
    }

    /// Returns the words of a path as names, in order.
    pub(super) fn words(&mut self, node: Node) -> Vec<Name> {
        node.into_inner().map(|word| self.word(word)).collect()
    }

    /// Returns the text of the `///` lines before the offset `start`, in bytes of the file, without the marks; `None`
    /// if there are none. Only blanks and other comments may stand between.
    pub(super) fn doc(&self, start: u32) -> Option<String> {
        let before = self.comments.partition_point(|comment| comment.span.start < start);
        let mut lines = Vec::new();
        let mut edge = start as usize;
        for comment in self.comments[..before].iter().rev() {
            let between = &self.text[(comment.span.end as usize).min(edge)..edge];
            if !between.bytes().all(|b| b.is_ascii_whitespace()) || comment.kind == CommentKind::FileDoc {
                break;
            }
            edge = comment.span.start as usize;
            if comment.kind == CommentKind::ItemDoc {
                lines.push(doc_line(&self.text[comment.span.range()]));
            }
        }
        lines.reverse();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }

    /// Returns the text of the `//!` lines of the file, without the marks; `None` if there are none.
    pub(super) fn file_doc(&self) -> Option<String> {
        let lines: Vec<&str> = (self.comments.iter())
            .filter(|comment| comment.kind == CommentKind::FileDoc)
            .map(|comment| doc_line(&self.text[comment.span.range()]))
            .collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }
}

/// The FNV-1a hash: fast for short names. Collisions made on purpose would slow down only their author's
/// file.
struct NameHasher(u64);

impl Default for NameHasher {
    fn default() -> NameHasher {
        NameHasher(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher for NameHasher {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Returns a span extended to whole characters. The text that the grammar reads may have several characters
/// in place of one.
pub(super) fn whole_characters(text: &str, mut span: Span) -> Span {
    // A place behind the end, of what is missing there, is the end.
    let end = text.len() as u32;
    (span.start, span.end) = (span.start.min(end), span.end.min(end));
    while !text.is_char_boundary(span.start as usize) {
        span.start -= 1;
    }
    while !text.is_char_boundary(span.end as usize) {
        span.end += 1;
    }
    span
}

/// Returns the text of a documentation line after `///` or `//!` and one space.
fn doc_line(comment: &str) -> &str {
    let text = comment[3..].trim_end();
    text.strip_prefix(' ').unwrap_or(text)
}

/// Returns the next child node. Panics if there is none, which the grammar excludes.
pub(super) fn next<'i>(nodes: &mut impl Iterator<Item = Node<'i>>) -> Node<'i> {
    nodes.next().expect("the grammar gives this node another child")
}

/// Returns the next child node if it is of this rule; otherwise `None`, and the child stays the next.
pub(super) fn next_if<'i>(nodes: &mut pest::iterators::Pairs<'i, Rule>, rule: Rule) -> Option<Node<'i>> {
    nodes.peek().is_some_and(|node| node.as_rule() == rule).then(|| next(nodes))
}
