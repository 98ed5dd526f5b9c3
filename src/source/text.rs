//! The texts of one run, and the conversion of offsets to lines and columns.

use super::{FileId, Span};
use std::sync::Arc;

/// Returns the greatest character boundary of a text that is not after `offset`.
pub fn floor_char_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// A position in a text: line and column, both from 1; the column counts characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LineColumn {
    /// The number of the line, from 1.
    pub line: usize,
    /// The number of the column in characters, from 1.
    pub column: usize,
}

/// A text with its name, read once: positions in it stay valid.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// The name in diagnostics and plans: relative to the project root, with forward slashes; a file of the
    /// standard library is `std/smores.mod`.
    pub name: Arc<str>,
    /// The whole text of the file, as UTF-8.
    pub text: Arc<str>,
    /// True if the file belongs to the standard library.
    pub library: bool,
    /// The number, from 1, of the first line of the text; above 1 for a later piece of a longer input.
    pub first_line: usize,
    line_starts: Vec<u32>,
}

impl SourceFile {
    /// Returns the line and column (from 1) of a byte offset (from 0). An offset beyond the text is taken as its end,
    /// and one within a character as that character's first byte.
    pub fn line_column(&self, offset: usize) -> LineColumn {
        let offset = floor_char_boundary(&self.text, offset);
        let line = self.line_starts.partition_point(|&s| s as usize <= offset) - 1;
        let start = self.line_starts[line] as usize;
        LineColumn { line: line + self.first_line, column: self.text[start..offset].chars().count() + 1 }
    }

    /// Returns the text of a line without its line end; empty if there is no such line. Lines count from
    /// `first_line`.
    pub fn line(&self, line: usize) -> &str {
        let Some(&start) = line.checked_sub(self.first_line).and_then(|i| self.line_starts.get(i)) else {
            return "";
        };
        let end = self.line_starts.get(line + 1 - self.first_line).map_or(self.text.len(), |&e| e as usize);
        self.text[start as usize..end].trim_end_matches(['\n', '\r'])
    }

    /// Returns the offset in bytes at which a line begins, counted from `first_line`; the end of the text if there is
    /// no such line.
    pub fn line_start(&self, line: usize) -> usize {
        line.checked_sub(self.first_line)
            .and_then(|i| self.line_starts.get(i))
            .map_or(self.text.len(), |&start| start as usize)
    }

    /// Returns the number of the last line, counted from `first_line`; it is empty if the text ends with a line end.
    pub fn last_line(&self) -> usize {
        self.line_starts.len() + self.first_line - 1
    }
}

/// All source texts of one run. [`FileId`]s are numbered in order of adding.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<SourceFile>,
}

impl Sources {
    /// Adds a text, and returns its identity. `library` is true for a file of the standard library. `name`: the name
    /// in diagnostics and plans. Panics on the 2^32nd text.
    pub fn add(&mut self, name: &str, text: &str, library: bool) -> FileId {
        self.add_piece(name, text, library, 1)
    }

    /// Adds a piece of a longer input that begins at line `first_line` of it, and returns its identity. `name`,
    /// `text` and `library`: as for [`add`](Self::add).
    pub fn add_piece(&mut self, name: &str, text: &str, library: bool, first_line: usize) -> FileId {
        let starts = std::iter::once(0)
            .chain(text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i as u32 + 1))
            .collect();
        let (name, text) = (name.into(), text.into());
        self.files.push(SourceFile { name, text, library, first_line, line_starts: starts });
        FileId(self.files.len() as u32 - 1)
    }

    /// Returns the text of this identity, with its name. Panics if there is none.
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.0 as usize]
    }

    /// Returns all texts in order of adding.
    pub fn files(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(i, f)| (FileId(i as u32), f))
    }

    /// Returns the text of a span. Panics if its file is not among these texts, or the span is beyond the text's end or
    /// cuts a character.
    pub fn text(&self, span: Span) -> &str {
        &self.file(span.file).text[span.range()]
    }

    /// Returns the line and column (from 1) at which a span begins. Panics if its file is not among these texts.
    pub fn line_column(&self, span: Span) -> LineColumn {
        self.file(span.file).line_column(span.start as usize)
    }
}
