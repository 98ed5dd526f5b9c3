//! Text to tree. Parsing never fails: it returns a tree, the comments and diagnostics.

pub mod ast;
