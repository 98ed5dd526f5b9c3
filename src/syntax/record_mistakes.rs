//! Explanation of mistakes with records: how other languages build and change them.

use super::failure::{BodyKind, Mistake};
use super::lex::TokenKind;
use super::words;
use crate::source::{Diagnostic, code};

// All that explain return `None` if the mistake is something else.
impl Mistake<'_> {
    /// Returns the diagnostic for a record built in braces as in other languages, `Design { bend: 30deg }`; `None` if
    /// the mistake is something else.
    pub(super) fn built_in_braces(&self) -> Option<Diagnostic> {
        let named = |i: usize| {
            self.kind_of(i) == Some(TokenKind::Word)
                && self.token_text(i).starts_with(|c: char| c.is_ascii_uppercase())
        };
        // The brace, or the colon after the first field where the braces were read as a block.
        let brace = match self.found() {
            "{" => self.found,
            ":" if self.found >= 2 => self.found - 2,
            _ => return None,
        };
        let entry = self.token_text(brace) == "{" && self.token_text(brace + 2) == ":" && brace > 0;
        if !entry || !named(brace - 1) || words::FAMILIES.contains(&self.token_text(brace.saturating_sub(2)))
        {
            return None;
        }
        let name = self.token_text(brace - 1);
        let close = (brace + 1..self.tokens.len()).find(|&i| self.token_text(i) == "}");
        let fields = close.map(|close| self.text[self.tokens[brace].end..self.tokens[close].start].trim());
        let fields = fields.filter(|fields| fields.len() <= 60 && !fields.contains(['\n', '{']));
        let fields = fields.unwrap_or("a: 1, b: 2").trim_end_matches(',');
        self.error_at(code::SYNTAX, brace, "a record is built in round brackets")
            .map(|d| d.hint(format!("write `{name}({fields})`")))
    }

    /// Returns the diagnostic for `with` without its braces; `None` if the mistake is something else.
    pub(super) fn with_without_braces(&self) -> Option<Diagnostic> {
        if self.before() != "with" || !self.wants("{") {
            return None;
        }
        self.error("what `with` changes stands in braces")
            .map(|d| d.hint("a changed copy of a record is written `d with { bend: 40deg }`"))
    }

    /// Returns the diagnostic for `{ a: 1 }`, or `{` in place of an expression; `None` if the mistake is something
    /// else.
    pub(super) fn brace_literal(&self) -> Option<Diagnostic> {
        let record = self.found() == ":"
            && matches!(
                self.kind_of(self.found.wrapping_sub(1)),
                Some(TokenKind::Word | TokenKind::Text { .. })
            )
            && self.found >= 2
            && self.token_text(self.found - 2) == "{";
        let brace = self.found() == "{" && self.wants_expression();
        // The first entry of a brace literal that was read as a block.
        let entry = self.found() == ":" && self.found == 1 && self.place == BodyKind::Statements;
        if !record && !brace && !entry {
            return None;
        }
        let index = if record { self.found - 2 } else { self.found };
        self.error_at(code::SYNTAX, index, "no value is written in `{ }`")
            .map(|d| d.hint("a record, declared by `record Name { a: Int, b: Int }`, is built by `Name(a: 1, b: 2)`; a list is written `[a, b]`"))
    }
}
