//! Characters that are not allowed in programs: their names and their probable meaning.

use crate::source::{Diagnostic, Span, code};

/// The text that the writer of an odd character probably meant, with a hint.
pub(super) struct Meant {
    /// The character that the grammar reads in its place; `None` if no one character is read there.
    pub(super) replacement: Option<char>,
    hint: Option<&'static str>,
}

/// Returns what the writer of a character that is not allowed outside texts and comments probably meant; both fields
/// are `None` if that is unknown.
pub(super) fn meant(c: char) -> Meant {
    let (replacement, hint) = match c {
        ';' => (Some('\n'), "a line break or the next keyword ends a statement"),
        '\'' | '‘' | '’' => (None, "texts stand in double quotes: \"...\""),
        '“' | '”' | '„' | '«' | '»' => (None, "texts stand in plain double quotes: \"...\""),
        '−' | '–' | '—' => (Some('-'), "the minus sign is `-`"),
        '×' | '·' | '⋅' => (Some('*'), "a product is written with `*`"),
        '÷' => (Some('/'), "a quotient is written with `/`"),
        '≤' => (None, "write `<=`"),
        '≥' => (None, "write `>=`"),
        '≠' => (None, "write `!=`"),
        '→' => (None, "write `->`"),
        '…' => (None, "a range is written `a..b`"),
        '°' => (None, "degrees are written `deg`: `90deg`"),
        'µ' | 'μ' => (Some('u'), "the prefix micro is written `u`: `5um`"),
        'π' => (None, "a half turn is `180deg`"),
        '²' | '³' => (None, "powers are written with `^`: `m^2`"),
        '&' => (None, "write `and`"),
        '#' => (Some(' '), "a comment begins with `//`"),
        '\\' => (None, "a line goes on where an operator ends it or begins the next one"),
        _ if is_hidden(c) || c.is_whitespace() || c.is_control() => {
            (Some(' '), "delete it, or write a plain space")
        }
        _ if c.is_alphanumeric() => (Some('_'), "names are made of A-Z, a-z, 0-9 and `_`"),
        _ => return Meant { replacement: None, hint: None },
    };
    Meant { replacement, hint: Some(hint) }
}

/// Returns the diagnostic for a character that is not allowed outside texts and comments.
pub(super) fn stray(c: char, span: Span) -> Diagnostic {
    let message = match c {
        ';' => "modl has no semicolons".to_string(),
        '\'' => "modl has no single quotes".to_string(),
        _ => format!("{} has no place in a program", named(c)),
    };
    let diagnostic = Diagnostic::error(code::BAD_CHARACTER, message).label(span, "");
    match meant(c).hint {
        Some(hint) => diagnostic.hint(hint),
        None => diagnostic,
    }
}

/// Returns the diagnostic for a character that is not allowed in texts and comments either.
pub(super) fn forbidden(c: char, span: Span) -> Diagnostic {
    let why = if is_bidirectional(c) {
        "it changes the order in which the line is read"
    } else {
        "it cannot be seen"
    };
    Diagnostic::error(code::BAD_CHARACTER, format!("{} has no place in a program: {why}", named(c)))
        .label(span, "")
        .hint("in a text, write it as an escape: `\\u{...}`")
}

/// Returns true if a character is not even allowed in texts and comments: control characters, and those
/// that change the order of reading.
pub(super) fn is_forbidden_anywhere(c: char) -> bool {
    is_bidirectional(c) || c.is_control() && !matches!(c, '\n' | '\t' | '\r')
}

/// Returns a character with its code point, `ö` (U+00F6), or its name if it is invisible.
fn named(c: char) -> String {
    let point = u32::from(c);
    match invisible_name(c) {
        Some(name) => format!("{name} (U+{point:04X})"),
        None => format!("`{c}` (U+{point:04X})"),
    }
}

/// Returns the name of an invisible character; `None` for a visible one.
fn invisible_name(c: char) -> Option<&'static str> {
    Some(match c {
        '\0' => "the character NUL",
        '\u{a0}' => "a no-break space",
        '\u{ad}' => "a soft hyphen",
        '\u{200b}' => "a zero-width space",
        '\u{200c}' | '\u{200d}' => "a zero-width joiner",
        '\u{2060}' => "a word joiner",
        '\u{feff}' => "a byte order mark",
        _ if is_bidirectional(c) => "a mark of writing direction",
        _ if c.is_control() => "a control character",
        _ if is_hidden(c) => "an invisible character",
        _ if c.is_whitespace() => "a special space",
        _ => return None,
    })
}

/// Returns true if a character changes the direction of reading.
fn is_bidirectional(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns true if a character is invisible.
fn is_hidden(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{34f}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
        | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}'
        | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}
