//! Diagnostics of syntax errors.

use super::parse::NESTING_MAX;
use crate::source::{Diagnostic, Span, code};

/// Returns the diagnostic for a line that begins with `+`, `-`, `(` or `[` and cannot continue the line before.
pub(super) fn line_break(mark: Span, first: char) -> Diagnostic {
    let what = match first {
        '(' => "arguments in `( )` begin",
        '[' => "an index in `[ ]` begins",
        _ => return sum_break(mark, first),
    };
    Diagnostic::error(
        code::LINE_BREAK,
        format!("a line that begins with `{first}` does not continue the line before"),
    )
    .label(mark, "")
    .hint(format!("{what} on the line of what stands before"))
}

fn sum_break(mark: Span, sign: char) -> Diagnostic {
    Diagnostic::error(
        code::LINE_BREAK,
        format!("a line that begins with `{sign}` does not continue the line before"),
    )
    .label(mark, "")
    .hint(format!("put the `{sign}` at the end of the line before"))
}

/// Returns the diagnostic that `what`, such as "this bracket", is nested too deeply at a span.
pub(super) fn too_deep(at: Span, what: &str) -> Diagnostic {
    Diagnostic::error(code::TOO_DEEP, format!("{what} is nested too deeply"))
        .label(at, "")
        .hint(format!("the limit is {NESTING_MAX} levels"))
}

/// Returns the diagnostic for brackets that are never closed, `open`, given outermost first and at least one; `found`
/// is the token that stands where the closing one is missing, `None` at the end of the file. Panics without brackets.
pub(super) fn unclosed(open: &[(char, Span)], found: Option<Span>) -> Diagnostic {
    let (bracket, span) = open[open.len() - 1];
    let mut diagnostic =
        Diagnostic::error(code::UNCLOSED, format!("this `{bracket}` is never closed")).label(span, "");
    for &(_, span) in open.iter().rev().skip(1).take(2) {
        diagnostic = diagnostic.label(span, "nor is this one");
    }
    match found {
        Some(found) => diagnostic.label(found, format!("`{}` is missing before this", closer(bracket))),
        None => diagnostic.hint(format!("`{}` is missing at the end of the file", closer(bracket))),
    }
}

/// Returns the closing bracket.
fn closer(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Returns the diagnostic for a `what`, "text" or "comment", that is never closed; `opener` is the span of its opening,
/// `length` the number of bytes of its quotes, 1 or 3.
pub(super) fn unclosed_token(opener: Span, what: &str, length: usize) -> Diagnostic {
    let hint = match (what, length) {
        ("comment", _) => "close it with `*/`",
        (_, 1) => "close it with `\"` on its line; a text over several lines stands between `\"\"\"`",
        _ => "close it with `\"\"\"`",
    };
    Diagnostic::error(code::UNCLOSED, format!("this {what} is never closed")).label(opener, "").hint(hint)
}

/// Returns the diagnostic for a closing bracket without an opening one; `open` is the innermost open bracket, and
/// `None` if none is open.
pub(super) fn stray_closer(closer: char, at: Span, open: Option<Span>) -> Diagnostic {
    let diagnostic = Diagnostic::error(code::SYNTAX, format!("this `{closer}` closes nothing")).label(at, "");
    match open {
        Some(open) => diagnostic.label(open, "this is what is open"),
        None => diagnostic.hint("delete it"),
    }
}
