//! Diagnostics as text for people: sorted, without duplicates, drawn by miette.

use super::excerpt::{Excerpt, LABEL_ROOM, excerpt, visible};
use super::{Diagnostic, Severity, Sources};
use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents, SourceCode,
    SourceSpan, SpanContents,
};
use std::fmt;

/// The style in which diagnostics are drawn.
#[derive(Clone, Debug)]
pub struct Style {
    /// The width of the terminal in columns; one below [`WIDTH_MIN`] counts as that. Default 100.
    pub width: usize,
    /// True if the text is coloured by escape sequences. Default false.
    pub color: bool,
    /// The project folder as the user would name it, put before the names of its files; may be empty, as by default.
    pub folder: String,
    /// The most diagnostics that [`render`] draws; the rest are counted. Default 50.
    pub shown_max: usize,
}

/// The least width in columns; in a narrower terminal snippets would show nothing.
pub const WIDTH_MIN: usize = 30;

impl Default for Style {
    fn default() -> Style {
        Style { width: 100, color: false, folder: String::new(), shown_max: 50 }
    }
}

impl Style {
    /// Returns the name of a file as the user would type it: with the project folder before it, unless it is one of
    /// the library, or a name in `<>` such as `<stdin>`, which is not a file.
    pub fn name(&self, name: &str, library: bool) -> String {
        match self.folder.as_str() {
            "" => name.to_owned(),
            _ if library || name.starts_with('<') => name.to_owned(),
            folder => format!("{}/{name}", folder.trim_end_matches('/')),
        }
    }
}

/// Returns the diagnostics without duplicates, by file and position of the primary label, at one span errors before
/// warnings; those without a label come last. Of equal diagnostics the first is kept.
pub fn sorted(diagnostics: &[Diagnostic]) -> Vec<&Diagnostic> {
    let mut sorted: Vec<&Diagnostic> = diagnostics.iter().collect();
    sorted.sort_by(|a, b| key(a).cmp(&key(b)));
    sorted.dedup();
    sorted
}

/// Returns the sort key of a diagnostic. One without a label comes last; texts are part of the key so that
/// equal diagnostics are adjacent.
fn key(d: &Diagnostic) -> impl Ord + '_ {
    let texts = d.labels.iter().map(|label| (label.span, label.text.as_str())).collect::<Vec<_>>();
    (d.span().is_none(), d.span(), d.severity, d.code, d.message.as_str(), texts, &d.hints)
}

/// Returns the diagnostics as text, [`sorted`] and without duplicates, up to `shown_max` of the style; each ends with
/// an empty line. Empty if there are none. `sources`: the texts that they point at. Panics if a label's text is not
/// among them.
pub fn render(sources: &Sources, diagnostics: &[Diagnostic], style: &Style) -> String {
    let sorted = sorted(diagnostics);
    let mut out = String::new();
    for diagnostic in sorted.iter().take(style.shown_max) {
        out.push_str(&render_one(sources, diagnostic, style));
        out.push('\n');
    }
    if let Some(hidden) = sorted.len().checked_sub(style.shown_max + 1) {
        out.push_str(&format!("... and {} more; `--json` lists them all\n\n", hidden + 1));
    }
    out
}

