//! Texts, positions in them, and what is wrong with them.
//!
//! The lowest room of the left wing: it knows no grammar and no robots.

pub mod code;
pub mod diagnostic;
pub mod excerpt;
pub mod files;
pub mod foreign;
pub mod json;
pub mod library;
pub mod render;
pub mod span;
pub mod suggest;
pub mod symbol;
pub mod text;

pub use code::Code;
pub use diagnostic::{Diagnostic, Label, Severity};
pub use files::{Files, ReadError};
pub use span::{FileId, Span};
pub use symbol::Symbol;
pub use text::{LineColumn, SourceFile, Sources};
