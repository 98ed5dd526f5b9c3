//! From text to values: syntax, types, evaluation, formatting and messages.

pub mod check;
pub mod format;
pub mod forms;
pub mod interpret;
pub mod render;
pub mod syntax;
pub mod syntax_random;
