//! Descriptions of names: `:doc`, `:source`, `:vars`, `:type`.

use super::dependencies::meant;
use super::members::about;
use super::state::{Session, is_given, value_type};
use crate::check::summary::{self, Group, Inside};
use crate::check::typed::{Def, DefId, DefKind};
use crate::check::{self, Checked, Entry, Meaning, Type};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, library};
use crate::syntax::{self, ast};
use std::sync::Arc;

impl Session {
    /// Returns the type of an expression in the language's words; `nothing` for a text without a value. Nothing is
    /// evaluated.
    ///
    /// # Errors
    /// (program, errors): the checked program in whose sources the spans are, and the errors in the text.
    pub fn type_of(&self, text: &str) -> Result<String, (Arc<Checked>, Vec<Diagnostic>)> {
        let entry =
            Entry { name: "<type>".into(), text: text.into(), first_line: 1, value: None, last: self.last };
        let (checked, ty) = typed(self, entry);
        match ty {
            Some(ty) => Ok(checked.program.type_name(&ty)),
            None => {
                let known = self.checked.sources.files().count();
                let own = |d: &&Diagnostic| {
                    d.is_error() && d.span().is_none_or(|span| span.file.0 as usize >= known)
                };
                let wrong: Vec<Diagnostic> = checked.diagnostics.iter().filter(own).cloned().collect();
                if wrong.is_empty() { Ok("nothing".to_owned()) } else { Err((Arc::new(checked), wrong)) }
            }
        }
    }

    /// Returns the signature, documentation and members of a name as text: of a declaration, `name.member`, an item
    /// of the library that is not imported, or a command such as `:load`.
    ///
    /// # Errors
    /// A message for an unknown name.
    pub fn doc(&self, name: &str) -> Result<String, String> {
        if let Some(&(_, command, does)) =
            super::command::COMMANDS.iter().find(|(c, ..)| name == format!(":{c}"))
        {
            return Ok(format!("{name} {command}: {does}\n"));
        }
        let Some((id, member)) = self.find(name) else { return self.doc_of_library(name) };
        let def = self.checked.program.def(id);
        match member {
            // A value has the members of its type.
            Some(member) => member_doc(&self.checked, def, &member)
                .or_else(|| member_doc(&self.checked, self.checked.program.def(type_of(def)?), &member))
                .ok_or_else(|| format!("`{}` has no `{member}`", def.name)),
            None => Ok(self.doc_of(id)),
        }
    }

