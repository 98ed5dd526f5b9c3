//! The first pass over a text: comments, brackets, characters and the beginnings of items.
//!
//! Mistakes found here are reported here and recorded as faults, so that the parser reports nothing that
//! follows from them. The parser gets a text of the same length in which comments are blanks and characters
//! that are not allowed are replaced by their probable meaning.

use super::ast::{Comment, CommentKind};
use super::characters;
use super::explain;
use super::lex::{Lexer, Token, TokenKind};
use super::parse::{DIAGNOSTICS_MAX, NESTING_MAX};
use super::quotient::{self, Quotient};
use super::words;
use crate::source::{Diagnostic, FileId, Span};
use std::borrow::Cow;
use std::ops::Range;

/// The distance in bytes within which a wrong closing bracket is matched with an open one on its line.
const LINE_LENGTH: usize = 500;

/// The result of [`scan`], the first pass over a text: its comments, the beginnings of its chunks, and its faults.
pub(super) struct Scan<'t> {
    /// The text that the grammar reads: of the length of the one scanned, with comments as blanks and odd characters
    /// replaced.
    pub(super) text: Cow<'t, str>,
    /// All comments, in order of position.
    pub(super) comments: Vec<Comment>,
    /// The offsets in bytes at which chunks begin, in order: at item keywords outside all brackets.
    pub(super) chunks: Vec<usize>,
    /// The diagnostics, in order of discovery.
    pub(super) diagnostics: Vec<Diagnostic>,
    /// The faults that have been reported, in order of discovery.
    pub(super) faults: Vec<Fault>,
    /// The offsets in bytes of opening brackets that are never closed, in order.
    pub(super) unclosed: Vec<usize>,
    /// True if brackets nest too deeply somewhere.
    pub(super) too_deep: bool,
}

/// A mistake of characters or brackets that has been reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fault {
    /// Its offset in bytes.
    pub(super) at: usize,
    /// True if the grammar must not read this span: recursion would be too deep, or the meaning is lost.
    pub(super) fatal: bool,
}

impl Scan<'_> {
    /// Returns the ranges of bytes of the chunks, in order, without gaps up to the end.
    pub(super) fn ranges(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let ends = self.chunks.iter().skip(1).copied().chain([self.text.len()]);
        self.chunks.iter().copied().zip(ends).map(|(start, end)| start..end)
    }
}

/// Scans a text: finds its comments, the beginnings of its chunks, and mistakes of characters and brackets.
pub(super) fn scan(file: FileId, text: &str) -> Scan<'_> {
    let scan = Scanner::new(file, text, Resync::SureItems).run();
    match scan.unclosed.is_empty() {
        true => scan,
        // A bracket is never closed: any item keyword in the first column then begins an item.
        false => Scanner::new(file, text, Resync::AllItems).run(),
    }
}

/// The words in the first column that begin an item although brackets are open.
#[derive(Clone, Copy, PartialEq)]
enum Resync {
    /// Those that are not possible inside brackets.
    SureItems,
    /// All item keywords.
    AllItems,
}

struct Scanner<'t> {
    file: FileId,
    source: &'t str,
    resync: Resync,
    open: Vec<usize>,
    /// The number of open `(`, `[` and `{`.
    open_of_kind: [usize; 3],
    /// The number of open brackets beyond those in `open`, which are as many as may be.
    too_deep_by: usize,
    /// The text for the grammar, once it differs from what was written.
    masked: Option<Vec<u8>>,
    scan: Scan<'t>,
    /// True once deep nesting was reported for the current chunk.
    deep_reported: bool,
    /// The previous token on the same line; `None` at its beginning.
    previous: Option<Token>,
    /// The offset of the previous character of the line that is not allowed, if there is one.
    stray: Option<usize>,
    /// All such characters of the line.
    strays: Vec<char>,
    /// The offset at which scanning continues after what was meant as a comment, if something was.
    skip_to: Option<usize>,
    /// The brackets whose closing ones are in comments that look like divisors.
    swallowed: Vec<(usize, Quotient)>,
}

