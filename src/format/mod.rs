//! The formatter: the one style for programs, applied by `modl fmt`.
//!
//! The author's line breaks are kept, and lines that are too wide get more; indentation, spaces within a line and
//! blank lines are normalised. Formatting never changes the meaning: no token is added, moved or left out. An
//! unreadable run of items stays as it is.

mod breaks;
mod columns;
mod lines;
mod spacing;

use crate::source::{Diagnostic, FileId};
use crate::syntax::{Outline, parse, skeleton};

/// The most times that a text which can't be read as a whole is laid out.
const PASSES_MAX: usize = 8;

/// The result of [`format()`]: the text, laid out as far as it could be read, and what was wrong in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Formatted {
    /// The formatted text; unreadable chunks are unchanged in it.
    pub text: String,
    /// The syntax errors of unreadable chunks; empty if the whole text could be parsed.
    pub diagnostics: Vec<Diagnostic>,
}

/// Returns the text formatted by the one layout of the language; `id` is its file in the diagnostics. A text that is
/// too large or nests too deeply is returned as it is, with a diagnostic.
///
/// `None` if the result would have been another program, which would be a defect of the formatter; the text must then
/// be left as it is.
pub fn format(id: FileId, text: &str) -> Option<Formatted> {
    let Some(outline) = Outline::of(text) else {
        return Some(Formatted { text: text.to_owned(), diagnostics: parse(id, text).diagnostics });
    };
    let laid_out = |broken| columns::aligned(lines::lines(text, &outline, broken));
    if outline.chunks.iter().all(|chunk| chunk.sound) {
        let meaning = skeleton(text);
        // A line stays wide where a break would change what the program means.
        let formatted = [true, false].into_iter().map(laid_out).find(|text| skeleton(text) == meaning)?;
        return Some(Formatted { text: formatted, diagnostics: Vec::new() });
    }
    let diagnostics = parse(id, text).diagnostics;
    // The borders of what can't be read may move with the lines around it, so it is laid out until it stays.
    let mut formatted = laid_out(true);
    for _ in 0..PASSES_MAX {
        let Some(outline) = Outline::of(&formatted) else { break };
        let again = columns::aligned(lines::lines(&formatted, &outline, true));
        if again == formatted {
            break;
        }
        formatted = again;
    }
    Some(Formatted { text: formatted, diagnostics })
}
