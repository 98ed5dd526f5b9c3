//! Tree to typed tree: names, imports, types and units.
//!
//! Knows no robots. What depends on values (which port is taken, which joint is out of range) is
//! found later, when `interpret` elaborates the declarations.
//!
//! The way through this room: [`load`] reads files, [`checker`] holds what is known, [`items`]
//! drives; [`members`], [`module`], [`config`] and [`families`] are the declarations, [`expr`],
//! [`literals`], [`names`], [`lists`], [`call`] and [`operators`] the expressions, [`type_expr`] the types as written.

mod call;
mod checker;
mod config;
mod describe;
mod expr;
mod families;
mod items;
mod lint;
mod lists;
mod literals;
mod load;
mod members;
mod module;
mod names;
mod operators;
mod type_expr;
pub mod typed;
mod typed_expr;
pub mod types;

use crate::source::{Diagnostic, Files, Sources};

pub use typed::Program;
pub use types::Type;

/// What checking a file and everything it imports ends with.
#[derive(Clone, Debug)]
pub struct Checked {
    pub sources: Sources,
    pub program: Program,
    pub diagnostics: Vec<Diagnostic>,
}

impl Checked {
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.is_error())
    }
}

/// Checks the file `root` with all that it imports. The program holds what could be understood;
/// where something could not, there is an error node and a diagnostic.
pub fn check(files: &dyn Files, root: &str) -> Checked {
    let (loaded, sources, diagnostics) = load::load(files, root);
    let mut checker = checker::Checker::new(&loaded, &sources, diagnostics);
    checker.declare();
    for index in 0..checker.defs.len() {
        checker.check_def(typed::DefId(index as u32));
    }
    let (statements, tests) = match loaded.root {
        Some(root) => checker.check_root(root),
        None => Default::default(),
    };
    let (program, diagnostics) = checker.finish(statements, tests);
    Checked { sources, program, diagnostics }
}