/// Returns one diagnostic as text that ends with a line end: code, message, a snippet for each label, hints. Characters
/// that control a terminal are replaced. `sources`: the texts that it points at; `style`: width, colour and names of
/// files. Panics if a label's text is not among them.
pub fn render_one(sources: &Sources, diagnostic: &Diagnostic, style: &Style) -> String {
    let width = style.width.max(WIDTH_MIN);
    let gutter = gutter_width(sources, diagnostic);
    let excerpt = excerpt(sources, &diagnostic.labels, width - gutter);
    let names = excerpt.blocks.iter().map(|block| {
        let file = sources.file(block.file);
        shown(&style.name(&file.name, file.library))
    });
    let report = Report { diagnostic, names: names.collect(), excerpt, label_width: width - gutter };
    let theme = if style.color { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let mut out = String::new();
    GraphicalReportHandler::new_themed(theme)
        .with_width(width)
        .with_links(false)
        .without_syntax_highlighting()
        .render_report(&mut out, &report)
        .expect("every label lies in a block of its excerpt, and writing to a String cannot fail");
    let lines: Vec<&str> = out.lines().map(str::trim_end).collect();
    lines.join("\n") + "\n"
}

/// Returns the columns to the left of a snippet's text: line number, frame, and arrows of labels over
/// lines.
fn gutter_width(sources: &Sources, diagnostic: &Diagnostic) -> usize {
    let line =
        |offset: u32, label: &super::Label| sources.file(label.span.file).line_column(offset as usize).line;
    let last = diagnostic.labels.iter().map(|label| line(label.span.end, label) + 1).max().unwrap_or(1);
    let over_lines = diagnostic
        .labels
        .iter()
        .filter(|label| line(label.span.start, label) != line(label.span.end, label))
        .count();
    let arrows = if over_lines > 0 { 3 + over_lines } else { 0 };
    last.to_string().len() + 4 + arrows
}

/// A diagnostic in the form that miette draws.
#[derive(Debug)]
struct Report<'a> {
    diagnostic: &'a Diagnostic,
    excerpt: Excerpt,
    /// The names of the files, one for each block of the excerpt.
    names: Vec<String>,
    label_width: usize,
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shown(&self.diagnostic.message))
    }
}

impl std::error::Error for Report<'_> {}

impl miette::Diagnostic for Report<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.diagnostic.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let hints: Vec<String> = self.diagnostic.hints.iter().map(|hint| shown(hint)).collect();
        if hints.is_empty() { None } else { Some(Box::new(hints.join("\n"))) }
    }

    /// Returns the command that shows the code's page, in place of a link.
    fn url<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(format!("modl explain {}", self.diagnostic.code)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let labels = self.diagnostic.labels.iter().zip(&self.excerpt.marks).enumerate();
        Some(Box::new(labels.map(|(i, (label, mark))| {
            // Four columns are for the corner that leads to the label's text.
            let width = self.label_width.saturating_sub(mark.indent).max(LABEL_ROOM) - 4;
            let text = (!label.text.is_empty()).then(|| wrapped(&shown(&label.text), width));
            let span = SourceSpan::new(mark.range.start.into(), mark.range.len());
            if i == 0 {
                LabeledSpan::new_primary_with_span(text, span)
            } else {
                LabeledSpan::new_with_span(text, span)
            }
        })))
    }
}

impl SourceCode for Report<'_> {
    /// Returns the whole block that contains a span: a block contains exactly what is shown, and blocks are
    /// never joined. Without context miette asks for a label's position in its file.
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        _lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let (start, end) = (span.offset(), span.offset() + span.len());
        let mut found = self.excerpt.blocks.iter().zip(&self.names);
        let (block, name) = found
            .find(|(block, _)| block.range.start <= start && end <= block.range.end)
            .ok_or(MietteError::OutOfBounds)?;
        let mark = self.excerpt.marks.iter().find(|mark| mark.range.start == start);
        let position = mark.map(|mark| mark.position).filter(|_| lines_before == 0);
        let data = self.excerpt.text[block.range.clone()].as_bytes();
        Ok(Box::new(MietteSpanContents::new_named(
            name.clone(),
            data,
            SourceSpan::new(block.range.start.into(), data.len()),
            position.map_or(block.first_line, |p| p.line) - 1,
            position.map_or(0, |p| p.column - 1),
            block.line_count,
        )))
    }
}

/// Returns text that may quote the program, without characters that control a terminal.
fn shown(text: &str) -> String {
    text.chars().map(|c| if c == '\n' { c } else { visible(c) }).collect()
}

/// Breaks text at blanks so that no line is longer than `width` characters, as far as words allow.
fn wrapped(text: &str, width: usize) -> String {
    let mut out = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > width {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += length;
    }
    out
}
