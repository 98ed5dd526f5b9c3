//! Explanation of parse errors: the token at which the grammar stopped, in the user's words.

use super::explain;
use super::lex::{Token, TokenKind};
use super::parse::Failure;
use super::split::tokens;
use super::words;
use crate::source::foreign;
use crate::source::suggest::suggest;
use crate::source::{Code, Diagnostic, FileId, Span, code, floor_char_boundary};
use std::cell::Cell;

/// The number of bytes behind a piece in which the token is looked for that ends it.
const AHEAD_MAX: usize = 200;

/// The kind of body in which a piece of text that does not parse stands: it decides which keywords may begin a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BodyKind {
    Items,
    Statements,
    Module,
    Config,
    Truss,
}

impl BodyKind {
    /// Returns the keywords that begin a piece in this kind of body.
    pub(super) fn keywords(self) -> &'static [&'static str] {
        match self {
            BodyKind::Items => words::ITEMS_AND_STATEMENTS,
            BodyKind::Statements => words::STATEMENTS,
            BodyKind::Module => words::MODULE,
            BodyKind::Config => words::CONFIG,
            BodyKind::Truss => words::TRUSS,
        }
    }

    /// Returns the phrase for such a piece, and for where it belongs.
    fn name(self) -> &'static str {
        match self {
            BodyKind::Items => "an item of a file",
            BodyKind::Statements => "a statement",
            BodyKind::Module => "a clause of a module",
            BodyKind::Config => "a clause of a configuration",
            BodyKind::Truss => "a clause of a truss",
        }
    }
}

/// A syntax error: the tokens of a piece of text, and the one at which the grammar failed.
pub(super) struct Mistake<'t> {
    /// The text of the piece.
    pub(super) text: &'t str,
    /// The offset in bytes of the piece in the whole text.
    pub(super) base: usize,
    /// The file of the piece.
    pub(super) file: FileId,
    /// The tokens of the piece, in order, without comments and line breaks; of the `{ }` of a text where the mistake
    /// is in one. Their offsets are in `text`.
    pub(super) tokens: Vec<Token>,
    /// The index of the faulty token in `tokens`, from 0; the number of tokens if the piece ends too early.
    pub(super) found: usize,
    /// The failure that the parser reported.
    pub(super) failure: &'t Failure,
    /// The body that the piece stands in.
    pub(super) place: BodyKind,
    /// True if the mistake is in an interpolation, the `{ }` of a text.
    pub(super) in_text: bool,
    /// The misspelt keyword, once that explains the mistake.
    misspelt: Cell<Option<Misspelt>>,
}

/// A keyword that is misspelt in a program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misspelt {
    /// The offset in bytes of the word in the file.
    pub(super) start: usize,
    /// The offset after the last byte of the word in the file.
    pub(super) end: usize,
    /// The keyword that was most likely meant.
    pub(super) meant: &'static str,
}

/// Returns (diagnostic, keyword) for a piece `text` that begins at the offset `base`, in bytes, of the `whole` text:
/// the diagnostic of its mistake, and the misspelt keyword if that is the mistake, else `None`.
pub(super) fn explain(
    failure: &Failure,
    text: &str,
    base: usize,
    place: BodyKind,
    whole: &str,
    file: FileId,
) -> (Diagnostic, Option<Misspelt>) {
    let mut tokens = tokens(text, 0..text.len());
    let mut in_text = false;
    let mut found = tokens.iter().position(|token| token.end > failure.at).unwrap_or(tokens.len());
    if let Some(inside) = inside_text(&tokens, found, failure.at, text) {
        // The mistake is in the `{ }` of a text: its contents are examined token by token.
        tokens.truncate(found);
        tokens.extend(inside);
        in_text = true;
    }
    found = found.min(tokens.len());
    // The sign was read as the beginning of an operator, and nothing was tried after it.
    if failure.wanted.is_empty() && found > 0 && tokens[found - 1].end == failure.at {
        found -= 1;
    }
    // After a reserved word the grammar only checks whether the word continues: the word is the mistake.
    if let Some(before) = found.checked_sub(1).map(|before| tokens[before])
        && before.end == failure.at
        && words::is_reserved(&text[before.start..before.end])
        && failure.wanted.iter().all(|wanted| matches!(wanted.as_str(), "a..z" | "A..Z" | "0..9" | "_"))
    {
        found -= 1;
    }
    let mistake =
        Mistake { text, base, file, tokens, found, failure, place, in_text, misspelt: Cell::new(None) };
    (mistake.explain(whole), mistake.misspelt.get())
}

