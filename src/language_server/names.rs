//! The declarations that a program names, by their places.

use super::analysis::Analysis;
use crate::check::summary::{self, Inside};
use crate::check::typed::{Def, DefId, DefKind};
use crate::check::{self, Checked, Meaning};
use crate::source::{FileId, Replaced, Span};
use crate::syntax::{Outline, TokenKind};
use std::collections::BTreeMap;
use std::ops::Range;

/// A declaration, or a member of one.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// The declaration.
    pub def: DefId,
    /// The name of the member; `None` for the declaration itself.
    pub member: Option<String>,
}

/// Returns the range of the word at an offset of a text, in bytes; `None` where there is none.
pub(super) fn word_at(text: &str, at: usize) -> Option<Range<usize>> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = text[..at]
        .rfind(|c| !is_word(c))
        .map_or(0, |found| found + text[found..].chars().next().map_or(0, char::len_utf8));
    let end = text[at..].find(|c| !is_word(c)).map_or(text.len(), |found| at + found);
    (start < end && !text[start..].starts_with(|c: char| c.is_ascii_digit())).then_some(start..end)
}

impl Analysis {
    /// Returns the declaration that is named, or declared, at an offset of the document.
    pub(super) fn declaration_at(&self, at: usize) -> Option<DefId> {
        let covers =
            |span: &Span| span.file == self.file && span.range().start <= at && at <= span.range().end;
        let named = self.checked.uses.iter().filter(|(span, _)| covers(span));
        // Of a name with dots, such as `std.smores.Car`, the shortest piece counts.
        let used = named.min_by_key(|(span, _)| span.range().len()).map(|(_, id)| *id);
        used.or_else(|| {
            let word = word_at(self.text(self.file), at)?;
            let declared = |(_, def): &(DefId, &Def)| def.span.file == self.file && def.span.range() == word;
            self.checked.program.identified().find(declared).map(|(id, _)| id)
        })
    }

    /// Returns what the word at an offset of the document names: a declaration of the program, or a member of the declaration
    /// around it or before the dot.
    pub(super) fn named_at(&self, at: usize) -> Option<Named> {
        if let Some(def) = self.declaration_at(at) {
            return Some(Named { def, member: None });
        }
        let text = self.text(self.file);
        let word = word_at(text, at)?;
        let name = &text[word.clone()];
        let of = |def: DefId| Named { def, member: Some(name.to_owned()) };
        let has = |def: &DefId| self.about_member(*def, name).is_some();
        if text[..word.start].ends_with('.') {
            let knowledge = self.knowledge();
            return knowledge.declaration_before(&text[..word.start - 1]).filter(has).map(of);
        }
        if let Some(around) = self.declaration_around(at).filter(has) {
            return Some(of(around));
        }
        let meant = self.checked.names.iter().find(|(known, _)| known.as_str() == name);
        match meant.map(|(_, meaning)| meaning) {
            Some(Meaning::Def(def)) => Some(Named { def: *def, member: None }),
            _ => None,
        }
    }

    /// Returns the declaration in whose text an offset of the document lies.
    fn declaration_around(&self, at: usize) -> Option<DefId> {
        let program = &self.checked.program;
        let around = |id: &&DefId| {
            let whole = program.def(**id).whole;
            whole.file == self.file && whole.range().contains(&at)
        };
        program.own.iter().find(around).copied()
    }

    /// Returns the place at which a declaration declares a member: a behaviour, or a member of its instances; `None` where it
    /// has none of this name with a place of its own.
    pub(super) fn member_span(&self, def: DefId, name: &str) -> Option<Span> {
        let kind = &self.checked.program.def(def).kind;
        let behavior = match kind {
            DefKind::Config(config) => {
                config.behaviors.iter().find(|behavior| behavior.name.as_str() == name)
            }
            _ => None,
        };
        let member = || {
            let members = kind.instantiable()?.members;
            members.iter().find(|member| member.name.as_str() == name).map(|member| member.span)
        };
        behavior.map(|behavior| behavior.span).or_else(member)
    }

    /// Returns the words about a member of a declaration: what documentation shows of it.
    pub(super) fn about_member(&self, def: DefId, name: &str) -> Option<Inside> {
        let found = summary::inside(&self.checked, self.checked.program.def(def));
        found.into_iter().find(|inside| inside.name.as_str() == name)
    }

    /// Returns all places at which a declaration of the project is named, and that of its declaration, each once, in the order
    /// of files and text.
    pub(super) fn places_of(&self, def: DefId) -> Vec<(FileId, Range<usize>)> {
        let declared = self.checked.program.def(def);
        let name = declared.name.as_str();
        let mut found = vec![(declared.span.file, declared.span.range())];
        for (span, id) in &self.checked.uses {
            // A use may be a name with dots, or another name by which the declaration was imported.
            let range = span.range();
            let last = range.end.saturating_sub(name.len());
            let text = self.text(span.file);
            if *id == def && range.start <= last && text.get(last..range.end) == Some(name) {
                found.push((span.file, last..range.end));
            }
        }
        found.sort_by_key(|(file, range)| (*file, range.start));
        found.dedup();
        found.retain(|(file, _)| !self.checked.sources.file(*file).library);
        found
    }

    /// Returns true if the program has no other errors than now after these places were given the name `new`.
    pub(super) fn stays_sound(&self, places: &[(FileId, Range<usize>)], new: &str) -> bool {
        let mut texts: BTreeMap<String, String> = BTreeMap::new();
        // From behind, so that the places before stay where they are.
        for (file, range) in places.iter().rev() {
            let name = self.checked.sources.file(*file).name.to_string();
            let text = texts.entry(name).or_insert_with(|| self.text(*file).to_owned());
            text.replace_range(range.clone(), new);
        }
        let renamed = self.with_texts(texts);
        let errors = |checked: &Checked| {
            checked
                .diagnostics
                .iter()
                .filter(|diagnostic| diagnostic.is_error())
                .map(|d| d.code)
                .collect::<Vec<_>>()
        };
        errors(&check::check(&renamed, &self.name)) == errors(&self.checked)
    }

    /// Returns the files of the program, some with other texts, by their names.
    pub(super) fn with_texts(&self, texts: BTreeMap<String, String>) -> Replaced<'_> {
        Replaced { files: &*self.files, texts }
    }

    /// Returns all places in the files of the project at which a member of a declaration is named, and that of its own
    /// declaration, in the order of files and text.
    pub(super) fn places_of_member(&self, def: DefId, name: &str) -> Vec<(FileId, Range<usize>)> {
        let own = self.checked.sources.files().filter(|(_, file)| !file.library);
        let mut found = Vec::new();
        for (id, source) in own {
            let there = self.seen_from(id);
            let Some(outline) = Outline::of(&source.text) else { continue };
            let words = outline.tokens.iter().filter(|token| {
                token.kind == TokenKind::Word && source.text[token.start..token.end] == *name
            });
            let same = |at: usize| {
                let named = there.named_at(at);
                named.is_some_and(|named| named.def == def && named.member.as_deref() == Some(name))
            };
            found.extend(words.filter(|token| same(token.start)).map(|token| (id, token.start..token.end)));
        }
        found
    }

    /// Returns true if a declaration may be renamed: one of the project.
    pub(super) fn is_own(&self, def: DefId) -> bool {
        let declared = self.checked.program.def(def);
        !self.checked.sources.file(declared.file).library && !matches!(declared.kind, DefKind::Error)
    }
}
