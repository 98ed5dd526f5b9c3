//! Splitting a faulty run of items, clauses or statements into pieces that are parsed on their own.

use super::lex::{Lexer, Token, TokenKind};
use super::words;
use std::ops::Range;

/// Returns the pieces of `range`, as ranges of bytes of `text`, in order. A piece begins at one of `keywords` outside
/// all brackets, or at a line that does not continue the line before. Brackets that are never closed (`unclosed`,
/// their offsets in order) are ignored, so that what follows them can be found.
pub(super) fn split(
    text: &str,
    range: Range<usize>,
    keywords: &[&str],
    unclosed: &[usize],
) -> Vec<Range<usize>> {
    let tokens: Vec<Token> = tokens(text, range.clone());
    let mut starts = Vec::new();
    let mut depth = 0usize;
    // The depth of the bracket in this piece that is never closed.
    let mut broken: Option<usize> = None;
    for (i, token) in tokens.iter().enumerate() {
        match token.kind {
            TokenKind::Open if unclosed.binary_search(&token.start).is_ok() => broken = Some(depth),
            TokenKind::Open => depth += 1,
            TokenKind::Close => {
                depth = depth.saturating_sub(1);
                broken = broken.filter(|at| *at <= depth);
            }
            _ => {}
        }
        let outside = depth == 0 || depth == 1 && token.kind == TokenKind::Open;
        if outside && (starts.is_empty() || begins_piece(text, &tokens, i, keywords, broken.is_some())) {
            starts.push(token.start);
            broken = None;
        }
    }
    let ends = starts.iter().skip(1).copied().chain([range.end]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..trimmed_end(text, start..end)).collect()
}

/// Returns the tokens of a range of bytes, in order, without comments and line breaks. Their offsets are in the whole
/// text.
pub(super) fn tokens(text: &str, range: Range<usize>) -> Vec<Token> {
    let text = &text[..range.end];
    let skipped = [TokenKind::LineBreak, TokenKind::LineComment, TokenKind::UnclosedComment];
    Lexer::new(text, range.start)
        .filter(|t| !skipped.contains(&t.kind) && !matches!(t.kind, TokenKind::BlockComment { .. }))
        .collect()
}

/// Returns the end of a piece without the white space and comments at its end.
fn trimmed_end(text: &str, range: Range<usize>) -> usize {
    tokens(text, range.clone()).last().map_or(range.end, |token| token.end)
}

/// Returns true if a token begins a piece.
fn begins_piece(text: &str, tokens: &[Token], i: usize, keywords: &[&str], broken: bool) -> bool {
    let (token, before) = (tokens[i], tokens[i - 1]);
    let word = (token.kind == TokenKind::Word).then(|| &text[token.start..token.end]);
    let begins_line = text[before.end..token.start].contains('\n');
    if word.is_some_and(|word| keywords.contains(&word)) && leads(text, tokens.get(i + 1)) {
        let sure = !matches!(word, Some("if" | "for"));
        return if begins_line { sure || !broken } else { sure && stands_alone(text, tokens, i) };
    }
    if !begins_line || broken || word.is_some_and(|word| words::GOING_ON.contains(&word)) {
        return false;
    }
    let begins = match token.kind {
        TokenKind::Word | TokenKind::Number | TokenKind::Text { .. } => true,
        TokenKind::Open => &text[token.start..token.end] != "{",
        TokenKind::Operator => matches!(&text[token.start..token.end], "+" | "-"),
        _ => false,
    };
    begins && !wants_more(text, before)
}

/// Returns true if a keyword may stand before this token.
fn leads(text: &str, next: Option<&Token>) -> bool {
    next.is_some_and(|next| match next.kind {
        TokenKind::Word | TokenKind::Number | TokenKind::Text { .. } | TokenKind::Open => true,
        _ => matches!(&text[next.start..next.end], "-" | "+"),
    })
}

/// Returns true if a keyword in the middle of a line begins a clause: two words side by side, and the word
/// before does not take a name.
fn stands_alone(text: &str, tokens: &[Token], i: usize) -> bool {
    let before = tokens[i - 1];
    let followed = tokens.get(i + 1).is_some_and(|next| next.kind == TokenKind::Word);
    followed
        && before.kind != TokenKind::Operator
        && !(before.kind == TokenKind::Word && words::GOING_ON.contains(&&text[before.start..before.end]))
}

/// Returns true if an expression cannot end with this token.
fn wants_more(text: &str, token: Token) -> bool {
    let written = &text[token.start..token.end];
    match token.kind {
        TokenKind::Operator => written != "?",
        TokenKind::Open => true,
        TokenKind::Word => matches!(written, "and" | "or" | "not" | "else" | "in" | "if"),
        _ => false,
    }
}

/// Returns the insides of the `{ }` of a piece that are outside of other brackets, as ranges of bytes, in order; the
/// last one may lack its end. `unclosed` are the offsets of brackets that are never closed, in order.
pub(super) fn bodies(text: &str, range: Range<usize>, unclosed: &[usize]) -> Vec<Range<usize>> {
    let mut bodies = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for token in tokens(text, range.clone()) {
        match token.kind {
            TokenKind::Open => {
                let is_unclosed = unclosed.binary_search(&token.start).is_ok();
                let brace = &text[token.start..token.end] == "{";
                if is_unclosed && brace && open.is_empty() {
                    bodies.push(token.end..range.end);
                    return bodies;
                }
                if !is_unclosed {
                    open.push(token.start);
                }
            }
            TokenKind::Close => {
                let opener = open.pop();
                if open.is_empty()
                    && let Some(opener) = opener
                    && text.as_bytes()[opener] == b'{'
                {
                    bodies.push(opener + 1..token.start);
                }
            }
            _ => {}
        }
    }
    bodies
}
