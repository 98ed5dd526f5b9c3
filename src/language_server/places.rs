//! Places in texts: offsets in bytes, and the lines and columns of the protocol.

use crate::source::{floor_char_boundary, percent};
use std::ops::Range;

/// The unit in which columns count, as editor and server have agreed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Bytes of UTF-8.
    Utf8,
    /// Code units of UTF-16, the protocol's default.
    #[default]
    Utf16,
}

/// A place in a text: line and column, both from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    /// The number of the line, from 0.
    pub line: u32,
    /// The number of the column in the agreed unit, from 0.
    pub column: u32,
}

/// Returns the place of an offset (bytes); an offset beyond the text is its end, one within a character that character's
/// begin.
pub(super) fn place(text: &str, offset: usize, encoding: Encoding) -> Place {
    let offset = floor_char_boundary(text, offset);
    let start = text[..offset].rfind('\n').map_or(0, |at| at + 1);
    let line = text[..start].bytes().filter(|byte| *byte == b'\n').count();
    let column = match encoding {
        Encoding::Utf8 => offset - start,
        Encoding::Utf16 => text[start..offset].encode_utf16().count(),
    };
    Place { line: line as u32, column: column as u32 }
}

/// Returns the offset (bytes) of a place; a column beyond the line is its end, a line beyond the text the text's end.
pub(super) fn offset(text: &str, place: Place, encoding: Encoding) -> usize {
    let mut start = 0;
    for _ in 0..place.line {
        match text[start..].find('\n') {
            Some(at) => start += at + 1,
            None => return text.len(),
        }
    }
    let line = text[start..].split('\n').next().unwrap_or("");
    let line = line.strip_suffix('\r').unwrap_or(line);
    let mut left = place.column as usize;
    for (at, c) in line.char_indices() {
        let units = match encoding {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
        };
        if left < units {
            return start + at;
        }
        left -= units;
    }
    start + line.len()
}

/// Returns the two places between which a range of bytes lies.
pub(super) fn places(text: &str, range: &Range<usize>, encoding: Encoding) -> (Place, Place) {
    (place(text, range.start, encoding), place(text, range.end, encoding))
}

/// Returns the path that a `file:` URI names; `None` for another URI.
pub(super) fn path_of(uri: &str) -> Option<String> {
    let rest = uri.strip_prefix("file://")?;
    // A host before the path is that of this machine.
    let encoded = &rest[rest.find('/')?..];
    percent::decoded(encoded)
}

/// Returns the URI of an absolute path.
pub(super) fn uri_of(path: &str) -> String {
    let mut uri = "file://".to_owned();
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'/' | b'-' | b'.' | b'_' | b'~' => {
                uri.push(char::from(byte))
            }
            byte => uri += &format!("%{byte:02X}"),
        }
    }
    uri
}
