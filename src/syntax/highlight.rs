//! Syntax highlighting of a text, also of one that is being typed.

use super::lex::TokenKind;
use super::outline::Outline;
use super::words::{CONFIG, ITEMS, MODULE, RESERVED, STATEMENTS, TRUSS};
use std::ops::Range;

/// The classes of text that syntax highlighting tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A keyword, or a word that is reserved.
    Keyword,
    /// The name of a type or of a declaration with instances.
    Type,
    /// A number with its unit.
    Number,
    /// A text, with what stands in its `{ }`.
    Text,
    /// A comment.
    Comment,
}

/// Returns the highlighted pieces of a text as (range of bytes, class), in order; all else is plain. Empty for a text
/// that is too large or nests too deeply.
pub fn classes(text: &str) -> Vec<(Range<usize>, Class)> {
    let Some(outline) = Outline::of(text) else { return Vec::new() };
    let tokens = outline.tokens.iter().filter_map(|token| {
        let class = match token.kind {
            TokenKind::Number => Class::Number,
            TokenKind::Text { .. } | TokenKind::UnclosedText | TokenKind::UnclosedRawText => Class::Text,
            TokenKind::LineComment | TokenKind::BlockComment { .. } | TokenKind::UnclosedComment => {
                Class::Comment
            }
            TokenKind::Word => {
                let begins = outline.begins.contains(&token.start) || begins_a_line(text, token.start);
                let changes = text[token.end..].trim_start().starts_with('{');
                match &text[token.start..token.end] {
                    "with" if changes => Class::Keyword,
                    found => word(found, begins)?,
                }
            }
            _ => return None,
        };
        Some((token.start..token.end, class))
    });
    tokens.collect()
}

/// Returns true if an offset is at the beginning of a line, where clauses of an incomplete body begin.
fn begins_a_line(text: &str, at: usize) -> bool {
    text[..at].rsplit('\n').next().is_none_or(|before| before.trim().is_empty())
}

/// Returns the class of a word, `None` for a plain one; `begins` is true at the beginning of a statement or
/// clause.
fn word(word: &str, begins: bool) -> Option<Class> {
    let clauses = [ITEMS, STATEMENTS, MODULE, CONFIG, TRUSS];
    if RESERVED.contains(&word) && word.len() > 1 || begins && clauses.iter().any(|c| c.contains(&word)) {
        Some(Class::Keyword)
    } else if word.starts_with(|c: char| c.is_ascii_uppercase()) && word.len() > 1 {
        Some(Class::Type)
    } else {
        None
    }
}