impl<'t> Scanner<'t> {
    /// Returns a scanner that has read nothing yet.
    fn new(file: FileId, source: &'t str, resync: Resync) -> Scanner<'t> {
        let scan = Scan {
            text: Cow::Borrowed(source),
            comments: Vec::new(),
            chunks: Vec::new(),
            diagnostics: Vec::new(),
            faults: Vec::new(),
            unclosed: Vec::new(),
            too_deep: false,
        };
        Scanner {
            file,
            source,
            resync,
            open: Vec::new(),
            open_of_kind: [0; 3],
            too_deep_by: 0,
            masked: None,
            scan,
            deep_reported: false,
            previous: None,
            stray: None,
            strays: Vec::new(),
            skip_to: None,
            swallowed: Vec::new(),
        }
    }

    /// Reads the whole text, and returns what was found.
    fn run(mut self) -> Scan<'t> {
        let start = if self.source.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        self.scan.chunks.push(start);
        let mut lexer = Lexer::new(self.source, start);
        while let Some(token) = lexer.next() {
            self.token(token, &lexer);
            if let Some(end) = self.skip_to.take() {
                lexer = Lexer::new(self.source, end);
            }
        }
        self.close_all(self.source.len());
        for (open, quotient) in std::mem::take(&mut self.swallowed) {
            let told = match self.scan.unclosed.contains(&open) {
                true => {
                    let bracket = self.source.as_bytes()[open] as char;
                    quotient.unclosed(bracket, self.span(open, open + 1))
                }
                false => quotient.warning(),
            };
            self.report(told);
        }
        if let Some(bytes) = self.masked {
            let text = String::from_utf8(bytes).expect("whole characters were replaced by ASCII");
            self.scan.text = Cow::Owned(text);
        }
        self.scan.unclosed.sort_unstable();
        self.scan.faults.sort_by_key(|fault| fault.at);
        self.scan
    }

