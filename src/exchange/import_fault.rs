//! Mistakes in files of other programs, with their places.

use roxmltree::{Document, Node};
use std::fmt;

/// The reason why a file can't be taken in.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportFault {
    /// The mistake.
    pub message: String,
    /// The line in the file, from 1; 0 where there is none.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
}

impl ImportFault {
    /// Returns a fault of a file as a whole.
    pub(super) fn of_file(message: impl Into<String>) -> ImportFault {
        ImportFault { message: message.into(), line: 0, column: 0 }
    }

    /// Returns a fault at a node of an XML file.
    pub(super) fn at_node(node: Node, message: impl Into<String>) -> ImportFault {
        let at = node.document().text_pos_at(node.range().start);
        ImportFault { message: message.into(), line: at.row as usize, column: at.col as usize }
    }
}

impl fmt::Display for ImportFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ImportFault {}

/// Returns the document of the text of an XML file, which may begin with a byte order mark.
///
/// # Errors
/// The [`ImportFault`] of a text that is no XML.
pub(super) fn document(text: &str) -> Result<Document<'_>, ImportFault> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    Document::parse(text).map_err(|e| {
        let at = e.pos();
        ImportFault { message: format!("it is no XML: {e}"), line: at.row as usize, column: at.col as usize }
    })
}