/// Returns the tokens in the `{ }` of a text that holds the offset `at`; `None` if that is in no text.
fn inside_text(all: &[Token], found: usize, at: usize, text: &str) -> Option<Vec<Token>> {
    let token = all.get(found)?;
    let is_text = matches!(token.kind, TokenKind::Text { .. }) && token.start < at;
    is_text.then(|| tokens(text, at..token.end))
}

impl Mistake<'_> {
    /// Returns the most specific explanation that applies.
    fn explain(&self, whole: &str) -> Diagnostic {
        if self.failure.too_deep {
            return explain::too_deep(self.span_of(0), "this");
        }
        None.or_else(|| self.later())
            .or_else(|| self.foreign_format())
            .or_else(|| self.name_of_test())
            .or_else(|| self.assignment())
            .or_else(|| self.first_word())
            .or_else(|| self.inner_word())
            .or_else(|| self.connection())
            .or_else(|| self.reserved_name())
            .or_else(|| self.foreign_mark())
            .or_else(|| self.turned_condition())
            .or_else(|| self.built_in_braces())
            .or_else(|| self.with_without_braces())
            .or_else(|| self.bare_comprehension())
            .or_else(|| self.wrong_mark())
            .or_else(|| self.brace_literal())
            .or_else(|| self.line_start())
            .or_else(|| self.missing_type())
            .or_else(|| self.own_line())
            .unwrap_or_else(|| self.missing(whole))
    }

    /// Returns the text of the token at an index, from 0; empty if there is none.
    pub(super) fn token_text(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| &self.text[token.start..token.end])
    }

    /// Returns the text of the faulty token; empty if the piece ends too early.
    pub(super) fn found(&self) -> &str {
        self.token_text(self.found)
    }

    /// Returns the text of the token before the faulty one; empty if there is none.
    pub(super) fn before(&self) -> &str {
        self.found.checked_sub(1).map_or("", |before| self.token_text(before))
    }

    /// Returns the kind of the token at an index, from 0; `None` past the last token.
    pub(super) fn kind_of(&self, index: usize) -> Option<TokenKind> {
        self.tokens.get(index).map(|token| token.kind)
    }

    /// Returns the span in the file of the token at an index, from 0; past the last token an empty span at its end.
    pub(super) fn span_of(&self, index: usize) -> Span {
        let (start, end) = match (self.tokens.get(index), self.tokens.last()) {
            (Some(token), _) => (token.start, token.end),
            (None, Some(last)) => (last.end, last.end),
            (None, None) => (0, 0),
        };
        Span::new(self.file, self.base + start, self.base + end)
    }

    /// Returns true if the grammar would have accepted exactly this text where the parser stopped.
    pub(super) fn wants(&self, text: &str) -> bool {
        self.failure.wanted.iter().any(|wanted| wanted == text)
    }

    /// Returns true if the grammar would have accepted any expression.
    pub(super) fn wants_expression(&self) -> bool {
        self.wants("\"") && self.wants("[") && self.wants("not")
    }

    /// Returns true if the faulty token begins a line.
    pub(super) fn begins_line(&self) -> bool {
        let Some(before) = self.found.checked_sub(1).and_then(|before| self.tokens.get(before)) else {
            return false;
        };
        let end = self.tokens.get(self.found).map_or(self.text.len(), |token| token.start);
        self.text[before.end..end].contains('\n')
    }

    /// Returns an error at the faulty token. Never `None`: it is an `Option` because the explanations that end with it
    /// return one.
    pub(super) fn error(&self, message: impl Into<String>) -> Option<Diagnostic> {
        self.error_at(code::SYNTAX, self.found, message)
    }

    /// Returns an error at the token at an index, from 0, or past the last token. Never `None`, as for
    /// [`Mistake::error`].
    pub(super) fn error_at(
        &self,
        code: Code,
        index: usize,
        message: impl Into<String>,
    ) -> Option<Diagnostic> {
        Some(Diagnostic::error(code, message).label(self.span_of(index), ""))
    }

    /// Explains a part of the language that is reserved but not built yet.
    fn later(&self) -> Option<Diagnostic> {
        let item = self.token_text(0) == "role" && self.kind_of(1) == Some(TokenKind::Word);
        let index = match (self.before(), self.found()) {
            _ if item && self.place == BodyKind::Items => 0,
            ("closed", "(") => self.found - 1,
            (_, "ensures") => self.found,
            _ => return None,
        };
        let what = match self.token_text(index) {
            "closed" => "closed (solves ...)",
            what => what,
        };
        self.error_at(code::LATER, index, format!("`{what}` is not built yet"))
    }

    /// Explains a first word that begins nothing here: misspelt, or in the wrong body.
    fn first_word(&self) -> Option<Diagnostic> {
        let first = self.token_text(0);
        let is_word = self.kind_of(0) == Some(TokenKind::Word);
        if !is_word || self.found > 1 || self.place.keywords().contains(&first) || words::is_reserved(first) {
            return None;
        }
        let may_be_expression = matches!(self.place, BodyKind::Items | BodyKind::Statements);
        if may_be_expression && !self.two_words() {
            return None;
        }
        let message = match elsewhere(first) {
            Some(place) => format!("`{first}` begins {}, not {}", place.name(), self.place.name()),
            None => format!("`{first}` does not begin {}", self.place.name()),
        };
        let diagnostic = Diagnostic::error(code::SYNTAX, message).label(self.span_of(0), "");
        if let Some(instead) = foreign::instead(first) {
            return Some(diagnostic.hint(instead));
        }
        if may_be_expression && matches!(first, "print" | "emit" | "show" | "save") {
            return Some(diagnostic.hint(format!("what it takes stands in brackets: `{first}(...)`")));
        }
        if self.place == BodyKind::Config && self.token_text(1) == "=" {
            return Some(diagnostic.hint(format!(
                "a part is declared by `part {first}: Type`, any other value by `let {first} = ...`"
            )));
        }
        let meant = suggest(first, self.place.keywords().iter().copied());
        Some(match meant {
            Some(meant) if elsewhere(first).is_none() => {
                self.note_misspelt(0, meant);
                diagnostic.hint(format!("`{meant}`?"))
            }
            _ if may_be_expression => diagnostic,
            _ => diagnostic.hint(format!("here stand {}", listed(self.place.keywords()))),
        })
    }

    /// Returns true if the piece begins with two words, or with a word and a text, as no expression does.
    fn two_words(&self) -> bool {
        let apart = self.tokens.len() > 1 && self.tokens[0].end < self.tokens[1].start;
        match self.kind_of(1) {
            Some(TokenKind::Word) => true,
            Some(TokenKind::Text { .. }) => apart && !self.begins_line(),
            _ => false,
        }
    }

    /// Records that a token is a misspelt keyword.
    fn note_misspelt(&self, index: usize, meant: &'static str) {
        let span = self.span_of(index);
        self.misspelt.set(Some(Misspelt { start: span.start as usize, end: span.end as usize, meant }));
    }

    /// Explains a misspelt keyword after a complete expression or clause.
    fn inner_word(&self) -> Option<Diagnostic> {
        let found = self.found();
        let is_word = self.kind_of(self.found) == Some(TokenKind::Word);
        if !is_word || self.in_text || words::is_reserved(found) {
            return None;
        }
        let meant = suggest(found, self.place.keywords().iter().copied());
        if !self.wants_operator() && !meant.is_some_and(|meant| self.wants(meant)) {
            return None;
        }
        if let Some(instead) = foreign::instead(found).or_else(|| foreign::instead(self.before())) {
            let diagnostic = self.error(format!("`{found}` cannot stand here"));
            return diagnostic.map(|diagnostic| diagnostic.hint(instead));
        }
        let meant = meant?;
        self.note_misspelt(self.found, meant);
        let message = format!("`{found}` does not begin {}", self.place.name());
        self.error(message).map(|diagnostic| diagnostic.hint(format!("`{meant}`?")))
    }

    fn connection(&self) -> Option<Diagnostic> {
        let (first, what) = match self.token_text(0) {
            "connect" => ("connect", "ports"),
            "strut" => ("strut", "nodes"),
            _ => return None,
        };
        if !self.wants("--") {
            return None;
        }
        let diagnostic = match self.found() {
            "-" | "->" | "," | "to" | "<->" | "and" | "with" | "+" | "++" | "=" => {
                self.error(format!("`--` joins the two {what}, not `{}`", self.found()))
            }
            _ => self.error(format!("`--` is missing between the two {what}")),
        };
        diagnostic.map(|diagnostic| diagnostic.hint(format!("write `{first} a -- b`")))
    }

    /// Explains a reserved word used as a name.
    fn reserved_name(&self) -> Option<Diagnostic> {
        let found = self.found();
        let before = self.before();
        let behind = matches!(
            before,
            "alias" | "base" | "set" | "connect" | "--" | "->" | "for" | "on" | "of" | "as" | ":"
        );
        let declares = behind || words::DECLARING.contains(&before);
        (words::is_reserved(found) && declares && !self.wants_expression()).then(|| {
            self.error(format!("`{found}` is a reserved word and cannot be a name"))
                .expect("an error was made")
                .hint(format!("the reserved words are {}", listed(words::RESERVED)))
        })
    }

    /// Explains one mark where another was meant.
    fn wrong_mark(&self) -> Option<Diagnostic> {
        let found = self.found();
        let hint = match found {
            "==" if self.wants("=") || self.wants_expression() && self.found == 2 => {
                "one `=` gives a name its value; `==` compares"
            }
            "=" | "->" if self.wants(":") && !self.wants("=") => "the type stands behind `:`",
            ":" | "=>" | ":=" if self.wants("=") => "the value stands behind `=`",
            ":" if self.wants("->") => "the result stands behind `->`",
            "?" => "write `if c { a } else { b }`",
            "=" if self.wants_operator() => "`==` compares; `=` gives a name its value in `let name = ...`",
            "." if self.wants_expression() && self.kind_of(self.found + 1) == Some(TokenKind::Number) => {
                "write the zero: `0.5`"
            }
            "--" if self.wants_expression() || self.wants_operator() => {
                "`--` stands between two ports; write `a - -b` to subtract a negative number"
            }
            "|" if self.wants_operator() => "write `or`",
            _ => return None,
        };
        self.error(format!("`{found}` cannot stand here")).map(|diagnostic| diagnostic.hint(hint))
    }

    /// Returns true if the faulty token follows a complete operand.
    pub(super) fn wants_operator(&self) -> bool {
        self.wants("*") && self.wants("^") || self.failure.wanted.is_empty()
    }

    /// Explains `+`, `-`, `(` or `[` that begins a line but was meant to continue one.
    fn line_start(&self) -> Option<Diagnostic> {
        let first = self.found().chars().next()?;
        let continues = matches!(self.found(), "+" | "-" | "(" | "[");
        let is_clause = !matches!(self.place, BodyKind::Items | BodyKind::Statements);
        let mark = self.span_of(self.found);
        (continues && (self.begins_line() && !self.wants_expression() || is_clause && self.found == 0))
            .then(|| explain::line_break(mark, first))
    }

    /// Explains a parameter or field without its type.
    fn missing_type(&self) -> Option<Diagnostic> {
        let first = self.token_text(0);
        let record = first == "record";
        let declares =
            record || matches!(first, "fn" | "extern" | "behavior") || words::FAMILIES.contains(&first);
        let ends =
            matches!(self.found(), "," | ")" | "=") || record && (self.found() == "}" || self.begins_line());
        let before = self.found.checked_sub(1)?;
        if !declares || !ends || !self.wants(":") || self.kind_of(before) != Some(TokenKind::Word) {
            return None;
        }
        let name = self.before();
        let what = if record { "field" } else { "parameter" };
        self.error_at(code::SYNTAX, before, format!("the {what} `{name}` needs a type"))
            .map(|diagnostic| diagnostic.hint(format!("write for example `{name}: Length`")))
    }

    /// Explains two statements on one line.
    fn own_line(&self) -> Option<Diagnostic> {
        let in_block = self.wants("}") && self.wants("let");
        let statements =
            matches!(self.place, BodyKind::Items | BodyKind::Statements) && !self.in_text || in_block;
        let begins = matches!(
            self.kind_of(self.found),
            Some(TokenKind::Word | TokenKind::Number | TokenKind::Text { .. })
        );
        let separate = self.wants_operator() && self.wants("\n") && !self.wants(",") && !self.wants(")");
        if !statements || !begins || !separate || self.begins_line() || self.found == 0 {
            return None;
        }
        if self.kind_of(self.found - 1) == Some(TokenKind::Number)
            && self.before().ends_with(|c: char| c.is_ascii_digit())
        {
            return None;
        }
        self.error(format!("`{}` cannot follow on this line", self.found()))
            .map(|d| d.hint("an operator is missing, or a line break: an expression that is a statement begins its own line"))
    }

    /// Explains what is missing before the faulty token.
    fn missing(&self, whole: &str) -> Diagnostic {
        let unit = self.kind_of(self.found) == Some(TokenKind::Word)
            && self.found > 0
            && self.kind_of(self.found - 1) == Some(TokenKind::Number)
            && self.before().ends_with(|c: char| c.is_ascii_digit())
            && self.wants_operator()
            && !self.begins_line();
        let wanted = self.wanted();
        let before = self.found_words(whole);
        // If a line or file ends too early, the span is after its last token.
        let ends = self.found >= self.tokens.len() || self.begins_line() && !wanted.is_empty();
        let span = match self.found.checked_sub(1).filter(|_| ends).and_then(|before| self.tokens.get(before))
        {
            Some(last) => Span::new(self.file, self.base + last.end, self.base + last.end),
            None => self.span_of(self.found),
        };
        let message = match wanted.as_slice() {
            [] if self.found >= self.tokens.len() => "this ends too early".to_string(),
            [] => format!("{before} cannot stand here"),
            wanted if ends => format!("{} is missing at the end of this line", listed_or(wanted)),
            wanted => format!("{} is missing before {before}", listed_or(wanted)),
        };
        let diagnostic = Diagnostic::error(code::SYNTAX, message).label(span, "");
        if let Some(measure) = foreign::measure(self.found()).filter(|_| unit) {
            return diagnostic.hint(measure);
        }
        if unit {
            let unit = foreign::unit(self.found()).unwrap_or(self.found());
            return diagnostic.hint(format!("a unit sticks to its number: `{}{unit}`", self.before()));
        }
        // Within an expression the form of the whole item does not help.
        if self.in_text && self.found() == "}" {
            return diagnostic
                .hint("a text takes values in: `\"{value}\"`; a brace of its own is written `\\{`");
        }
        let inside = !matches!(self.place, BodyKind::Items | BodyKind::Statements);
        if inside && words::FAMILIES.contains(&self.found()) {
            let hint =
                format!("a `{}` stands by itself in the file, outside of other declarations", self.found());
            return diagnostic.hint(hint);
        }
        match words::form(self.token_text(0)).filter(|_| !self.wants_expression() && !self.wants_operator()) {
            Some(form) => diagnostic.hint(format!("it is written `{form}`")),
            None => diagnostic,
        }
    }

    /// Returns the phrase for the faulty token.
    fn found_words(&self, whole: &str) -> String {
        let text = self.found();
        let Some(kind) = self.kind_of(self.found) else {
            let behind = self.base + self.text.len();
            let rest = tokens(whole, behind..floor_char_boundary(whole, behind + AHEAD_MAX));
            return match rest.first() {
                Some(token) => format!("`{}`", &whole[token.start..token.end]),
                None => "the end of the file".into(),
            };
        };
        let shortened: String = text.chars().take(20).collect();
        let shortened = if shortened.len() < text.len() { format!("{shortened}...") } else { shortened };
        match kind {
            TokenKind::Text { .. } => format!("the text {}", shortened.replace('\n', " ")),
            _ => format!("`{shortened}`"),
        }
    }

    /// Returns the phrases for what the grammar would have accepted, marks first.
    fn wanted(&self) -> Vec<String> {
        if self.wants_expression() {
            return vec!["an expression".into()];
        }
        const MARKS: [&str; 16] =
            [")", "]", "}", ",", ":", "=", "--", "->", "{", ">", "in", "of", "on", "facing", "as", "\""];
        // After an operand `>` is a comparison, and after the first word of an argument `:` may end a label.
        let misleading: &[&str] = match (self.wants_operator(), self.wants(",")) {
            (true, true) => &[">", ":", "="],
            (true, false) => &[">"],
            _ => &[],
        };
        let marks = MARKS.iter().filter(|mark| self.wants(mark) && !misleading.contains(mark));
        let marks = marks.map(|mark| format!("`{mark}`"));
        let mut wanted: Vec<String> = marks.take(4).collect();
        let after_word = self.found > 0 && self.tokens[self.found - 1].end == self.failure.at;
        if wanted.is_empty() && self.failure.wants_word && !after_word {
            wanted.push("a name".into());
        }
        wanted
    }
}

/// Returns the kind of body in which this keyword is used; `None` for other words.
fn elsewhere(word: &str) -> Option<BodyKind> {
    let places = [BodyKind::Items, BodyKind::Config, BodyKind::Module, BodyKind::Truss];
    places.into_iter().find(|place| place.keywords().contains(&word))
}

/// Returns a list of words: `a`, `b` and `c`.
fn listed(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    joined(&words, "and")
}

fn listed_or(words: &[String]) -> String {
    joined(words, "or")
}

fn joined(words: &[String], conjunction: &str) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} {conjunction} {last}", first.join(", ")),
        _ => words.concat(),
    }
}
