//! The language server, asked over the wire as an editor does.

mod answers;
pub mod client;
mod diagnostics;
mod edits;
mod grammars;
mod hints;
mod verdicts;
