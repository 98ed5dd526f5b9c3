//! One style for programs: what `modl fmt` writes.
//!
//! The author's line breaks stay; indentation, the spaces within a line and blank lines are decided
//! here, as gofmt does it. So nothing changes its meaning: no token is added, moved or left out, and
//! none changes its line. A run of items that can't be read stays as it is.

mod columns;
mod lines;
mod spacing;

use crate::source::{Diagnostic, FileId};
use crate::syntax::{Outline, parse, skeleton};

/// A text in the one style.
#[derive(Clone, Debug, PartialEq)]
pub struct Formatted {
    /// What can't be read stands in it as it was.
    pub text: String,
    /// What can't be read, as parsing tells it.
    pub diagnostics: Vec<Diagnostic>,
}

/// Formats a text; `id` is its name in the diagnostics.
///
/// `None`: the result would have been another program, which is a defect of the formatter that so does
/// no harm.
pub fn format(id: FileId, text: &str) -> Option<Formatted> {
    let Some(outline) = Outline::of(text) else {
        return Some(Formatted { text: text.to_owned(), diagnostics: parse(id, text).diagnostics });
    };
    let formatted = columns::aligned(lines::lines(text, &outline));
    if outline.chunks.iter().all(|chunk| chunk.sound) {
        let same = skeleton(text) == skeleton(&formatted);
        return same.then_some(Formatted { text: formatted, diagnostics: Vec::new() });
    }
    Some(Formatted { text: formatted, diagnostics: parse(id, text).diagnostics })
}
