//! From pest's pairs to the tree: what all parts of the grammar share.

use super::ast::*;
use super::parse::{Node, Rule};
use crate::source::{Code, Diagnostic, FileId, Span, Symbol};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Builds the tree of one file, piece by piece.
pub(super) struct Builder<'t> {
    pub(super) file: FileId,
    /// The whole text, as written.
    pub(super) text: &'t str,
    /// The same as the grammar reads it.
    pub(super) read: &'t str,
    pub(super) comments: &'t [Comment],
    /// Where the text that the nodes come from begins in the whole text.
    pub(super) base: usize,
    /// No span ends behind this place: what follows was put there to let the piece be parsed.
    pub(super) limit: usize,
    /// A hole here stands for a value that could not be parsed.
    pub(super) faulty_value: Option<usize>,
    pub(super) diagnostics: Vec<Diagnostic>,
    /// How deep the recursion of the expression builder is.
    pub(super) depth: usize,
    pub(super) type_depth: usize,
    /// The base of the piece in which deep nesting was told last.
    pub(super) deep_told: Option<usize>,
    /// Names that unreadable pieces would have declared.
    pub(super) unread: Vec<Symbol>,
    symbols: HashMap<&'t str, Symbol, BuildHasherDefault<NameHasher>>,
}

impl<'t> Builder<'t> {
    pub(super) fn new(file: FileId, text: &'t str, read: &'t str, comments: &'t [Comment]) -> Builder<'t> {
        Builder {
            file,
            text,
            read,
            comments,
            base: 0,
            limit: text.len(),
            faulty_value: None,
            diagnostics: Vec::new(),
            depth: 0,
            type_depth: 0,
            deep_told: None,
            unread: Vec::new(),
            symbols: HashMap::default(),
        }
    }

    pub(super) fn span(&self, node: &Node) -> Span {
        let span = node.as_span();
        self.at(span.start(), span.end())
    }

    /// A range of the text that the nodes come from, as a span of the file.
    pub(super) fn at(&self, start: usize, end: usize) -> Span {
        let (start, end) = (self.base + start, self.base + end);
        whole_characters(self.text, Span::new(self.file, start.min(self.limit), end.min(self.limit)))
    }

    pub(super) fn error(&mut self, code: Code, message: impl Into<String>, span: Span) -> &mut Diagnostic {
        self.diagnostics.push(Diagnostic::error(code, message).label(span, ""));
        self.diagnostics.last_mut().expect("one was just added")
    }

    pub(super) fn symbol(&mut self, span: Span) -> Symbol {
        let text = &self.text[span.range()];
        *self.symbols.entry(text).or_insert_with(|| Symbol::new(text))
    }

    /// Any word as a name.
    pub(super) fn word(&mut self, node: Node) -> Name {
        let span = self.span(&node);
        Name { text: self.symbol(span), span }
    }

    /// The name of something that is declared here: `true`, `X` and their like are taken.
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

    pub(super) fn words(&mut self, node: Node) -> Vec<Name> {
        node.into_inner().map(|word| self.word(word)).collect()
    }

    /// The `///` lines that stand before this place, without the marks.
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

    /// The `//!` lines of the file, without the marks.
    pub(super) fn file_doc(&self) -> Option<String> {
        let lines: Vec<&str> = (self.comments.iter())
            .filter(|comment| comment.kind == CommentKind::FileDoc)
            .map(|comment| doc_line(&self.text[comment.span.range()]))
            .collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }
}

/// FNV-1a: names are short, and nobody gains by making those of his own file collide.
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

/// The span with the characters that it cuts in two; in the text as the grammar reads it they are
/// several.
pub(super) fn whole_characters(text: &str, mut span: Span) -> Span {
    while !text.is_char_boundary(span.start as usize) {
        span.start -= 1;
    }
    while !text.is_char_boundary(span.end as usize) {
        span.end += 1;
    }
    span
}

/// The text of a documentation line behind `///` or `//!` and one space.
fn doc_line(comment: &str) -> &str {
    let text = comment[3..].trim_end();
    text.strip_prefix(' ').unwrap_or(text)
}

/// The next child, where the grammar promises one.
pub(super) fn next<'i>(nodes: &mut impl Iterator<Item = Node<'i>>) -> Node<'i> {
    nodes.next().expect("the grammar gives this node another child")
}

/// The next child if it is of this rule.
pub(super) fn next_if<'i>(nodes: &mut pest::iterators::Pairs<'i, Rule>, rule: Rule) -> Option<Node<'i>> {
    nodes.peek().is_some_and(|node| node.as_rule() == rule).then(|| next(nodes))
}
