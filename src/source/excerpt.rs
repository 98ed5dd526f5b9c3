//! Excerpts: the lines of texts that a diagnostic shows, with one line before and after each label. Long
//! lines are shortened around the label, and characters that control a terminal are replaced.
//!
//! An [`Excerpt`] is a small text of its own, made of blocks from one or several files, so the cost of
//! drawing does not depend on the position in a large file.

use super::{FileId, Label, LineColumn, Sources, floor_char_boundary};
use std::ops::Range;

/// The number of lines shown before the first and after the last labelled line of a block.
const CONTEXT: usize = 1;

/// A label over more lines than this is drawn on its first line only.
const LABEL_LINES_MAX: usize = 6;

/// The columns between two tab stops.
const TAB: usize = 4;

/// The least number of columns that a label's text gets to the right of the middle of its mark; with fewer, its line is
/// shown shifted.
pub(super) const LABEL_ROOM: usize = 14;

/// The mark for text that is cut off.
const CUT: &str = "…";

/// A block of consecutive lines of one file.
#[derive(Debug)]
pub(super) struct Block {
    /// The file that the block is taken from.
    pub file: FileId,
    /// The number, from 1, of the first line of the block in its file.
    pub first_line: usize,
    /// The number of lines in the block.
    pub line_count: usize,
    /// The range of bytes that the block takes in [`Excerpt::text`].
    pub range: Range<usize>,
}

/// The position of a label's mark in an excerpt.
#[derive(Debug)]
pub(super) struct Mark {
    /// The range of bytes that the label takes in [`Excerpt::text`]; never empty, never past the last visible
    /// character.
    pub range: Range<usize>,
    /// The line and column at which the label begins in its file, both from 1.
    pub position: LineColumn,
    /// The number of columns of its line to the left of the mark's middle.
    pub indent: usize,
}

/// The lines of source text around the labels of a diagnostic, with the marks of the labels.
#[derive(Debug, Default)]
pub(super) struct Excerpt {
    /// The text of all blocks, one after the other.
    pub text: String,
    /// The blocks of lines: those of the first label's file first, and within a file by line.
    pub blocks: Vec<Block>,
    /// The marks, one for each label of the diagnostic, in the labels' order.
    pub marks: Vec<Mark>,
}

/// The lines of a label in its file, and its first and last byte within those lines.
#[derive(Clone, Copy)]
struct LabelPlace {
    file: FileId,
    first: usize,
    last: usize,
    start: usize,
    end: usize,
}

/// Returns the lines of source text that show all `labels`, none wider than `columns` columns, which must be at least
/// 8.
pub(super) fn excerpt(sources: &Sources, labels: &[Label], columns: usize) -> Excerpt {
    let places: Vec<LabelPlace> = labels.iter().map(|label| place(sources, label)).collect();
    let mut excerpt = Excerpt::default();
    let mut starts = vec![0; places.len()];
    let mut ends = vec![0; places.len()];
    for (file, lines) in blocks(sources, &places) {
        let begin = excerpt.text.len();
        for line in lines.clone() {
            let text = sources.file(file).line(line);
            let on_line = places.iter().find(|p| p.file == file && (p.first == line || p.last == line));
            let focus = on_line.map_or(0..0, |p| {
                let start = if p.first == line { p.start } else { 0 };
                start..if p.last == line { p.end } else { text.len() }
            });
            let cut = cut_line(text, focus, columns);
            let base = excerpt.text.len();
            for (i, place) in places.iter().enumerate().filter(|(_, p)| p.file == file) {
                if place.first == line {
                    starts[i] = base + cut.byte(place.start);
                }
                if place.last == line {
                    ends[i] = base + cut.byte(place.end);
                }
            }
            excerpt.text.push_str(&cut.text);
            excerpt.text.push('\n');
        }
        excerpt.blocks.push(Block {
            file,
            first_line: lines.start,
            line_count: lines.len(),
            range: begin..excerpt.text.len(),
        });
    }
    let shown = places.iter().zip(starts.into_iter().zip(ends));
    excerpt.marks = shown
        .map(|(&place, (start, end))| mark(sources, &excerpt.text, place, start..end, columns))
        .collect();
    excerpt
}

