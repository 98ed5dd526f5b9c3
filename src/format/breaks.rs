//! Line breaks within a line that is too wide.

use super::spacing::{Piece, before_last};
use crate::syntax::{Role, TokenKind};

/// The greatest width of a line in columns, without a comment after its code. A wider line is broken.
pub(super) const WIDTH: usize = 120;

/// The most tokens of a line that is broken: each break looks at all of them.
const TOKENS_MAX: usize = 5000;

/// The least width of what stands between two brackets that a line is broken at.
const CONTENT_MIN: usize = 12;

/// The greatest width of an element of which several stand on a line.
const SHORT: usize = 12;

/// The classes of binary operators after which a line is broken, loosest first.
const OPERATORS: &[&[&str]] =
    &[&["or"], &["and"], &["==", "!=", "<", "<=", ">", ">="], &["++"], &["+", "-"], &["*", "/", "%"]];

/// Returns the indices in `line`, from 0, of the pieces with which new lines begin, in order, where a line with this
/// indentation (in columns) is too wide; empty if it is not, or if nothing of it can go to another line. The lines
/// that come of it may be too wide themselves, and are then broken again.
pub(super) fn breaks(line: &[Piece], indent: usize) -> Vec<usize> {
    let behind = line.iter().rposition(|piece| piece.token.kind != TokenKind::LineComment);
    let Some(end) = behind.map(|last| last + 1) else { return Vec::new() };
    let several = line.iter().any(|piece| piece.text.contains('\n'));
    if end > TOKENS_MAX || several {
        return Vec::new();
    }
    let measured = Measured::of(&line[..end], indent);
    if measured.columns(0, end) <= WIDTH { Vec::new() } else { measured.breaks() }
}

/// A line with the column and the depth of brackets of each piece.
struct Measured<'l, 't> {
    line: &'l [Piece<'t>],
    /// The column after each piece.
    ends: Vec<usize>,
    /// The depth of each piece; that of a bracket is that of what is around it.
    depths: Vec<i32>,
    /// The index of the bracket that closes each one that is closed on the line.
    closers: Vec<Option<usize>>,
    indent: usize,
    /// The depth of what is in no bracket of the line.
    base: i32,
}

