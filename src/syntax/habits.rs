//! Explanation of parse errors that come of the habits of other languages.

use super::failure::{BodyKind, Mistake};
use super::lex::TokenKind;
use super::words;
use crate::source::foreign;
use crate::source::{Diagnostic, code};

/// The greatest length of a piece of the program that a hint repeats, in bytes.
const REPEATED_MAX: usize = 60;

// All that explain return `None` if the mistake is something else.
impl Mistake<'_> {
    /// Returns the diagnostic for notation of other languages, such as `:` before a body; `None` if the mistake is
    /// something else.
    pub(super) fn foreign_mark(&self) -> Option<Diagnostic> {
        let follows = self.found > 0 && self.span_of(self.found - 1).end == self.span_of(self.found).start;
        let hint = match (self.before(), self.found()) {
            (_, ":") if self.wants("{") && self.token_text(0) == "for" => return self.loop_with_colon(),
            (_, ":") if self.wants("{") => "a body stands in braces: `{ ... }`",
            ("fn" | "behavior", _) if self.token_text(0) == "record" && self.wants(":") => {
                "a record has only fields; a function takes it: `fn name(it: Name) = ...`"
            }
            (_, "in") if self.wants_operator() && self.token_text(0) != "for" => {
                "whether a list holds something is `contains(list, item)`"
            }
            ("+" | "-" | "*" | "/", "=") if follows => {
                "a value never changes: `let name = ...` gives a new one"
            }
            (_, ":") if self.wants("]") => "a part of a list is `slice(list, 1..3)`",
            ("f", text) if follows && text.starts_with('"') => {
                "every text takes values in: `\"... {value}\"`, without `f`"
            }
            (word, _) if self.found == 1 && !self.begins_line() && !self.wants_expression() => {
                foreign::instead(word).filter(|_| self.kind_of(0) == Some(TokenKind::Word))?
            }
            _ => return None,
        };
        self.error(format!("`{}` cannot stand here", self.found())).map(|diagnostic| diagnostic.hint(hint))
    }

    /// Explains `for i in range(3):`.
    fn loop_with_colon(&self) -> Option<Diagnostic> {
        let words: Vec<&str> = (1..self.found).map(|i| self.token_text(i)).collect();
        let each = match words.as_slice() {
            [name, "in", "range", "(", end, ")"] => format!("{name} in 0..{end}"),
            [name, "in", "range", "(", from, ",", to, ")"] => format!("{name} in {from}..{to}"),
            _ => "i in 0..4".to_owned(),
        };
        self.error("`:` cannot stand here")
            .map(|diagnostic| diagnostic.hint(format!("a body stands in braces: `for {each} {{ ... }}`")))
    }

    /// Returns the diagnostic for a condition in Python's order, `a if c else b`; `None` if the mistake is something
    /// else.
    pub(super) fn turned_condition(&self) -> Option<Diagnostic> {
        let behind = (1..self.found).rev().find(|&i| self.token_text(i) == "if")?;
        let value = matches!(
            self.kind_of(behind - 1),
            Some(TokenKind::Word | TokenKind::Number | TokenKind::Text { .. } | TokenKind::Close)
        );
        let branches = (behind..self.found).any(|i| self.token_text(i) == "else");
        let named = words::is_reserved(self.token_text(behind - 1));
        (value && branches && !named && self.wants("{")).then(|| {
            Diagnostic::error(code::SYNTAX, "the value of a condition stands behind it, in `{ }`")
                .label(self.span_of(behind), "")
                .hint("write `if c { a } else { b }`")
        })
    }

    /// Returns the diagnostic for a test whose name is not a text, `test hello { ... }`; `None` if the mistake is
    /// something else.
    pub(super) fn name_of_test(&self) -> Option<Diagnostic> {
        let is_word = self.kind_of(1) == Some(TokenKind::Word);
        if self.token_text(0) != "test" || self.found != 1 || !is_word || self.begins_line() {
            return None;
        }
        let words = (1..self.tokens.len()).take_while(|&i| self.kind_of(i) == Some(TokenKind::Word));
        let name: Vec<&str> = words.map(|i| self.token_text(i)).collect();
        self.error("the name of a test is a text")
            .map(|d| d.hint(format!("write `test \"{}\" {{ ... }}`", name.join(" "))))
    }

    /// Returns the diagnostic for an assignment, such as `x = x + 1` or `m.tilt = 30deg`, in place of a statement or
    /// clause; `None` if the mistake is something else.
    pub(super) fn assignment(&self) -> Option<Diagnostic> {
        if !matches!(self.place, BodyKind::Items | BodyKind::Statements | BodyKind::Config) {
            return None;
        }
        let end = (0..self.tokens.len()).find(|&i| self.token_text(i) == "=")?;
        if end == 0 || !matches!(self.found, 0 | 1) && self.found != end || !self.is_path(end) {
            return None;
        }
        let target = self.written(0, end)?;
        let value = self.written(end + 1, self.tokens.len()).unwrap_or("...");
        let mark = self.error_at(code::SYNTAX, end, format!("`=` cannot change `{target}`"))?;
        if end == 1 && self.place == BodyKind::Config {
            return None;
        }
        if end == 1 {
            let name = self.token_text(0);
            let mentions = (end + 1..self.tokens.len()).any(|i| self.token_text(i) == name);
            return Some(match mentions {
                true => mark
                    .hint(format!(
                        "a value never changes; a new one has a name of its own: `let next = {value}`"
                    ))
                    .hint("what a loop would gather is a list: `sum([e for x in list])`"),
                false => mark.hint(format!("a name is given its value once, by `let {target} = {value}`")),
            });
        }
        let start = match self.place {
            BodyKind::Config => "where a joint is at the start is set by",
            _ => "where a joint is at the start is set in a `config`:",
        };
        let mark = mark
            .hint(format!("a joint is moved by a behaviour: `move({target}, to: {value})`"))
            .hint(format!("{start} `set {target} = {value}`"));
        let [.., dot, field] = &self.tokens[..end] else { return Some(mark) };
        let owner = &self.text[self.tokens[0].start..dot.start];
        let field = &self.text[field.start..field.end];
        Some(match self.place {
            BodyKind::Config => mark,
            _ => mark.hint(format!("a changed copy of a record is `{owner} with {{ {field}: {value} }}`")),
        })
    }

    /// Returns true if the tokens before `end` are a path: `x`, `a.b`, `a[1].b`.
    fn is_path(&self, end: usize) -> bool {
        let words = self.kind_of(0) == Some(TokenKind::Word) && !words::is_reserved(self.token_text(0));
        let rest = (1..end).all(|i| match self.kind_of(i) {
            Some(TokenKind::Word) => matches!(self.token_text(i - 1), "." | "["),
            Some(TokenKind::Number) => self.token_text(i - 1) == "[",
            _ => matches!(self.token_text(i), "." | "[" | "]"),
        });
        words && rest && !self.place.keywords().contains(&self.token_text(0))
    }

    /// Returns what is written from one token up to, without, another, if it is short and on one line.
    fn written(&self, from: usize, to: usize) -> Option<&str> {
        let (first, last) = (self.tokens.get(from)?, self.tokens.get(to.checked_sub(1)?)?);
        let text = self.text.get(first.start..last.end)?;
        (text.len() <= REPEATED_MAX && !text.contains('\n')).then_some(text)
    }

    /// Returns the diagnostic for a comprehension without brackets, such as `Pc(f(x) for x in xs)`; `None` if the
    /// mistake is something else.
    pub(super) fn bare_comprehension(&self) -> Option<Diagnostic> {
        if self.found() != "for" || self.in_text || !(self.wants(")") && self.wants(",")) {
            return None;
        }
        let depths = |i: usize| match self.kind_of(i) {
            Some(TokenKind::Open) => 1,
            Some(TokenKind::Close) => -1,
            _ => 0,
        };
        let mut depth = 0;
        let open = (0..self.found).rev().find(|&i| {
            depth += depths(i);
            depth == 1
        })?;
        let mut depth = 1;
        let close = (open + 1..self.tokens.len()).find(|&i| {
            depth += depths(i);
            depth == 0
        });
        let called = open.checked_sub(1).filter(|&i| self.kind_of(i) == Some(TokenKind::Word));
        let name = called.map_or("", |i| self.token_text(i));
        let mut depth = 0;
        let comma = (open + 1..self.found).rev().find(|&i| {
            depth += depths(i);
            depth == 0 && self.token_text(i) == ","
        });
        let first = comma.map_or(open + 1, |comma| comma + 1);
        let before = comma.map_or(Some(""), |comma| self.written(open + 1, comma + 1));
        let hint = match (before, close.and_then(|close| self.written(first, close))) {
            (Some(""), Some(list)) => format!("write `{name}([{list}])`"),
            (Some(before), Some(list)) => format!("write `{name}({before} [{list}])`"),
            _ => format!("write `{name}([... for x in list])`"),
        };
        self.error("`for` stands in a list here, in `[ ]`").map(|d| d.hint(hint))
    }
}
