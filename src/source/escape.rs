//! Text of others on a terminal: characters that would control it are shown as escapes.

use std::borrow::Cow;
use std::fmt::Write;

/// Returns text with every character that controls a terminal or the order of reading written as an escape,
/// `\u{1b}`; line breaks and tabs stay.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    replaced(text, |out, c| write!(out, "\\u{{{:x}}}", u32::from(c)))
}

/// Returns JSON in which every such character is written as the escape `\u001b` of JSON; it can stand in texts only,
/// so the value stays the same.
pub(crate) fn escaped_json(json: &str) -> Cow<'_, str> {
    replaced(json, |out, c| write!(out, "\\u{:04x}", u32::from(c)))
}

fn replaced(text: &str, escape: impl Fn(&mut String, char) -> std::fmt::Result) -> Cow<'_, str> {
    if !text.contains(controls) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if controls(c) {
            escape(&mut out, c).expect("writing to a String cannot fail");
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Returns true for control characters but line breaks and tabs, and for those that reorder text.
fn controls(c: char) -> bool {
    let reorders = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    reorders || c.is_control() && !matches!(c, '\n' | '\t')
}
