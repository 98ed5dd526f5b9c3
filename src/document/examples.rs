//! Examples in documentation comments: programs between ` ```modl ` and ` ``` `.

use crate::source::FileId;
use crate::syntax::{self, ast};

/// An example of a documentation comment as a text with the same lines and columns as in its file: blanks replace the
/// marks of the comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Example {
    /// The text of the example program.
    pub text: String,
    /// The line of the file at which the example begins, from 1.
    pub first_line: usize,
    /// True if the example is only checked and not run: ` ```modl check `.
    pub only_checked: bool,
}

/// Returns the examples in the documentation comments of a program, in the order of the text; one whose end is missing
/// ends with its comment.
pub(crate) fn examples(text: &str) -> Vec<Example> {
    let parsed = syntax::parse(FileId(0), text);
    let docs = parsed.file.comments.iter().filter(|c| is_doc(c.kind)).map(|c| c.span.start as usize);
    let mut found: Vec<Example> = Vec::new();
    let mut open = false;
    let mut before = 0;
    for start in docs {
        let line = text[..start].matches('\n').count() + 1;
        // A fence ends at anything between its lines.
        open &= line == before + 1;
        before = line;
        let whole = text.lines().nth(line - 1).unwrap_or("");
        let indent = start - text[..start].rfind('\n').map_or(0, |at| at + 1);
        let content = whole.get(indent + MARK..).unwrap_or("");
        match content.trim().strip_prefix("```") {
            Some(tag) if !open => {
                let mut words = tag.split_whitespace();
                if words.next() != Some("modl") {
                    // Another language is skipped to its end.
                    continue;
                }
                let only_checked = words.next() == Some("check");
                found.push(Example { text: String::new(), first_line: line + 1, only_checked });
                open = true;
            }
            Some(_) => open = false,
            None if open => {
                let example = found.last_mut().expect("a fence was opened");
                example.text.push_str(&format!("{:width$}{content}\n", "", width = indent + MARK));
            }
            None => {}
        }
    }
    found
}

/// The length of `///` and `//!` in bytes.
const MARK: usize = 3;

/// Returns true if a comment is documentation.
fn is_doc(kind: ast::CommentKind) -> bool {
    matches!(kind, ast::CommentKind::ItemDoc | ast::CommentKind::FileDoc)
}
