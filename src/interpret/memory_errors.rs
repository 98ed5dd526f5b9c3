//! The errors of too little memory.

use crate::interrupt::memory;
use crate::source::{Diagnostic, code};

/// Returns the error of a system that gives no memory for the evaluator.
pub(super) fn no_memory(why: &str) -> Diagnostic {
    let message = format!("the system gives no memory to evaluate the program: {why}");
    Diagnostic::error(code::NO_MEMORY, message).hint("end other programs, or raise the limit of this one")
}

/// Returns the error of work that ended because it takes more memory than the limit.
pub fn memory_limit() -> Diagnostic {
    let message = format!("the program takes more memory than {}", memory_shown(memory::limit()));
    Diagnostic::error(code::MEMORY_LIMIT, message).hint("`--max-memory` raises the limit")
}

/// Returns a number of bytes as text, in the unit in which it is not less than one.
fn memory_shown(bytes: usize) -> String {
    let (size, unit) = match bytes {
        0..1_000_000 => (bytes as f64 / 1e3, "kB"),
        1_000_000..1_000_000_000 => (bytes as f64 / 1e6, "MB"),
        _ => (bytes as f64 / 1e9, "GB"),
    };
    format!("{} {unit}", (size * 10.0).round() / 10.0)
}
