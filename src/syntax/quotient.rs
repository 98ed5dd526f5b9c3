//! A lint for `x // 2` of other languages: in modl a comment begins there, and the rest of the line is lost
//! silently.

use super::lex::{Token, TokenKind};
use super::parse::{Rule, nodes};
use super::split::tokens;
use super::words;
use crate::source::{Diagnostic, Span, code};

/// The greatest length of a divisor, in bytes.
const DIVISOR_MAX: usize = 60;

/// Returns a warning if a comment behind an operand of an integer expression looks like its divisor: `n //
/// 2`, or `(n // k)`, whose bracket is in the comment.
///
/// `before` is the token before the comment on its line.
pub(super) fn meant(source: &str, before: Token, comment: Token, span: Span) -> Option<Diagnostic> {
    let line = source[..before.start].rfind('\n').map_or(0, |at| at + 1);
    let ahead = &source[line..before.end];
    let divisor = source[comment.start + 2..comment.end].trim();
    let operand = match before.kind {
        // A type is not a number.
        TokenKind::Word => {
            let word = &source[before.start..before.end];
            !words::is_reserved(word) && !word.starts_with(|c: char| c.is_ascii_uppercase())
        }
        TokenKind::Number => is_plain(&source[before.start..before.end]),
        TokenKind::Close => !source[..before.end].ends_with('}'),
        _ => false,
    };
    let divides = operand && (is_divisor(divisor) || swallows_a_bracket(ahead, divisor));
    divides.then(|| {
        Diagnostic::warning(code::COMMENT_DIVIDES, "`//` begins a comment, it does not divide")
            .label(span, "all of this is skipped")
            .hint(hint(divisor))
    })
}

/// Returns the hint that proposes `div`.
fn hint(divisor: &str) -> String {
    let end = divisor.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(divisor.len());
    format!("the whole quotient is `div(a, {})`; `/` divides", &divisor[..end])
}

/// Returns true if a text is an integer, perhaps followed by more of an expression.
fn is_divisor(text: &str) -> bool {
    let tokens = tokens(text, 0..text.len());
    let begins = tokens
        .first()
        .is_some_and(|first| first.kind == TokenKind::Number && is_plain(&text[first.start..first.end]));
    // Two values side by side, as in `// 7 modules`, are words of a sentence.
    begins && text.len() <= DIVISOR_MAX && nodes(Rule::chunk, text).is_some()
}

/// Returns true if a text is a name or number followed by the bracket that closes one open in `ahead`.
fn swallows_a_bracket(ahead: &str, text: &str) -> bool {
    let mut open = 0i32;
    for token in tokens(ahead, 0..ahead.len()) {
        open += depth(token.kind);
    }
    let behind = tokens(text, 0..text.len());
    let operand = behind.first().is_some_and(|t| matches!(t.kind, TokenKind::Word | TokenKind::Number));
    operand && open > 0 && behind.get(1).is_some_and(|second| second.kind == TokenKind::Close)
}

/// Returns the change of bracket depth by a token.
fn depth(kind: TokenKind) -> i32 {
    match kind {
        TokenKind::Open => 1,
        TokenKind::Close => -1,
        _ => 0,
    }
}

/// Returns true if a number has only digits.
fn is_plain(number: &str) -> bool {
    number.bytes().all(|byte| byte.is_ascii_digit() || byte == b'_')
}
