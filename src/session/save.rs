//! The session as a program: the entries without the declarations that later entries replaced.

use super::dependencies::meant;
use super::state::{Session, loaded_path};
use crate::check::typed::DefId;
use crate::check::{Checked, Entry, check_session};
use crate::format::format;
use crate::source::{FileId, Symbol};
use crate::syntax::{self, ast};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The signs with which a statement may not begin right below another: it would seem to continue that.
const CONTINUING: [char; 4] = ['+', '-', '(', '['];

impl Session {
    /// Returns the entries of the session as the text of a program, formatted: imports first, then the entries without
    /// what later ones replaced, and without statements that are wrong by what their names mean since. `_`, the last value,
    /// is replaced by a name.
    pub fn program(&self) -> String {
        let checked = self.checked();
        let saved = Saved::of(checked);
        let mut imports = Vec::new();
        let mut pieces: Vec<String> = Vec::new();
        for (entry, file) in self.entries.iter().zip(&checked.entries) {
            let text = saved.entry(entry, *file, &mut imports);
            // A mark of the byte order may begin an entry, as it may begin a file, but not what stands within one.
            pieces.push(text.strip_prefix('\u{feff}').unwrap_or(&text).trim().to_owned());
        }
        pieces.retain(|piece| !piece.is_empty());
        self.leave_out_wrong(&imports, &mut pieces);
        pieces.retain(|piece| !piece.is_empty());
        let (text, _) = joined(&imports, &pieces);
        match format(FileId(0), &text) {
            Some(formatted) => formatted.text,
            None => text,
        }
    }

    /// Leaves out the statements that are wrong in the program of these pieces: a later entry gave another meaning to a name
    /// that they use.
    fn leave_out_wrong(&self, imports: &[String], pieces: &mut [String]) {
        let (text, ranges) = joined(imports, pieces);
        let whole = Entry { name: "<saved>".to_owned(), text, first_line: 1, value: None, last: None };
        let checked = check_session(&*self.files, &[whole]);
        let errors = checked.diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
        let at = errors.filter_map(|error| error.labels.first()).map(|label| label.span.start as usize);
        let mut places = vec![Vec::new(); pieces.len()];
        for at in at {
            if let Some(piece) = ranges.iter().position(|range| range.contains(&at)) {
                places[piece].push(at - ranges[piece].start);
            }
        }
        for (piece, places) in pieces.iter_mut().zip(places).filter(|(_, places)| !places.is_empty()) {
            let items = syntax::parse(FileId(0), piece).file.items;
            let statements = items.iter().filter(|item| matches!(item.kind, ast::ItemKind::Statement(_)));
            let wrong = statements.map(|item| item.span.range());
            let wrong = wrong.filter(|range| places.iter().any(|at| range.contains(at)));
            let edits = wrong.map(|range| (range, String::new())).collect();
            *piece = edited(piece, edits).trim().to_owned();
        }
    }
}

/// Returns a program of imports and pieces, with the range of each piece in it, in bytes.
fn joined(imports: &[String], pieces: &[String]) -> (String, Vec<Range<usize>>) {
    let mut text = imports.iter().map(|line| format!("{line}\n")).collect::<String>();
    let mut ranges = Vec::new();
    let mut before = imports.join("\n");
    for (i, piece) in pieces.iter().enumerate() {
        // Single lines are joined; longer pieces are separated by blank lines, and those that would seem to continue the
        // line before.
        let long = piece.contains('\n') || before.contains('\n');
        let apart = i == 0 || long || piece.starts_with(CONTINUING);
        text.push_str(if apart && !text.is_empty() { "\n" } else { "" });
        ranges.push(text.len()..text.len() + piece.len());
        text.push_str(&format!("{piece}\n"));
        before.clone_from(piece);
    }
    (text, ranges)
}

/// The program of a session, prepared for saving.
struct Saved<'c> {
    checked: &'c Checked,
    meant: BTreeMap<Symbol, DefId>,
    used: BTreeSet<DefId>,
}

/// A range of a text with its replacement.
type Edit = (Range<usize>, String);

