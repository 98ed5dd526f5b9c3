//! The extent of an entry: the completeness of a text, and the lines that belong to it.

use crate::syntax::{Outline, TokenKind, breaks_off};

/// Returns true if a text is incomplete: a bracket, a raw text or a comment is open, or it ends where more is
/// expected. A blank text, and one with a mistake elsewhere, is complete: it can be checked. So is one that is
/// too large or nests too deeply.
pub fn is_incomplete(text: &str) -> bool {
    match Outline::of(text).map(|outline| openness(&outline)) {
        _ if text.trim().is_empty() => false,
        Some(Openness::Open) => true,
        Some(Openness::Closed) => ends_with_documentation(text) || breaks_off(text),
        Some(Openness::Wrong) | None => false,
    }
}

/// Returns true if the user submits an incomplete text, which ends in a line break, as it is: by an empty line at its
/// end, or by two inside brackets, where empty lines may occur.
pub fn is_given_up(text: &str) -> bool {
    let open = Outline::of(text).is_some_and(|outline| matches!(openness(&outline), Openness::Open));
    text.ends_with(if open { "\n\n" } else { "\n" })
}

/// Returns true if a line can only continue the one before: it begins with `and`, `or`, `else`, or an operator
/// that begins no statement.
pub fn goes_on(line: &str) -> bool {
    let line = line.trim_start();
    let word = line.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
    if ["and", "or", "else"].contains(&word) {
        return true;
    }
    // `(`, `[`, `+` and `-` begin a new statement.
    let signs = ["++", ".", "*", "/", "%", "^", "==", "!=", "<", ">", "=>"];
    let comment = line.starts_with("//") || line.starts_with("/*");
    !comment && signs.iter().any(|sign| line.starts_with(sign))
}

/// The state of brackets at the end of a text.
enum Openness {
    /// A bracket, raw text or comment is open.
    Open,
    /// All brackets are closed.
    Closed,
    /// A closing bracket has no opening one, or a text is not closed on its line.
    Wrong,
}

/// Returns the state of brackets at the end of a text.
fn openness(outline: &Outline) -> Openness {
    let mut depth = 0usize;
    for token in &outline.tokens {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close if depth == 0 => return Openness::Wrong,
            TokenKind::Close => depth -= 1,
            TokenKind::UnclosedRawText | TokenKind::UnclosedComment => return Openness::Open,
            TokenKind::UnclosedText => return Openness::Wrong,
            _ => {}
        }
    }
    if depth > 0 { Openness::Open } else { Openness::Closed }
}

/// Returns true if a text ends with documentation, which needs an item.
fn ends_with_documentation(text: &str) -> bool {
    text.lines().last().is_some_and(|line| line.trim_start().starts_with("///"))
}
