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
mod meaning;
mod members;
mod module;
mod names;
mod operators;
mod reserve;
pub(crate) mod summary;
mod type_expr;
pub mod typed;
mod typed_expr;
mod types;

use crate::source::{Diagnostic, FileId, Files, Sources, Span, Symbol};
use typed::DefId;

pub use load::{Entry, why_unreadable};
pub use meaning::Meaning;
pub use typed::Program;
pub use types::Type;

/// What checking a file and everything it imports ends with.
#[derive(Clone, Debug)]
pub struct Checked {
    pub sources: Sources,
    pub program: Program,
    pub diagnostics: Vec<Diagnostic>,
    /// Where declarations are named, in no order.
    pub uses: Vec<(Span, DefId)>,
    /// The texts that are entries of a session, in order.
    pub entries: Vec<FileId>,
    /// What the names at the top of the file that is run mean, those of the prelude included; by name.
    pub names: Vec<(Symbol, Meaning)>,
}

impl Checked {
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.is_error())
    }
}

/// Checks the file `root` with all that it imports. The program holds what could be understood;
/// where something could not, there is an error node and a diagnostic.
pub fn check(files: &dyn Files, root: &str) -> Checked {
    check_loaded(load::load(files, root))
}

/// Checks the entries of a session with all that they import. All entries have one scope, in which a
/// later declaration takes the place of an earlier one of its name, for the earlier entries too. The
/// statements are those of the newest entry. No entry changes the identity of what those before it
/// declare.
pub fn check_session(files: &dyn Files, entries: &[Entry]) -> Checked {
    check_loaded(load::load_session(files, entries))
}

fn check_loaded((loaded, sources, diagnostics): (load::Loaded, Sources, Vec<Diagnostic>)) -> Checked {
    let mut checker = checker::Checker::new(&loaded, &sources, diagnostics);
    checker.declare();
    for index in 0..checker.defs.len() {
        checker.check_def(typed::DefId(index as u32));
    }
    // What earlier entries of a session name in their statements; what was wrong with those was said.
    for file in (0..loaded.files.len()).filter(|file| loaded.files[*file].entry && loaded.root != Some(*file))
    {
        let known = checker.diagnostics.len();
        checker.check_root(file);
        checker.diagnostics.truncate(known);
    }
    let (statements, tests) = match loaded.root {
        Some(root) => checker.check_root(root),
        None => Default::default(),
    };
    let names = loaded.root.or(loaded.prelude).map_or_else(Vec::new, |root| checker.meanings(root));
    let uses = checker.uses.take();
    let (program, diagnostics) = checker.finish(statements, tests);
    let entries = loaded.files.iter().filter(|file| file.entry).map(|file| file.ast.id).collect();
    Checked { sources, program, diagnostics, uses, entries, names }
}
