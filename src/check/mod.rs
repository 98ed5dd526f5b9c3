//! Tree to typed tree: names, imports, types and units.
//!
//! The room knows no robots. Faults that depend on values (an occupied port, a joint out of range) are found
//! later, when `elaborate` works the declarations out.
//!
//! Reading order: `load` reads files, `checker` holds the state, `scope` the locals, `items` drives; `members`,
//! `module`, `config` and `families` check declarations, `expr`, `literals`, `names`,
//! `lists`, `call`, `bindings`, `records` and `operators` expressions, `type_expr` types as written.

mod bindings;
mod call;
mod checker;
mod config;
mod contracts;
mod describe;
mod expr;
mod families;
pub mod family;
mod fields;
mod hints;
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
mod records;
mod reserve;
mod scene;
mod scope;
mod study;
pub(crate) mod summary;
mod type_expr;
mod type_params;
pub mod typed;
mod typed_expr;
mod typed_module;
mod typed_study;
mod types;

use crate::interrupt;
use crate::source::{Diagnostic, FileId, Files, Sources, Span, Symbol};
use typed::DefId;

pub use load::{Entry, IMPORT_DEPTH_MAX, why_unreadable};
pub use meaning::Meaning;
pub use typed::Program;
pub use types::{Choice, Type};

/// The result of checking a file with all that it imports: the typed program and the diagnostics.
#[derive(Clone, Debug)]
pub struct Checked {
    /// All texts that were read, by file.
    pub sources: Sources,
    /// The typed program; mistakes are error nodes in it.
    pub program: Program,
    /// The diagnostics, in the order in which they were found, not of position.
    pub diagnostics: Vec<Diagnostic>,
    /// The spans at which declarations are named, each with the declaration, in no order.
    pub uses: Vec<(Span, DefId)>,
    /// The names of `let`s that state no type, each with the type of its value, in no order.
    pub lets: Vec<(Span, Type)>,
    /// The texts that are entries of a session, oldest first; empty for a file.
    pub entries: Vec<FileId>,
    /// The names visible at the top of the file that is run with their meanings, the prelude's included, sorted
    /// by name.
    pub names: Vec<(Symbol, Meaning)>,
}

impl Checked {
    /// Returns true if any diagnostic is an error.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.is_error())
    }
}

/// Checks the file `root` with all that it imports, both read from `files`, and returns the typed program with the
/// diagnostics. Never fails: the program holds as much as could be understood, with error nodes and diagnostics for
/// the rest; a file that can't be read is a diagnostic.
pub fn check(files: &dyn Files, root: &str) -> Checked {
    check_loaded(load::load(files, root))
}

/// Checks the entries of a session with all that they import. All entries have one scope, in which a later
/// declaration replaces an earlier one of its name, for the earlier entries too. The statements are those of the
/// newest entry; there are none without entries. An entry never changes the identities of the declarations before it.
/// `files` gives access to what they import; `entries`: the entries from the oldest to the newest.
pub fn check_session(files: &dyn Files, entries: &[Entry]) -> Checked {
    check_loaded(load::load_session(files, entries))
}

fn check_loaded((loaded, sources, diagnostics): (load::Loaded, Sources, Vec<Diagnostic>)) -> Checked {
    let mut checker = checker::Checker::new(&loaded, &sources, diagnostics);
    checker.declare();
    for index in 0..checker.defs.len() {
        interrupt::checkpoint();
        checker.check_def(typed::DefId(index as u32));
    }
    // The names used in statements of earlier entries; their mistakes have been reported.
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
    let lets = std::mem::take(&mut checker.lets);
    let (program, diagnostics) = checker.finish(statements, tests);
    let entries = loaded.files.iter().filter(|file| file.entry).map(|file| file.ast.id).collect();
    Checked { sources, program, diagnostics, uses, lets, entries, names }
}