    fn token(&mut self, token: Token, rest: &Lexer) {
        match token.kind {
            TokenKind::LineBreak => {
                self.previous = None;
                self.stray = None;
                self.strays.clear();
                return;
            }
            TokenKind::LineComment => self.line_comment(token),
            TokenKind::BlockComment { depth } => self.block_comment(token, depth),
            TokenKind::Word if self.previous.is_none() => self.first_word(token, rest),
            TokenKind::Text { depth } => self.text(token, depth),
            TokenKind::Open => self.open(token.start),
            TokenKind::Close => self.close(token.start),
            TokenKind::UnclosedText | TokenKind::UnclosedRawText | TokenKind::UnclosedComment => {
                self.unclosed_token(token);
            }
            TokenKind::Stray => self.stray(token),
            TokenKind::Word | TokenKind::Number | TokenKind::Operator => {}
        }
        self.previous = Some(token);
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    /// Reports a fault.
    fn tell(&mut self, diagnostic: Diagnostic, at: usize, fatal: bool) {
        self.scan.faults.push(Fault { at, fatal });
        self.report(diagnostic);
    }

    /// Adds a diagnostic, up to the limit.
    fn report(&mut self, diagnostic: Diagnostic) {
        if self.scan.diagnostics.len() < DIAGNOSTICS_MAX {
            self.scan.diagnostics.push(diagnostic);
        }
    }

    /// Begins a chunk at a word that begins an item.
    fn first_word(&mut self, token: Token, rest: &Lexer) {
        let word = &self.source[token.start..token.end];
        if !words::ITEMS.contains(&word) || !begins_item(self.source, token, rest) {
            return;
        }
        if !self.open.is_empty() {
            let first_column = token.start == 0 || self.source.as_bytes()[token.start - 1] == b'\n';
            let sure = !matches!(word, "let" | "fn" | "strut" | "cell");
            if !first_column || !(sure || self.resync == Resync::AllItems) {
                return;
            }
            self.close_all(token.start);
        }
        self.scan.chunks.push(token.start);
        self.deep_reported = false;
    }

    fn line_comment(&mut self, token: Token) {
        let text = &self.source[token.start..token.end];
        let kind = match text.as_bytes().get(2..) {
            Some([b'/', b'/', ..]) => CommentKind::Line,
            Some([b'/', ..]) => CommentKind::ItemDoc,
            Some([b'!', ..]) => CommentKind::FileDoc,
            _ => CommentKind::Line,
        };
        let end = token.start + text.trim_end_matches('\r').len();
        self.scan.comments.push(Comment { span: self.span(token.start, end), kind });
        self.hidden_characters(token);
        let after = self.previous.filter(|_| kind == CommentKind::Line);
        let quotient = after.and_then(|before| {
            let mark = self.span(token.start, token.end);
            quotient::meant(self.source, before, token, mark)
        });
        match (quotient, self.open.last()) {
            (Some(quotient), Some(&open)) if quotient.swallows && self.swallowed.len() < DIAGNOSTICS_MAX => {
                self.swallowed.push((open, quotient));
            }
            (Some(quotient), _) => self.report(quotient.warning()),
            (None, _) => {}
        }
        self.replace(token.start, token.end, ' ');
    }

    fn block_comment(&mut self, token: Token, depth: usize) {
        let span = self.span(token.start, token.end);
        self.scan.comments.push(Comment { span, kind: CommentKind::Block });
        self.hidden_characters(token);
        if depth > NESTING_MAX {
            let opener = self.span(token.start, token.start + 2);
            self.report(explain::too_deep(opener, "this comment"));
        }
        self.replace(token.start, token.end, ' ');
    }

    /// Checks a text.
    fn text(&mut self, token: Token, depth: usize) {
        self.hidden_characters(token);
        if self.open.len() + depth > NESTING_MAX {
            self.too_deep(token.start, token.start + 1);
        }
    }

    /// Records an opening bracket; reports deep nesting. Brackets deeper than the limit are only counted.
    fn open(&mut self, at: usize) {
        if self.open.len() > NESTING_MAX {
            self.too_deep_by += 1;
            return;
        }
        self.open.push(at);
        self.open_of_kind[self.kind(at)] += 1;
        if self.open.len() > NESTING_MAX {
            self.too_deep(at, at + 1);
        }
    }

    /// Returns the kind of the bracket at an offset: 0 for `( )`, 1 for `[ ]`, 2 for `{ }`.
    fn kind(&self, at: usize) -> usize {
        match self.source.as_bytes()[at] {
            b'(' | b')' => 0,
            b'[' | b']' => 1,
            _ => 2,
        }
    }

    /// Removes the open brackets from an index on, and returns them.
    fn pop_from(&mut self, index: usize) -> Vec<usize> {
        let popped = self.open.split_off(index);
        for &at in &popped {
            self.open_of_kind[self.kind(at)] -= 1;
        }
        popped
    }

    /// Reports deep nesting, once for each chunk.
    fn too_deep(&mut self, at: usize, end: usize) {
        self.scan.too_deep = true;
        self.scan.faults.push(Fault { at, fatal: true });
        if !std::mem::replace(&mut self.deep_reported, true) {
            let span = self.span(at, end);
            self.report(explain::too_deep(span, "the program"));
        }
    }

    /// Matches a closing bracket with an open one.
    fn close(&mut self, at: usize) {
        if self.too_deep_by > 0 {
            self.too_deep_by -= 1;
            return;
        }
        let kind = self.kind(at);
        if self.open_of_kind[kind] == 0 {
            return self.stray_closer(at);
        }
        let matching = self.open.iter().rposition(|open| self.kind(*open) == kind);
        let mut unclosed = self.pop_from(matching.expect("one of this kind is open"));
        unclosed.remove(0);
        self.unclosed(&unclosed, at);
    }

    /// Reports a closing bracket without an open one of its kind.
    fn stray_closer(&mut self, at: usize) {
        let span = self.span(at, at + 1);
        let innermost = self.open.last().copied();
        let innermost_span = innermost.map(|open| self.span(open, open + 1));
        let closer = self.source.as_bytes()[at] as char;
        self.tell(explain::stray_closer(closer, span, innermost_span), at, false);
        // `(a]`: the wrong bracket closes the one open on its line.
        match innermost {
            Some(open)
                if self.kind(open) != 2
                    && at - open < LINE_LENGTH
                    && !self.source.as_bytes()[open..at].contains(&b'\n') =>
            {
                self.pop_from(self.open.len() - 1);
                self.scan.faults.push(Fault { at: open, fatal: false });
            }
            _ => self.replace(at, at + 1, ' '),
        }
    }

    /// Reports all open brackets at the end of the file, or at an item that begins although brackets are
    /// open.
    fn close_all(&mut self, at: usize) {
        self.too_deep_by = 0;
        let open = self.pop_from(0);
        self.unclosed(&open, at);
    }

    /// Reports brackets that should have been closed before `at`, all in one diagnostic.
    fn unclosed(&mut self, open: &[usize], at: usize) {
        if open.is_empty() {
            return;
        }
        // The end of the scan tells why these are open.
        let swallowed = |at: &usize| self.swallowed.iter().any(|(open, _)| open == at);
        let spans: Vec<(char, Span)> = open
            .iter()
            .filter(|at| !swallowed(at))
            .map(|&open| (self.source.as_bytes()[open] as char, self.span(open, open + 1)))
            .collect();
        if !self.deep_reported && !spans.is_empty() {
            self.report(explain::unclosed(&spans, self.found_at(at)));
        }
        for &open in open {
            self.scan.unclosed.push(open);
            self.scan.faults.push(Fault { at: open, fatal: false });
        }
    }

    /// Returns the span of the token at which a missing bracket is noticed; `None` at the end of the text.
    fn found_at(&self, at: usize) -> Option<Span> {
        let token = Lexer::new(self.source, at).next()?;
        Some(self.span(token.start, token.end))
    }

    /// Reports an unclosed text or comment.
    fn unclosed_token(&mut self, token: Token) {
        if token.kind == TokenKind::UnclosedComment {
            let span = self.span(token.start, token.end);
            self.scan.comments.push(Comment { span, kind: CommentKind::Block });
        }
        self.hidden_characters(token);
        let (length, what) = match token.kind {
            TokenKind::UnclosedText => (1, "text"),
            TokenKind::UnclosedRawText => (3, "text"),
            _ => (2, "comment"),
        };
        let opener = self.span(token.start, token.start + length);
        self.tell(explain::unclosed_token(opener, what, length), token.start, false);
        if token.kind == TokenKind::UnclosedComment {
            self.replace(token.start, token.end, ' ');
        }
    }

    /// Reports characters in a comment or text that are invisible or change the order of reading.
    fn hidden_characters(&mut self, token: Token) {
        let text = &self.source[token.start..token.end];
        if text.bytes().all(|b| (b' '..0x7f).contains(&b) || matches!(b, b'\n' | b'\t' | b'\r')) {
            return;
        }
        for (at, c) in text.char_indices().filter(|(_, c)| characters::is_forbidden_anywhere(*c)) {
            let at = token.start + at;
            let span = self.span(at, at + c.len_utf8());
            self.report(characters::forbidden(c, span));
        }
    }

    /// Reports a character that is not allowed, and replaces it by its probable meaning.
    fn stray(&mut self, token: Token) {
        let c = self.source[token.start..].chars().next().expect("a token is not empty");
        let span = self.span(token.start, token.end);
        let meant = characters::meant(c);
        // Repetitions on a line are one mistake, and so is a word with several odd letters.
        let in_word = meant.replacement == Some('_')
            && self.stray.is_some_and(|before| is_word(&self.source[before..token.start]));
        let fatal = meant.replacement.is_none();
        match in_word || self.strays.contains(&c) {
            true => self.scan.faults.push(Fault { at: token.start, fatal }),
            false => self.tell(characters::stray(c, span), token.start, fatal),
        }
        self.stray = Some(token.start);
        self.strays.push(c);
        self.replace(token.start, token.end, meant.replacement.unwrap_or(' '));
        if c == '#' {
            // The rest of the line is prose, not code.
            let end = self.source[token.start..].find('\n').map_or(self.source.len(), |at| token.start + at);
            self.replace(token.start, end, ' ');
            self.skip_to = Some(end);
        }
    }

    /// Replaces bytes by `with` and blanks (or by `_` within a word).
    fn replace(&mut self, start: usize, end: usize, with: char) {
        let bytes = self.masked.get_or_insert_with(|| self.source.as_bytes().to_vec());
        let fill = if with == '_' { b'_' } else { b' ' };
        for byte in bytes[start..end].iter_mut().filter(|byte| **byte != b'\n') {
            *byte = fill;
        }
        if with != ' ' {
            bytes[start] = with as u8;
        }
    }
}

/// Returns true if a text is a name.
fn is_word(text: &str) -> bool {
    text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Returns true if the tokens after a keyword show that it begins an item: a name or a text on its line. Two words
/// side by side occur in no expression, so an item is never split here.
fn begins_item(text: &str, token: Token, rest: &Lexer) -> bool {
    let next = rest.clone().find(|token| token.kind != TokenKind::LineBreak);
    next.is_some_and(|next| match next.kind {
        TokenKind::Word => {
            !matches!(&text[next.start..next.end], "and" | "or" | "else" | "in" | "if" | "for")
        }
        TokenKind::Text { .. } => matches!(&text[token.start..token.end], "use" | "test"),
        _ => false,
    })
}
