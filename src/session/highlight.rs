//! Highlighting of an entry that is being typed: of a program's words, or of a command.

pub(crate) use crate::syntax::Class;
use crate::syntax::classes;
use std::ops::Range;

/// The kinds of text that highlighting of an entry tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Piece {
    /// The word of a command of the session, such as `:save`.
    Command,
    /// A piece of a program.
    Program(Class),
}

/// Returns the highlighted pieces of an entry as (range of bytes, kind), in order; all else is plain. Empty for a text
/// that is too large or nests too deeply.
pub(crate) fn pieces(text: &str) -> Vec<(Range<usize>, Piece)> {
    let command = text.trim_start();
    if command.starts_with(':') || command.starts_with('?') {
        let start = text.len() - command.len();
        let end = command.find(char::is_whitespace).map_or(text.len(), |at| start + at);
        return vec![(start..end, Piece::Command)];
    }
    classes(text).into_iter().map(|(range, class)| (range, Piece::Program(class))).collect()
}
