//! Spaces between two tokens of one line.

use crate::syntax::{Role, Token, TokenKind};

/// A token of a line with its text and its role in the grammar.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'t> {
    /// The token that is laid out.
    pub token: Token,
    /// The text that the token has in the source.
    pub text: &'t str,
    /// The role of the token in the grammar; `None` if it has none.
    pub role: Option<Role>,
    /// True if an item, clause or statement begins with the token.
    pub begins: bool,
    /// True if the token is in the first column.
    pub margin: bool,
}

impl Piece<'_> {
    /// Returns true if the token is a comment.
    pub(super) fn is_comment(&self) -> bool {
        matches!(
            self.token.kind,
            TokenKind::LineComment | TokenKind::BlockComment { .. } | TokenKind::UnclosedComment
        )
    }

    /// Returns true if the token is an opening bracket: `(`, `[` or `{`.
    pub(super) fn opens(&self) -> bool {
        self.token.kind == TokenKind::Open
    }

    /// Returns true if the token is a closing bracket: `)`, `]` or `}`.
    pub(super) fn closes(&self) -> bool {
        self.token.kind == TokenKind::Close
    }

    /// Returns true if it is a number with a unit, which a `^` next to it would raise.
    fn has_unit(&self) -> bool {
        let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | '_');
        self.token.kind == TokenKind::Number && !self.text.chars().all(digits)
    }
}

/// The number of spaces between clauses on one line, and before a comment that follows code.
pub(super) const APART: usize = 2;

/// Returns the number of spaces that the layout puts before the last token of a line; 0 for a single token.
pub(super) fn before_last(line: &[Piece]) -> usize {
    let [.., before, after] = line else { return 0 };
    if after.token.kind == TokenKind::LineComment {
        return APART;
    }
    if let Some(spaces) = in_brackets(before, after) {
        return spaces;
    }
    if after.text == "," || after.text == "?" || after.text == "..." {
        return 0;
    }
    if before.is_comment() || after.is_comment() {
        return 1;
    }
    if after.begins && before.text != "," && !before.opens() {
        return APART;
    }
    if after.text == ":" {
        return usize::from(after.role == Some(Role::Spaced));
    }
    if before.role == Some(Role::Prefix) {
        return usize::from(before.text == "not" || runs_together(before, after));
    }
    if matches!(before.text, "." | "..") || matches!(after.text, "." | "..") {
        return 0;
    }
    // `x^2`, but `2m ^ 2`: without the spaces the unit would be squared.
    if after.text == "^" {
        return usize::from(before.has_unit());
    }
    if before.text == "^" {
        return usize::from(line.len() > 2 && line[line.len() - 3].has_unit());
    }
    if after.role == Some(Role::Tight) || after.role == Some(Role::Angle) {
        return 0;
    }
    if before.role == Some(Role::Angle) && before.text == "<" {
        return 0;
    }
    1
}

/// Returns the number of spaces at a bracket: 0, except inside braces. `None` if neither token is such a
/// bracket.
fn in_brackets(before: &Piece, after: &Piece) -> Option<usize> {
    match (before.opens(), after.closes()) {
        (true, true) => Some(0),
        (true, false) => Some(usize::from(before.text == "{" && before.role != Some(Role::Names))),
        (false, true) => Some(usize::from(after.text == "}" && after.role != Some(Role::Names))),
        (false, false) => None,
    }
}

/// Returns true if two operators would become another one without a space: `- -x` is not `--x`.
fn runs_together(before: &Piece, after: &Piece) -> bool {
    match before.text {
        "-" => after.text.starts_with(['-', '>']),
        "+" => after.text.starts_with('+'),
        "!" => after.text.starts_with('='),
        _ => false,
    }
}