    /// Returns true if a name is declared in the session, or in what it imports.
    pub fn declares(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    /// Returns the signature of a built-in function, for a text that is only its name; `None` if the text names
    /// no built-in function. Functions with arguments of several types are no values, so the text alone would
    /// be an error.
    pub fn call_of(&self, text: &str) -> Option<String> {
        let (id, member) = self.find(text.trim())?;
        let native = matches!(self.checked.program.def(id).kind, DefKind::Native(_)) && member.is_none();
        let name = self.checked.program.def(id).name;
        native.then(|| format!("{}\n`:doc {name}` tells more\n", summary::signature(&self.checked, id)))
    }

    /// Returns the source text of the declaration of a name after a comment with its file and line; for
    /// `name.member`, that of `name`.
    ///
    /// # Errors
    /// A message for an unknown name.
    pub fn source(&self, name: &str) -> Result<String, String> {
        let Some((id, _)) = self.find(name) else { return Err(self.unknown(name)) };
        let def = self.checked.program.def(id);
        let file = self.checked.sources.file(def.file);
        let line = self.checked.sources.line_column(def.whole).line;
        Ok(format!("// {}:{line}\n{}\n", file.name, self.checked.sources.text(def.whole)))
    }

    /// Returns all declarations that are visible by a name, without those of the prelude and the stored values of
    /// expressions (`_1`), as (name, type or keyword), sorted by name.
    pub fn vars(&self) -> Vec<(String, String)> {
        let program = &self.checked.program;
        let own = meant(&self.checked).into_iter().filter(|(name, id)| {
            let file = self.checked.sources.file(program.def(*id).file);
            &*file.name != "std/prelude.mod" && is_given(*name)
        });
        own.map(|(name, id)| (name.to_string(), about(program, id))).collect()
    }

    /// Returns a declaration by its name, and the name of a member after a dot; `None` if there is no such
    /// declaration.
    fn find(&self, name: &str) -> Option<(DefId, Option<String>)> {
        let mut names = name.split('.').map(str::trim);
        let first = names.next()?;
        let first = if first == "_" { self.last?.as_str() } else { first };
        let meaning = self.checked.names.iter().find(|(known, _)| known.as_str() == first);
        match &meaning?.1 {
            Meaning::Def(id) => Some((*id, names.next().map(str::to_owned))),
            Meaning::File(items) => {
                let item = names.next()?;
                let id = items.iter().find(|(known, _)| known.as_str() == item)?.1;
                Some((id, names.next().map(str::to_owned)))
            }
        }
    }

    /// Returns the message about an unknown name.
    fn unknown(&self, name: &str) -> String {
        let known = self.checked.names.iter().map(|(known, _)| known.as_str());
        match suggest(name, known) {
            Some(near) => format!("`{name}` is not known here; `{near}`?"),
            None => format!("`{name}` is not known here"),
        }
    }

    /// Returns the documentation of a library item that is not imported.
    ///
    /// # Errors
    /// A message if the library has none of this name.
    fn doc_of_library(&self, name: &str) -> Result<String, String> {
        for (file, _) in library::FILES {
            let Some(text) = crate::source::Files::library(&*self.files, file) else { continue };
            let parsed = syntax::parse(crate::source::FileId(0), &text);
            let found = parsed.file.items.iter().find(|item| is_named(item, name));
            if let Some(item) = found {
                let stem = file.trim_end_matches(".mod");
                let doc = item.doc.as_deref().unwrap_or("").trim();
                return Ok(format!("`{name}` is in std.{stem}: `use std.{stem}.{name}`\n\n{doc}\n"));
            }
        }
        Err(self.unknown(name))
    }

    /// Returns signature, documentation and members of a declaration.
    fn doc_of(&self, id: DefId) -> String {
        let def = self.checked.program.def(id);
        let mut out = format!("{}\n", summary::signature(&self.checked, id));
        if let Some(doc) = &def.doc {
            out.push_str(&format!("\n{}\n", doc.trim()));
        }
        let inside = lines(&summary::inside(&self.checked, def));
        if !inside.is_empty() {
            out.push_str(&format!("\n{inside}"));
        }
        out
    }
}

/// Checks `entry` as the next entry of the session, without adding it, and returns (program, type): the program, and
/// the type of its last expression, `None` if that has no value.
pub(super) fn typed(session: &Session, entry: Entry) -> (Checked, Option<Type>) {
    let mut entries = session.entries.clone();
    entries.push(entry);
    let checked = check::check_session(&*session.files, &entries);
    let ty = checked.entries.last().and_then(|file| value_type(&checked, *file));
    (checked, ty)
}

/// Returns true if an item declares a name.
fn is_named(item: &ast::Item, name: &str) -> bool {
    item.kind.name().is_some_and(|declared| declared.text == name)
}

/// Returns the declaration of which the value of a `let` is an instance; `None` for other declarations and
/// values.
fn type_of(def: &Def) -> Option<DefId> {
    match &def.kind {
        DefKind::Let(binding) => match binding.ty {
            Type::Instance(id) | Type::Record(id) => Some(id),
            _ => None,
        },
        _ => None,
    }
}

/// Returns the joints, ports, parts, behaviours, fields and methods, a line each.
fn lines(inside: &[Inside]) -> String {
    let line = |inside: &Inside| {
        let contracts: String = inside.contracts.iter().map(|clause| format!("    {clause}\n")).collect();
        let doc = inside.doc.as_deref().map(|doc| format!("      {}\n", first_paragraph(doc)));
        format!("  {}\n{contracts}{}", head(inside), doc.unwrap_or_default())
    };
    // Parameters are in the signature.
    inside.iter().filter(|inside| inside.group != Group::Parameter).map(line).collect()
}

/// Returns a member with its keyword, if it has one.
fn head(inside: &Inside) -> String {
    match inside.group {
        Group::Field | Group::Method => inside.head.clone(),
        group => format!("{} {}", group.word(), inside.head),
    }
}

/// Returns the documentation of a joint, port, behaviour, field or method; `None` if the declaration has none
/// of this name.
fn member_doc(checked: &Checked, def: &Def, name: &str) -> Option<String> {
    let found = summary::inside(checked, def).into_iter().find(|inside| inside.name.as_str() == name)?;
    let doc = found.doc.as_deref().map(|doc| format!("\n{}\n", doc.trim())).unwrap_or_default();
    let contracts: String = found.contracts.iter().map(|clause| format!("  {clause}\n")).collect();
    Some(format!("{}, of {}\n{contracts}{doc}", head(&found), def.name))
}

fn first_paragraph(doc: &str) -> String {
    let paragraph = doc.trim().split("\n\n").next().unwrap_or("");
    paragraph.split_whitespace().collect::<Vec<_>>().join(" ")
}
