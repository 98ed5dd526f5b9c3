//! A lint for `x // 2` of other languages: in modl a comment begins there, and the rest of the line is lost
//! silently.

use super::lex::{Token, TokenKind};
use super::parse::{Rule, nodes};
use super::split::tokens;
use super::words;
use crate::source::{Diagnostic, Span, code};

/// The greatest length of a divisor, in bytes.
const DIVISOR_MAX: usize = 60;

/// A comment `// ...` that looks like the divisor of an integer division in other languages.
#[derive(Debug)]
pub(super) struct Quotient {
    /// The comment.
    pub(super) comment: Span,
    /// True if the comment holds a bracket that closes one before it.
    pub(super) swallows: bool,
    hint: String,
}

impl Quotient {
    /// Returns the warning that the rest of the line is a comment, with the hint how to divide.
    pub(super) fn warning(self) -> Diagnostic {
        Diagnostic::warning(code::COMMENT_DIVIDES, "`//` begins a comment, it does not divide")
            .label(self.comment, "all of this is skipped")
            .hint(self.hint)
    }

    /// Returns the diagnostic that `bracket`, which opens at `at`, is never closed, because the closing one is in the
    /// comment.
    pub(super) fn unclosed(self, bracket: char, at: Span) -> Diagnostic {
        let message = format!("this `{bracket}` is never closed: `//` begins a comment");
        Diagnostic::error(code::UNCLOSED, message)
            .label(at, "")
            .label(self.comment, "all of this is skipped")
            .hint(self.hint)
    }
}

/// Returns the quotient that is meant if a comment after an operand of an integer expression looks like its
/// divisor, as in `n // 2`, or in `(n // k)`, whose bracket is in the comment; otherwise `None`.
///
/// `before` is the token before the comment on its line.
pub(super) fn meant(source: &str, before: Token, comment: Token, span: Span) -> Option<Quotient> {
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
    let swallows = operand && swallows_a_bracket(ahead, divisor);
    let hint = hint(dividend(ahead), divisor);
    (swallows || operand && is_divisor(divisor)).then_some(Quotient { comment: span, swallows, hint })
}

/// Returns the hint that proposes `div`.
fn hint(dividend: &str, divisor: &str) -> String {
    let end = divisor.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(divisor.len());
    format!("the whole quotient is `div({dividend}, {})`; `/` divides", &divisor[..end])
}

/// Returns the name or number at the end of a line, with the names before its dots; `a` if the operand is
/// larger than that.
fn dividend(ahead: &str) -> &str {
    let tokens = tokens(ahead, 0..ahead.len());
    let text = |token: &Token| &ahead[token.start..token.end];
    let is_name = |token: &Token| matches!(token.kind, TokenKind::Word | TokenKind::Number);
    let Some(mut first) = tokens.len().checked_sub(1).filter(|&last| is_name(&tokens[last])) else {
        return "a";
    };
    while first >= 2 && text(&tokens[first - 1]) == "." && is_name(&tokens[first - 2]) {
        first -= 2;
    }
    // Behind these the operand is a product, or the end of a path with calls.
    let before = first.checked_sub(1).map_or("", |before| text(&tokens[before]));
    match before {
        "*" | "/" | "%" | "^" | "." | "-" => "a",
        _ => &ahead[tokens[first].start..],
    }
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
