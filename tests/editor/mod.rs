//! The language server, asked over the wire as an editor does.

mod answers;
mod client;
mod diagnostics;
mod edits;
mod grammars;
