//! Differences between the files of a session before and after they are read again.

use super::dependencies::{Dependencies, meant};
use super::state::is_given;
use crate::check::Checked;
use crate::check::typed::DefId;
use std::collections::BTreeMap;

/// A declaration of a file that is new, changed or gone since the file was read before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The name of the file that contains the declaration.
    pub file: String,
    /// The name of the declaration that changed.
    pub name: String,
    /// The kind of change: added, changed or removed.
    pub kind: ChangeKind,
    /// The visible names of the session that depend on the declaration, sorted; empty if it is gone.
    pub users: Vec<String>,
}

/// The change of a declaration between two readings of its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangeKind {
    /// The declaration is new in its file.
    Added,
    /// The text of the declaration differs from that of the earlier reading.
    Changed,
    /// The declaration is gone from its file.
    Removed,
}

/// Returns the differences between the declarations of the project's files: first new and changed ones, then
/// those that are gone, each sorted by file and name.
pub(super) fn changes(before: &Checked, after: &Checked) -> Vec<Change> {
    let (old, new) = (declarations(before), declarations(after));
    let dependencies = Dependencies::of(after);
    let meant = meant(after);
    let users = |id: DefId| {
        let users = dependencies.users_of(&[id]);
        let named = meant.iter().filter(|(name, user)| users.contains(user) && is_given(**name));
        named.map(|(name, _)| name.to_string()).collect()
    };
    let mut found = Vec::new();
    for ((file, name), (id, text)) in &new {
        let kind = match old.get(&(file.clone(), name.clone())) {
            Some((_, before)) if before == text => continue,
            Some(_) => ChangeKind::Changed,
            None => ChangeKind::Added,
        };
        found.push(Change { file: file.clone(), name: name.clone(), kind, users: users(*id) });
    }
    for key in old.keys().filter(|key| !new.contains_key(*key)) {
        let (file, name) = key.clone();
        found.push(Change { file, name, kind: ChangeKind::Removed, users: Vec::new() });
    }
    found
}

/// Declarations with their texts, by file and name.
type Declarations = BTreeMap<(String, String), (DefId, String)>;

/// Returns the texts of the declarations of the project's files, without the entries of the session.
fn declarations(checked: &Checked) -> Declarations {
    let entries = checked.entries.iter();
    let entries: Vec<_> = entries.copied().collect();
    let own = checked.program.own.iter().map(|id| (*id, checked.program.def(*id)));
    own.filter(|(_, def)| !entries.contains(&def.file))
        .map(|(id, def)| {
            let file = checked.sources.file(def.file).name.to_string();
            ((file, def.name.to_string()), (id, checked.sources.text(def.whole).to_owned()))
        })
        .collect()
}