impl<'l, 't> Measured<'l, 't> {
    fn of(line: &'l [Piece<'t>], indent: usize) -> Measured<'l, 't> {
        let mut measured = Measured {
            line,
            ends: Vec::with_capacity(line.len()),
            depths: Vec::with_capacity(line.len()),
            closers: vec![None; line.len()],
            indent,
            base: 0,
        };
        let (mut column, mut depth) = (indent, 0);
        let mut open: Vec<usize> = Vec::new();
        for (i, piece) in line.iter().enumerate() {
            column += before_last(&line[..=i]) + piece.text.chars().count();
            measured.ends.push(column);
            let angle = piece.role == Some(Role::Angle);
            if piece.closes() || angle && piece.text == ">" {
                depth -= 1;
                if let Some(opener) = open.pop() {
                    measured.closers[opener] = Some(i);
                }
            }
            measured.depths.push(depth);
            if piece.opens() || angle && piece.text == "<" {
                depth += 1;
                open.push(i);
            }
        }
        measured.base = measured.depths.iter().copied().min().unwrap_or(0);
        measured
    }

    /// Returns the width from one piece up to, without, another; from the first one on with the indentation.
    fn columns(&self, from: usize, to: usize) -> usize {
        let end = to.checked_sub(1).map_or(self.indent, |last| self.ends[last]);
        match from {
            0 => end,
            from => end.saturating_sub(self.ends[from - 1]),
        }
    }

    /// Returns where this line, which is too wide, is broken.
    fn breaks(&self) -> Vec<usize> {
        let whole = 0..self.line.len();
        let base = [
            self.clauses(self.base, whole.clone()),
            self.elements(self.base, whole.clone()),
            self.opened(),
            self.blocks(),
        ];
        for at in base {
            if !at.is_empty() {
                return at;
            }
        }
        let operators = self.operators();
        match self.widest() {
            Some((open, close))
                if operators.is_empty() || 2 * self.columns(open, close) > self.columns(0, whole.end) =>
            {
                self.within(open, close)
            }
            _ => operators,
        }
    }

    /// Returns the place after the first bracket that is not closed on the line.
    fn opened(&self) -> Vec<usize> {
        let opened = |&i: &usize| {
            let breaks = self.line[i].text != "{" || self.in_braces(i);
            self.line[i].opens() && self.closers[i].is_none() && breaks
        };
        (0..self.line.len() - 1).find(opened).map(|i| i + 1).into_iter().collect()
    }

    /// Returns where a line is broken at the braces at the base that hold clauses, statements or a branch: at all of
    /// them, but where they are only fields that a record is changed in, at the widest.
    fn blocks(&self) -> Vec<usize> {
        let open = |&i: &usize| {
            self.line[i].text == "{"
                && self.depths[i] == self.base
                && self.line.get(i + 1).is_some_and(|p| p.begins)
        };
        let pairs = (0..self.line.len()).filter(open).filter_map(|open| Some((open, self.closers[open]?)));
        let mut pairs: Vec<(usize, usize)> = pairs.collect();
        let with = |&(open, _): &(usize, usize)| open > 0 && self.line[open - 1].text == "with";
        if pairs.iter().all(with) {
            let widest = pairs.iter().copied().max_by_key(|&(open, close)| self.columns(open + 1, close));
            pairs = widest.into_iter().collect();
        }
        pairs.into_iter().flat_map(|(open, close)| self.within(open, close)).collect()
    }

    /// Returns the clauses and statements of a range that begin at a depth, without its first piece.
    fn clauses(&self, depth: i32, range: std::ops::Range<usize>) -> Vec<usize> {
        let begins = |&i: &usize| i > range.start && self.depths[i] == depth && self.line[i].begins;
        range.clone().filter(begins).collect()
    }

    /// Returns where the elements of a range at a depth begin that stand after a comma, and `for` and `if` of a
    /// comprehension. Short elements stand side by side: of those only the first that does not fit.
    fn elements(&self, depth: i32, range: std::ops::Range<usize>) -> Vec<usize> {
        let begins = |&i: &usize| {
            let piece = &self.line[i];
            let behind = i > range.start && self.line[i - 1].text == "," && self.depths[i - 1] == depth;
            let each = i > range.start && piece.role == Some(Role::Each) && self.depths[i] == depth;
            !piece.closes() && (behind || each)
        };
        let all: Vec<usize> = range.clone().filter(begins).collect();
        let mut starts = vec![range.start];
        starts.extend(&all);
        let ends = all.iter().copied().chain([range.end]);
        let short = starts
            .iter()
            .zip(ends)
            .all(|(&from, to)| self.columns(from, to) <= SHORT + if from == 0 { self.indent } else { 0 });
        if !short || all.len() < 4 {
            return all;
        }
        // Within brackets they are first put on a line of their own; of a line, as many as fit stay.
        if depth != self.base {
            return Vec::new();
        }
        let fits = all.iter().rev().find(|&&i| self.columns(0, i) <= WIDTH);
        fits.or(all.first()).copied().into_iter().collect()
    }

    /// Returns the brackets at the base that enclose most, if that is enough to be broken.
    fn widest(&self) -> Option<(usize, usize)> {
        let pairs = (0..self.line.len()).filter_map(|open| Some((open, self.closers[open]?)));
        let fit = pairs.filter(|&(open, close)| {
            self.depths[open] == self.base
                && self.line[open].opens()
                && close > open + 1
                && (self.line[open].text != "{" || self.in_braces(open))
        });
        let widest = fit.max_by_key(|&(open, close)| self.columns(open + 1, close))?;
        (self.columns(widest.0 + 1, widest.1) >= CONTENT_MIN).then_some(widest)
    }

    /// Returns true if what braces hold may begin a line: clauses, statements, or names of an import.
    fn in_braces(&self, open: usize) -> bool {
        self.line[open + 1].begins || self.line[open].role == Some(Role::Names)
    }

    /// Returns where a line is broken at a pair of brackets: within them, or within the only pair that they hold.
    fn within(&self, open: usize, close: usize) -> Vec<usize> {
        let (mut open, mut close) = (open, close);
        while self.line[open].text != "{" && self.line[open + 1].opens() && self.line[open + 1].text != "{" {
            match self.closers[open + 1] {
                Some(inner) if inner + 1 == close && inner > open + 2 => (open, close) = (open + 1, inner),
                _ => break,
            }
        }
        let depth = self.depths[open] + 1;
        let inside = open + 1..close;
        let mut at = vec![open + 1];
        let inner = match self.clauses(depth, inside.clone()) {
            clauses if clauses.is_empty() => self.elements(depth, inside),
            clauses => clauses,
        };
        at.extend(inner);
        at.push(close);
        at
    }

    /// Returns the place after the last of the loosest operators at the base up to which the line fits.
    fn operators(&self) -> Vec<usize> {
        let of_class = |class: &[&str]| -> Vec<usize> {
            let here = (0..self.line.len().saturating_sub(1)).filter(|&i| {
                let piece = &self.line[i];
                i > 0 && self.depths[i] == self.base && piece.role.is_none() && class.contains(&piece.text)
            });
            here.map(|i| i + 1).collect()
        };
        let Some(places) = OPERATORS.iter().map(|class| of_class(class)).find(|places| !places.is_empty())
        else {
            return Vec::new();
        };
        let fits = places.iter().rev().find(|&&i| self.columns(0, i) <= WIDTH);
        fits.or(places.first()).copied().into_iter().collect()
    }
}
