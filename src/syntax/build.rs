//! From pest's pairs to the tree: what all parts of the grammar share.

use super::ast::*;
use super::parse::{Node, Rule};
use crate::source::{Code, Diagnostic, FileId, Span, Symbol};
use std::collections::HashMap;

/// Builds the tree of one file, piece by piece.
pub(super) struct Builder<'t> {
    pub(super) file: FileId,
    /// The whole text, as written.
    pub(super) text: &'t str,
    pub(super) comments: &'t [Comment],
    /// Where the text that the nodes come from begins in the whole text.
    pub(super) base: usize,
    /// A hole here stands for a value that could not be parsed.
    pub(super) faulty_value: Option<usize>,
    pub(super) diagnostics: Vec<Diagnostic>,
    /// How deep the recursion of the expression builder is.
    pub(super) depth: usize,
    pub(super) type_depth: usize,
    symbols: HashMap<&'t str, Symbol>,
}

impl<'t> Builder<'t> {
    pub(super) fn new(file: FileId, text: &'t str, comments: &'t [Comment]) -> Builder<'t> {
        Builder {
            file,
            text,
            comments,
            base: 0,
            faulty_value: None,
            diagnostics: Vec::new(),
            depth: 0,
            type_depth: 0,
            symbols: HashMap::new(),
        }
    }

    pub(super) fn span(&self, node: &Node) -> Span {
        let span = node.as_span();
        self.at(span.start(), span.end())
    }

    /// A range of the text that the nodes come from, as a span of the file.
    pub(super) fn at(&self, start: usize, end: usize) -> Span {
        let (start, end) = (self.base + start, self.base + end);
        match self.faulty_value {
            // The hole that stands for a faulty value has no text.
            Some(value) => Span::new(self.file, start.min(value), end.min(value)),
            None => Span::new(self.file, start, end),
        }
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
