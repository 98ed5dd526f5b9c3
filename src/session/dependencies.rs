//! The dependency graph of a session's declarations.

use crate::check::typed::DefId;
use crate::check::{Checked, Meaning};
use crate::source::{FileId, Span, Symbol};
use std::collections::{BTreeMap, BTreeSet};

/// The dependency graph of the declarations of the project and the session: which of them names which.
pub(super) struct Dependencies<'c> {
    checked: &'c Checked,
    /// The begin and end of every declaration, in order, by file.
    places: BTreeMap<FileId, Vec<(u32, u32, DefId)>>,
    /// The declarations that name a declaration, by the named one.
    users: BTreeMap<DefId, BTreeSet<DefId>>,
}

impl<'c> Dependencies<'c> {
    /// Builds the graph from the recorded uses of a checked program.
    pub(super) fn of(checked: &'c Checked) -> Dependencies<'c> {
        let mut places: BTreeMap<FileId, Vec<(u32, u32, DefId)>> = BTreeMap::new();
        for &id in &checked.program.own {
            let def = checked.program.def(id);
            places.entry(def.file).or_default().push((def.whole.start, def.whole.end, id));
        }
        places.values_mut().for_each(|defs| defs.sort_unstable());
        let mut found = Dependencies { checked, places, users: BTreeMap::new() };
        for &(span, named) in &checked.uses {
            if let Some(user) = found.declaration_at(span).filter(|user| *user != named) {
                found.users.entry(named).or_default().insert(user);
            }
        }
        found
    }

    /// Returns the project's declaration that contains a span; `None` if none does.
    pub(super) fn declaration_at(&self, span: Span) -> Option<DefId> {
        let defs = self.places.get(&span.file)?;
        let next = defs.partition_point(|(start, _, _)| *start <= span.start);
        let (_, end, id) = *defs.get(next.checked_sub(1)?)?;
        (span.end <= end).then_some(id)
    }

    /// Returns the declarations that name one of `named`, directly or indirectly, without `named` themselves.
    pub(super) fn users_of(&self, named: &[DefId]) -> BTreeSet<DefId> {
        let mut found = BTreeSet::new();
        let mut waiting = named.to_vec();
        while let Some(id) = waiting.pop() {
            let users = self.users.get(&id).into_iter().flatten();
            waiting.extend(users.filter(|user| !named.contains(user) && found.insert(**user)));
        }
        found
    }

    /// Returns the declarations that the text of a file names, directly or indirectly, those of the file that are
    /// named there included.
    pub(super) fn needed_by(&self, file: FileId) -> BTreeSet<DefId> {
        let mut named: BTreeMap<DefId, Vec<DefId>> = BTreeMap::new();
        for (of, users) in &self.users {
            users.iter().for_each(|user| named.entry(*user).or_default().push(*of));
        }
        let mut found = BTreeSet::new();
        let own = self.checked.uses.iter().filter(|(span, _)| span.file == file);
        let mut waiting: Vec<DefId> = own.map(|(_, id)| *id).collect();
        while let Some(id) = waiting.pop() {
            if found.insert(id) {
                waiting.extend(named.get(&id).into_iter().flatten());
            }
        }
        found
    }
}

/// Returns the declarations that the names visible in the session stand for, by name; names of imported files are left
/// out.
pub(super) fn meant(checked: &Checked) -> BTreeMap<Symbol, DefId> {
    let meant = checked.names.iter().filter_map(|(name, meaning)| match meaning {
        Meaning::Def(id) => Some((*name, *id)),
        Meaning::File(_) => None,
    });
    meant.collect()
}
