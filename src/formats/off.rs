//! Meshes from OFF files (Geomview's object file format), in text.
//!
//! A reader of our own, for no crate reads the format and says where it fails. Colours and normals
//! that follow on a line are left out.

use super::content::Content;
use super::fault::FormatFault;

/// First words of the variants that are read: plain, and with colours or normals after the vertices.
const KINDS: &[&str] = &["OFF", "COFF", "NOFF", "CNOFF"];

/// Reads the vertices and faces of an OFF file in text, in the file's own unit of length.
///
/// # Errors
/// The first [`FormatFault`] of the bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let text = std::str::from_utf8(bytes).map_err(|_| FormatFault::NotText)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.split('#').next().unwrap_or("")));
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty()).peekable();
    // The first word, and the counts on its line or the next.
    let Some(&(number, first)) = lines.peek() else { return Err(FormatFault::Empty) };
    let mut words = first.split_whitespace();
    let kind = words.next().unwrap_or("");
    let counts = if kind.starts_with(|c: char| c.is_ascii_digit()) {
        // The first word may be left out.
        lines.next().expect("it was seen")
    } else if !KINDS.contains(&kind) {
        return Err(FormatFault::NotOff { line: number, found: shown(kind) });
    } else {
        lines.next();
        match words.next() {
            Some("BINARY") => return Err(FormatFault::BinaryOff { line: number }),
            Some(_) => (number, first.trim_start().strip_prefix(kind).unwrap_or(first)),
            None => lines.next().ok_or(FormatFault::NoCounts)?,
        }
    };
    let (line, counts) = counts;
    let mut counts = counts.split_whitespace();
    let mut count = |what: &'static str| -> Result<usize, FormatFault> {
        let word = counts.next().ok_or(FormatFault::NoCount { line, what })?;
        word.parse().map_err(|_| FormatFault::BadCount { line, what, found: shown(word) })
    };
    let (vertices, faces) = (count("vertices")?, count("faces")?);
    let mut read = Content::default();
    // One line for each vertex, then one for each face.
    for _ in 0..vertices {
        let (number, line) =
            lines.next().ok_or_else(|| missing("vertices", read.vertices.len(), vertices))?;
        let numbers: Vec<f64> = line.split_whitespace().take(3).filter_map(|w| w.parse().ok()).collect();
        let vertex = <[f64; 3]>::try_from(numbers);
        read.vertices.push(vertex.map_err(|_| FormatFault::BadLine { line: number, what: "vertex" })?);
    }
    for _ in 0..faces {
        let (number, line) = lines.next().ok_or_else(|| missing("faces", read.faces.len(), faces))?;
        read.faces.push(face(line).ok_or(FormatFault::BadLine { line: number, what: "face" })?);
    }
    Ok(read)
}

/// Reads the corners of a face from a line: their number, then so many indices of vertices; `None` if it does not
/// hold that.
fn face(line: &str) -> Option<Vec<usize>> {
    let mut words = line.split_whitespace();
    let size: usize = words.next()?.parse().ok()?;
    let corners: Option<Vec<usize>> = words.take(size).map(|word| word.parse().ok()).collect();
    corners.filter(|corners| corners.len() == size)
}

fn missing(what: &'static str, found: usize, wanted: usize) -> FormatFault {
    FormatFault::Ends { what, found, wanted }
}

/// Returns a word short enough for a message.
fn shown(word: &str) -> String {
    word.chars().take(20).collect()
}
