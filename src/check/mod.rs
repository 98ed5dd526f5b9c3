//! Tree to typed tree: names, imports, types and units.
//!
//! Knows no robots. What depends on values (which port is taken, which joint is out of range) is
//! found later, when `interpret` elaborates the declarations.

pub mod typed;
pub mod types;

use crate::source::{Diagnostic, Sources};

pub use typed::Program;
pub use types::Type;

/// What checking a file and everything it imports ends with.
#[derive(Clone, Debug)]
pub struct Checked {
    pub sources: Sources,
    pub program: Program,
    pub diagnostics: Vec<Diagnostic>,
}
