//! Comments behind code, one below the other, and the text of all lines.

use super::spacing::APART;

/// A line that is laid out, but for the column of its last comment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Line {
    /// In spaces.
    pub indent: usize,
    /// Without indentation. May hold line breaks, in a text or comment.
    pub text: String,
    /// `// ...` behind the text.
    pub comment: Option<String>,
}

impl Line {
    pub(super) fn blank() -> Line {
        Line::default()
    }

    fn is_blank(&self) -> bool {
        self.text.is_empty()
    }

    /// Characters before the end of the text on its last line.
    fn width(&self) -> usize {
        match self.text.rsplit_once('\n') {
            Some((_, last)) => last.chars().count(),
            None => self.indent + self.text.chars().count(),
        }
    }
}

/// The text of lines. Comments behind adjacent lines begin in one column; two blank lines are one, and
/// none stands at either end.
pub(super) fn aligned(lines: Vec<Line>) -> String {
    let mut out = String::new();
    let mut blank = false;
    let same = |a: &Line, b: &Line| a.comment.is_some() == b.comment.is_some();
    for run in lines.chunk_by(same) {
        let column = run.iter().map(Line::width).max().unwrap_or(0) + APART;
        for line in run {
            if line.is_blank() {
                blank = !out.is_empty();
                continue;
            }
            if std::mem::take(&mut blank) {
                out.push('\n');
            }
            out.extend(std::iter::repeat_n(' ', line.indent));
            out.push_str(&line.text);
            if let Some(comment) = &line.comment {
                out.extend(std::iter::repeat_n(' ', column - line.width()));
                out.push_str(comment);
            }
            while out.ends_with([' ', '\t']) {
                out.pop();
            }
            out.push('\n');
        }
    }
    out
}
