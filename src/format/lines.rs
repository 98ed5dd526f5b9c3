//! Lines: their pieces, their indentation, and blank lines between them.

use super::breaks::breaks;
use super::columns::Line;
use super::spacing::{Piece, before_last};
use crate::syntax::{Outline, Role, TokenKind};

/// The indentation of one level, in spaces.
const STEP: usize = 2;

/// An open bracket.
struct OpenBracket {
    /// The indentation of the line that it is on.
    line: usize,
}

/// Returns the formatted lines of a text, in order; chunks that can't be parsed stay as they are. `outline`: that of
/// the text. Lines that are too wide are broken if `broken` is true.
pub(super) fn lines(text: &str, outline: &Outline, broken: bool) -> Vec<Line> {
    let mut layout = Layout { open: Vec::new(), lines: Vec::new(), before: None, opened: false, broken };
    let start = outline.chunks.first().map_or(0, |chunk| chunk.range.start);
    let mut tokens = outline.tokens.iter().peekable();
    let mut at = start;
    for chunk in &outline.chunks {
        let mut pieces = Vec::new();
        while let Some(token) = tokens.next_if(|token| token.start < chunk.range.end) {
            pieces.push(Piece {
                token: *token,
                text: text[token.start..token.end].trim_end_matches('\r'),
                role: outline.roles.get(&token.start).copied(),
                margin: token.start == 0 || text.as_bytes()[token.start - 1] == b'\n',
                begins: outline.begins.contains(&token.start),
            });
        }
        if chunk.sound {
            layout.chunk(&pieces);
        } else {
            layout.as_it_is(&text[chunk.range.clone()]);
        }
        at = chunk.range.end;
    }
    debug_assert_eq!(at, text.len(), "chunks have no gaps");
    layout.lines
}

/// The state of formatting line by line.
struct Layout<'t> {
    open: Vec<OpenBracket>,
    lines: Vec<Line>,
    /// The last token of the chunk so far that is not a comment; `None` at its beginning.
    before: Option<Piece<'t>>,
    /// True if the last line ended with an opening bracket.
    opened: bool,
    /// True if lines that are too wide are broken.
    broken: bool,
}

impl<'t> Layout<'t> {
    /// Formats a chunk.
    fn chunk(&mut self, pieces: &[Piece<'t>]) {
        self.open.clear();
        self.before = None;
        self.opened = false;
        let (mut blanks, mut at) = (0, 0);
        for line in pieces.split(|piece| piece.token.kind == TokenKind::LineBreak) {
            at += line.len() + 1;
            if line.is_empty() {
                blanks += 1;
                continue;
            }
            let begin = at - line.len() - 1;
            self.fitted(&pieces[begin..], line.len(), blanks > 0);
            blanks = 0;
        }
        // Blank lines at the end of a chunk are put before the next.
        if blanks > 1 {
            self.lines.push(Line::blank());
        }
    }

    /// Formats the first `length` of the pieces of a chunk, which are a line, as several lines if one is too wide.
    fn fitted(&mut self, pieces: &[Piece<'t>], length: usize, blank: bool) {
        if blank && !self.opened && !pieces[0].closes() {
            self.lines.push(Line::blank());
        }
        let mut parts = vec![(0, length)];
        while let Some((from, to)) = parts.pop() {
            let (line, rest) = pieces[from..].split_at(to - from);
            let indent = self.indent(line, rest);
            let breaks = if self.broken { breaks(line, indent) } else { Vec::new() };
            if breaks.is_empty() {
                self.line(line, indent);
                continue;
            }
            let starts = std::iter::once(0).chain(breaks.iter().copied());
            let ends = breaks.iter().copied().chain([line.len()]);
            let own: Vec<(usize, usize)> = starts.zip(ends).map(|(a, b)| (from + a, from + b)).collect();
            parts.extend(own.into_iter().rev());
        }
    }

    /// Formats a line.
    fn line(&mut self, line: &[Piece<'t>], indent: usize) {
        let mut out = Line { indent, text: String::new(), comment: None };
        for (index, piece) in line.iter().enumerate() {
            if piece.token.kind == TokenKind::LineComment && index > 0 {
                out.comment = Some(piece.text.to_owned());
            } else {
                out.text.extend(std::iter::repeat_n(' ', before_last(&line[..=index])));
                out.text.push_str(piece.text);
            }
            match piece.token.kind {
                TokenKind::Open => self.open.push(OpenBracket { line: indent }),
                TokenKind::Close => drop(self.open.pop()),
                _ => {}
            }
            if !piece.is_comment() {
                self.before = Some(*piece);
            }
            self.opened = piece.opens();
        }
        self.lines.push(out);
    }

    /// Returns the indentation of a line.
    fn indent(&self, line: &[Piece], rest: &[Piece]) -> usize {
        let first = line[0];
        // Commented-out code, and comments that point at columns of the line above, stay at the margin.
        if first.token.kind == TokenKind::LineComment && first.margin {
            return 0;
        }
        if first.closes() {
            return self.open.last().map_or(0, |open| open.line);
        }
        let base = self.open.last().map_or(0, |open| open.line + STEP);
        // A comment is indented as the code it is about: what comes next.
        let told = line.iter().chain(rest).find(|p| !p.is_comment() && p.token.kind != TokenKind::LineBreak);
        match told {
            Some(told) if self.goes_on(told) => base + STEP,
            _ => base,
        }
    }

    /// Returns true if a line with this first token continues the one before.
    fn goes_on(&self, first: &Piece) -> bool {
        let Some(before) = self.before else { return false };
        let anew = first.closes() || first.begins || first.role == Some(Role::Each);
        let otherwise = first.text == "else" && before.text == "}";
        !(anew || otherwise || before.opens() || before.text == ",")
    }

    /// Adds unreadable lines, without the white space around them; blank lines at their beginning become one, or none at
    /// the beginning of the file.
    fn as_it_is(&mut self, text: &str) {
        let blanks = text.len() - text.trim_end().len();
        let first = text.len() - text.trim_start().len();
        let begin = text[..first].rfind('\n').map_or(0, |at| at + 1);
        if begin > 0 && !self.lines.is_empty() {
            self.lines.push(Line::blank());
        }
        for line in text[begin..].trim_end().split('\n') {
            self.lines.push(Line { indent: 0, text: line.trim_end_matches('\r').to_owned(), comment: None });
        }
        if text[text.len() - blanks..].matches('\n').count() > 1 {
            self.lines.push(Line::blank());
        }
    }
}
