//! Texts, positions in them, and diagnostics about them.
//!
//! The lowest room of the front end (the language): it knows no grammar and no robots.

pub mod code;
mod diagnostic;
pub(crate) mod escape;
mod excerpt;
pub mod files;
pub(crate) mod foreign;
pub mod json;
pub mod library;
pub mod percent;
pub mod render;
mod span;
pub(crate) mod suggest;
mod symbol;
mod text;

pub use code::Code;
pub use diagnostic::{Diagnostic, Label, Severity};
pub use files::{Files, ReadError, Replaced};
pub use span::{FileId, Span};
pub use symbol::Symbol;
pub use text::{LineColumn, SourceFile, Sources, floor_char_boundary};