/// Returns the mark of a label shown at the bytes `shown` of the excerpt.
fn mark(sources: &Sources, text: &str, place: LabelPlace, shown: Range<usize>, columns: usize) -> Mark {
    let Range { start, end } = shown;
    let before = &text[text[..start].rfind('\n').map_or(0, |i| i + 1)..start];
    let before: usize = before.chars().map(columns_of).sum();
    let next = text[start..].chars().next().map_or(0, char::len_utf8);
    let marked = text[start..end.max(start + next)].lines().next().unwrap_or("");
    // On a narrow terminal the label's text matters more than the length of the line above it.
    let room = (2 * columns.saturating_sub(LABEL_ROOM + before)).max(1);
    let one_line = place.first == place.last;
    let drawn = if one_line { marked.chars().take(room).map(char::len_utf8).sum() } else { end - start };
    let first = sources.file(place.file).line(place.first);
    let column = first[..floor_char_boundary(first, place.start)].chars().count() + 1;
    Mark {
        range: start..start + drawn,
        position: LineColumn { line: place.first, column },
        indent: before + marked.chars().take(room).map(columns_of).sum::<usize>() / 2,
    }
}

/// Returns the position of a label, moved to visible characters.
fn place(sources: &Sources, label: &Label) -> LabelPlace {
    let file = sources.file(label.span.file);
    let range = visible_range(&file.text, label.span.start as usize, label.span.end as usize);
    let first = file.line_column(range.start).line;
    let last = file.line_column(range.end).line;
    let start = range.start - file.line_start(first);
    if last >= first + LABEL_LINES_MAX {
        let end = file.line(first).trim_end().len();
        return LabelPlace { file: label.span.file, first, last: first, start, end };
    }
    LabelPlace { file: label.span.file, first, last, start, end: range.end - file.line_start(last) }
}

/// Returns the range without the blanks at its end. An empty range is moved to the character after it, or,
/// if that is blank, to the last visible one before it on its line; on a blank line it stays empty.
fn visible_range(text: &str, start: usize, end: usize) -> Range<usize> {
    let start = floor_char_boundary(text, start);
    let end = start + text[start..floor_char_boundary(text, end).max(start)].trim_end().len();
    if start < end {
        return start..end;
    }
    let next = text[start..].chars().next();
    if let Some(c) = next.filter(|c| !c.is_whitespace()) {
        return start..start + c.len_utf8();
    }
    let at_end = text[start..].trim().is_empty();
    let from = if at_end { 0 } else { text[..start].rfind('\n').map_or(0, |i| i + 1) };
    let before = text[from..start].trim_end();
    match before.chars().next_back() {
        Some(c) => from + before.len() - c.len_utf8()..from + before.len(),
        None => start..start,
    }
}

/// Returns the runs of lines to show: those of the first label's file first, then other files in order; in
/// a file by line.
fn blocks(sources: &Sources, places: &[LabelPlace]) -> Vec<(FileId, Range<usize>)> {
    let mut ordered: Vec<LabelPlace> = places.to_vec();
    let first = places.first().map(|p| p.file);
    ordered.sort_by_key(|p| (Some(p.file) != first, p.file, p.first));
    let mut blocks: Vec<(FileId, Range<usize>)> = Vec::new();
    for place in ordered {
        let file = sources.file(place.file);
        // Nothing can be shown after the last line end.
        let last = file.last_line() - usize::from(file.last_line() > place.last && file.text.ends_with('\n'));
        let lines =
            place.first.saturating_sub(CONTEXT).max(file.first_line)..(place.last + CONTEXT).min(last) + 1;
        match blocks.last_mut() {
            Some((file, before)) if *file == place.file && lines.start <= before.end + 1 => {
                before.end = before.end.max(lines.end);
            }
            _ => blocks.push((place.file, lines)),
        }
    }
    blocks
}

