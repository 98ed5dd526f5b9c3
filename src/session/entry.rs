//! One entry of a person: whether it is complete, and whether the next line belongs to it.

use crate::syntax::{Outline, TokenKind, breaks_off};

/// Whether more must follow for a text to mean something: a bracket, a raw text or a comment is open,
/// or it breaks off where something is wanted. What is wrong elsewhere is complete: it can be judged.
pub fn is_incomplete(text: &str) -> bool {
    match Outline::of(text).map(|outline| openness(&outline)) {
        _ if text.trim().is_empty() => false,
        Some(Openness::Open) => true,
        Some(Openness::Closed) => ends_with_documentation(text) || breaks_off(text),
        Some(Openness::Wrong) | None => false,
    }
}

/// Whether somebody who types an incomplete text wants it to be judged all the same: by an empty line;
/// between brackets, where those have their place, by two.
pub fn is_given_up(text: &str) -> bool {
    let open = Outline::of(text).is_some_and(|outline| matches!(openness(&outline), Openness::Open));
    text.ends_with(if open { "\n\n" } else { "\n" })
}

/// Whether a line can only go on with what stands before it.
pub fn goes_on(line: &str) -> bool {
    let line = line.trim_start();
    let word = line.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
    if ["and", "or", "else"].contains(&word) {
        return true;
    }
    // `(`, `[`, `+` and `-` begin something new.
    let signs = ["++", ".", "*", "/", "%", "^", "==", "!=", "<", ">", "=>"];
    let comment = line.starts_with("//") || line.starts_with("/*");
    !comment && signs.iter().any(|sign| line.starts_with(sign))
}

enum Openness {
    Open,
    Closed,
    /// Something closes that was never opened, or a text is open whose line is over.
    Wrong,
}

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

/// Documentation wants the item that it is about.
fn ends_with_documentation(text: &str) -> bool {
    text.lines().last().is_some_and(|line| line.trim_start().starts_with("///"))
}
