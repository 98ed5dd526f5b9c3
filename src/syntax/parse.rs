//! The door of the room: text in, tree out. The only user of pest, together with the builders.

use super::ast;
use super::build::Builder;
use super::scan::scan;
use crate::source::{Diagnostic, FileId, Span, code};
use pest::Parser as _;

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
    let scan = scan(id, text);
    let mut builder = Builder::new(id, text, &scan.comments);
    let mut items = Vec::new();
    let ends = scan.chunks.iter().skip(1).copied().chain([text.len()]);
    for (&start, end) in scan.chunks.iter().zip(ends) {
        builder.base = start;
        match Grammar::parse(Rule::chunk, &scan.text[start..end]) {
            Ok(mut nodes) => builder.chunk(nodes.next().expect("a parse has one root"), &mut items),
            Err(error) => {
                let at = start
                    + match error.location {
                        pest::error::InputLocation::Pos(at) | pest::error::InputLocation::Span((at, _)) => at,
                    };
                let span = Span::new(id, at, at);
                builder.error(code::SYNTAX, "this cannot be read", span);
                items.push(ast::Item {
                    span: Span::new(id, start, end),
                    doc: None,
                    kind: ast::ItemKind::Error,
                });
            }
        }
    }
    let doc = builder.file_doc();
    let mut diagnostics = builder.diagnostics;
    diagnostics.extend(scan.diagnostics);
    diagnostics.sort_by_key(|d| d.span().map(|span| (span.start, span.end)));
    Parsed { file: ast::File { id, doc, items, comments: scan.comments }, diagnostics }
}
