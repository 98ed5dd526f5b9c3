//! Alignment of comments after code, and the text of all lines.

use super::spacing::APART;

/// A formatted line: its indentation, its text, and the comment after it, whose column is not fixed yet.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Line {
    /// The indentation of the line in spaces.
    pub indent: usize,
    /// The text of the line without indentation. A text literal or comment in it may contain line breaks.
    pub text: String,
    /// The comment `// ...` after the text; `None` if there is none.
    pub comment: Option<String>,
}

impl Line {
    /// Returns an empty line, without text, comment and indentation.
    pub(super) fn blank() -> Line {
        Line::default()
    }

    fn is_blank(&self) -> bool {
        self.text.is_empty()
    }

    /// Returns the number of characters before the end of the text on its last line.
    fn width(&self) -> usize {
        match self.text.rsplit_once('\n') {
            Some((_, last)) => last.chars().count(),
            None => self.indent + self.text.chars().count(),
        }
    }
}

/// Returns the whole text of formatted lines, in order. Comments after adjacent lines are aligned; consecutive blank
/// lines become one, and blank lines at both ends are removed.
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
            while out.ends_with([' ', '\t', '\r']) {
                out.pop();
            }
            out.push('\n');
        }
    }
    out
}