/// A shortened line, with the mapping from bytes of the file's line.
struct CutLine {
    text: String,
    /// Pairs of a byte in the file's line and a byte in `text`, ascending; the last pair is the end.
    bytes: Vec<(usize, usize)>,
}

impl CutLine {
    /// Returns the byte in `text` of the character at `byte` of the file's line, or of the nearest one
    /// shown.
    fn byte(&self, byte: usize) -> usize {
        let after = self.bytes.partition_point(|&(from, _)| from < byte);
        self.bytes.get(after).or(self.bytes.last()).map_or(0, |&(_, to)| to)
    }
}

/// Returns a line shortened to `columns` so that `focus` is visible.
fn cut_line(line: &str, focus: Range<usize>, columns: usize) -> CutLine {
    let columns = columns.max(8);
    let from = window_start(line, focus, columns);
    let mut cut = CutLine { text: String::new(), bytes: Vec::new() };
    let mut column = 0;
    if from > 0 {
        cut.text.push_str(CUT);
        column = 1;
    }
    for (i, c) in line[from..].char_indices() {
        let width = if c == '\t' { TAB - column % TAB } else { columns_of(c) };
        let rest_fits =
            || line[from + i..].chars().map(columns_of).take(columns + 1).sum::<usize>() + column <= columns;
        if column + width >= columns && !rest_fits() {
            cut.bytes.push((from + i, cut.text.len()));
            cut.text.push_str(CUT);
            return cut;
        }
        cut.bytes.push((from + i, cut.text.len()));
        if c == '\t' {
            cut.text.extend(std::iter::repeat_n(' ', width));
        } else {
            cut.text.push(visible(c));
        }
        column += width;
    }
    cut.bytes.push((line.len(), cut.text.len()));
    if cut.text.is_empty() {
        // An empty line must have room for a mark.
        cut.text.push(' ');
    }
    cut
}

/// Returns the byte at which a shown line begins, so that `focus` is visible with some text before it and
/// room for the label's text below it.
fn window_start(line: &str, focus: Range<usize>, columns: usize) -> usize {
    let start = floor_char_boundary(line, focus.start);
    let count = |text: &str| text.chars().take(columns).map(columns_of).sum::<usize>();
    let before = line[..start].chars().map(columns_of).sum::<usize>();
    let middle =
        before + count(&line[start..floor_char_boundary(line, focus.end).max(start)]).min(columns) / 2;
    if before + count(&line[start..]) <= columns && middle + LABEL_ROOM <= columns || before <= columns / 3 {
        return 0;
    }
    let mut kept = 0;
    let shown = line[..start].char_indices().rev().take_while(|(_, c)| {
        kept += columns_of(*c);
        kept <= columns / 3
    });
    shown.last().map_or(start, |(i, _)| i)
}

/// Returns the columns that a character occupies; East Asian wide characters occupy two.
fn columns_of(c: char) -> usize {
    match c {
        '\t' => TAB,
        '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}' => 2,
        '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}' => 2,
        '\u{1f300}'..='\u{1faff}' | '\u{20000}'..='\u{3fffd}' => 2,
        _ => 1,
    }
}

/// Returns the character that a terminal shows in place of `c`: control characters become Unicode control pictures,
/// those that change the order of reading the replacement character; others stay.
pub(super) fn visible(c: char) -> char {
    match c {
        '\0'..='\u{1f}' => char::from_u32(0x2400 + c as u32).expect("control pictures follow the controls"),
        '\u{7f}' => '\u{2421}',
        '\u{80}'..='\u{9f}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' => {
            char::REPLACEMENT_CHARACTER
        }
        '\u{2028}'..='\u{2029}' | '\u{2060}'..='\u{2069}' | '\u{feff}' => char::REPLACEMENT_CHARACTER,
        _ => c,
    }
}
