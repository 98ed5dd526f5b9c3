//! Clouds of points from XYZ files: a point a line, its coordinates first.
//!
//! A reader of our own, for the format is no more than that. Other numbers of a line, a colour or a normal, are
//! left out; so is the rest of a line from a `#` on.

use super::content::Content;
use super::fault::FormatFault;

/// Reads the points of an XYZ file, in the file's own unit of length: the first three numbers of each line. Empty lines
/// are left out.
///
/// # Errors
/// The first [`FormatFault`] of the bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let text = std::str::from_utf8(bytes).map_err(|_| FormatFault::NotText)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut read = Content::default();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("");
        let words: Vec<&str> = line
            .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
            .filter(|w| !w.is_empty())
            .collect();
        if words.is_empty() {
            continue;
        }
        let number = |k: usize| words.get(k).and_then(|word| word.parse::<f64>().ok());
        let (Some(x), Some(y), Some(z)) = (number(0), number(1), number(2)) else {
            return Err(FormatFault::NotThreeNumbers { line: i + 1 });
        };
        read.vertices.push([x, y, z]);
    }
    Ok(read)
}
