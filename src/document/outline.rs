//! A checked program as pages: one for each file, with an entry for each of its declarations.

use crate::check::Checked;
use crate::check::summary::{self, Inside};
use crate::check::typed::{DefId, DefKind};
use crate::source::FileId;
use std::sync::Arc;

/// The page of the documentation site about one file.
pub(super) struct Page {
    /// The title of the page: `std.smores`, or the file's path.
    pub title: String,
    /// The name of the page's file in the site.
    pub file: String,
    /// The file's documentation, Markdown; `None` if it has none.
    pub doc: Option<String>,
    /// The entries of the page, one for each declaration, in the order of the text.
    pub entries: Vec<PageEntry>,
}

impl Page {
    /// Returns true for a file of the standard library; the titles of programs end in `.mod`.
    pub(super) fn is_of_library(&self) -> bool {
        !self.title.ends_with(".mod")
    }
}

/// The entry of a page about one declaration.
pub(super) struct PageEntry {
    /// The name of the declaration that the entry documents.
    pub name: String,
    /// The keyword of the declaration: `module`, `config`, `fn`.
    pub word: &'static str,
    /// The signature of the declaration, as text.
    pub signature: String,
    /// The documentation of the declaration, Markdown; `None` if it has none.
    pub doc: Option<Arc<str>>,
    /// The members of the declaration, in the order in which they are listed: group by group.
    pub inside: Vec<Inside>,
    /// True if the declaration has an instance without arguments.
    pub has_default: bool,
    /// The facts about the declaration's default instance, in words: order, modules, mass; empty until they are
    /// found, and without such an instance.
    pub facts: Vec<String>,
    /// The order of the declaration's default instance: 1 for modules alone, else one more than the greatest order of
    /// its parts. `None` if it is not a configuration or has none.
    pub order: Option<u32>,
    /// The name of the declaration's picture in the site; `None` if it has none.
    pub picture: Option<String>,
}

/// Returns the page about one file of a program, whose own documentation is `doc` (Markdown); `None` for a file without
/// public declarations.
pub(super) fn page(checked: &Checked, file: FileId, doc: Option<String>) -> Option<Page> {
    let source = checked.sources.file(file);
    let stem = source.name.trim_end_matches(".mod");
    let title = match stem.strip_prefix("std/") {
        Some("prelude") => "prelude".to_owned(),
        Some(name) if source.library => format!("std.{}", name.replace('/', ".")),
        _ => source.name.to_string(),
    };
    let methods = methods(checked);
    let here = checked
        .program
        .identified()
        .filter(|(id, def)| def.file == file && !def.name.as_str().starts_with('_') && !methods.contains(id));
    let entries: Vec<PageEntry> = here.map(|(id, _)| entry(checked, id)).collect();
    let file = format!("{}.html", title.replace(['/', '.'], "-"));
    (!entries.is_empty()).then_some(Page { title, file, doc, entries })
}

/// Returns the methods of all records, which are listed with their records.
fn methods(checked: &Checked) -> Vec<DefId> {
    let records = checked.program.defs.iter().filter_map(|def| match &def.kind {
        DefKind::Record(record) => Some(&record.methods),
        _ => None,
    });
    records.flatten().copied().collect()
}

/// Returns the entry of a declaration.
fn entry(checked: &Checked, id: DefId) -> PageEntry {
    let def = checked.program.def(id);
    let params = summary::params_of(&checked.program, id);
    let instances =
        matches!(def.kind, DefKind::Module(_) | DefKind::Config(_) | DefKind::Lattice(_) | DefKind::Truss(_));
    PageEntry {
        name: def.name.to_string(),
        word: summary::word(&def.kind),
        signature: summary::signature(checked, id),
        doc: def.doc.clone(),
        inside: summary::inside(checked, def),
        has_default: instances && params.iter().all(|p| p.default.is_some()),
        facts: Vec::new(),
        order: None,
        picture: None,
    }
}