impl<'c> Saved<'c> {
    fn of(checked: &'c Checked) -> Saved<'c> {
        let used = checked.uses.iter().map(|(_, id)| *id).collect();
        Saved { checked, meant: meant(checked), used }
    }

    /// Returns the remainder of an entry; its imports are added to `imports`.
    fn entry(&self, entry: &Entry, file: FileId, imports: &mut Vec<String>) -> String {
        let items = syntax::parse(file, &entry.text).file.items;
        let mut edits: Vec<Edit> = self.last_values(file);
        let count = items.len();
        for (i, item) in items.iter().enumerate() {
            let range = item.span.range();
            match &item.kind {
                ast::ItemKind::Use(u) => {
                    self.import(u, loaded_path(entry).is_some(), imports);
                    edits.push((range, String::new()));
                }
                ast::ItemKind::Statement(_) => {
                    // A value to which a later entry refers by `_` needs a name, and one that would seem to continue the
                    // line before.
                    let value = entry.value.filter(|_| i + 1 == count);
                    let seems = entry.text[range.clone()].starts_with(CONTINUING);
                    if let Some(name) = value.filter(|name| seems || self.is_used(*name)) {
                        edits.push((range.start..range.start, format!("let {name} = ")));
                    }
                }
                _ if self.is_replaced(file, &range) => edits.push((range, String::new())),
                _ => {}
            }
        }
        edited(&entry.text, edits)
    }

    /// Returns the edits that replace `_` by the name of the value it referred to.
    fn last_values(&self, file: FileId) -> Vec<Edit> {
        let here = self.checked.uses.iter().filter(|(span, _)| span.file == file);
        let of_hole = here.filter(|(span, _)| self.checked.sources.text(*span) == "_");
        let named = of_hole.map(|(span, id)| (span.range(), self.checked.program.def(*id).name.to_string()));
        named.collect()
    }

    /// Returns true if a name is used.
    fn is_used(&self, name: Symbol) -> bool {
        self.meant.get(&name).is_some_and(|id| self.used.contains(id))
    }

    /// Returns true if a later entry replaces the declaration at a range.
    fn is_replaced(&self, file: FileId, range: &Range<usize>) -> bool {
        let program = &self.checked.program;
        let own = program.own.iter().map(|id| (*id, program.def(*id)));
        let mut here = own.filter(|(_, def)| def.file == file && def.whole.range() == *range);
        here.any(|(id, def)| self.meant.get(&def.name) != Some(&id))
    }

    /// Adds an import without the names that stand for something else by now; of a file loaded as a whole,
    /// only the names that are used.
    fn import(&self, u: &ast::Use, loaded: bool, imports: &mut Vec<String>) {
        let source = match &u.source {
            ast::UseSource::File { path, .. } => format!("\"{path}\""),
            ast::UseSource::Path(path) => {
                path.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join(".")
            }
        };
        let line = match &u.names {
            None => format!("use {source}"),
            Some(names) => {
                let kept =
                    names.iter().filter(|name| self.is_imported(name, loaded)).map(|n| match n.rename {
                        Some(rename) => format!("{} as {}", n.name.text, rename.text),
                        None => n.name.text.to_string(),
                    });
                let kept: Vec<String> = kept.collect();
                if kept.is_empty() {
                    return;
                }
                format!("use {source}.{{{}}}", kept.join(", "))
            }
        };
        if !imports.contains(&line) {
            imports.push(line);
        }
    }

    /// Returns true if a name of an import is still needed.
    fn is_imported(&self, name: &ast::UseName, loaded: bool) -> bool {
        let shown = name.rename.unwrap_or(name.name).text;
        let Some(id) = self.meant.get(&shown) else { return false };
        let entered = self.checked.entries.contains(&self.checked.program.def(*id).file);
        !entered && (!loaded || self.used.contains(id))
    }
}

/// Returns a text with ranges replaced. Edits inside of others are left out; an insertion comes before the edit of
/// what begins there.
fn edited(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|(range, _)| (range.start, !range.is_empty(), std::cmp::Reverse(range.end)));
    let mut out = String::new();
    let mut at = 0;
    for (range, replacement) in edits {
        if range.start >= at {
            out.push_str(&text[at..range.start]);
            out.push_str(&replacement);
            at = range.end;
        }
    }
    out.push_str(&text[at..]);
    out
}
