//! The entities that the names at the top of a file stand for, for editors and sessions.

use super::checker::{Checker, Entity};
use super::typed::DefId;
use crate::source::Symbol;

/// The entity that a name at the top of a file stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// A declaration, by its identity.
    Def(DefId),
    /// An imported file, with its public declarations, sorted by name.
    File(Vec<(Symbol, DefId)>),
}

impl Checker<'_> {
    /// Returns the names visible at the top of a file (an index into the loaded files), the prelude's included, as
    /// (name, meaning), sorted by name.
    pub(super) fn meanings(&self, file: usize) -> Vec<(Symbol, Meaning)> {
        let own = self.top(file).iter();
        let inherited = self.loaded.prelude.into_iter().flat_map(|prelude| self.top(prelude).iter());
        let mut found: Vec<(Symbol, Meaning)> = own
            .chain(inherited.filter(|(name, _)| !self.top(file).contains_key(name)))
            .filter_map(|(name, entity)| Some((*name, self.meaning(*entity)?)))
            .collect();
        found.sort_by_key(|(name, _)| *name);
        found
    }

    fn meaning(&self, entity: Entity) -> Option<Meaning> {
        match entity {
            Entity::Def(id) => Some(Meaning::Def(id)),
            Entity::File(file) => {
                let own = |(name, entity): (&Symbol, &Entity)| match entity {
                    Entity::Def(id) if self.def(*id).file == file => Some((*name, *id)),
                    _ => None,
                };
                let mut items: Vec<(Symbol, DefId)> = self.top(file).iter().filter_map(own).collect();
                items.retain(|(name, _)| !name.as_str().starts_with('_'));
                items.sort_by_key(|(name, _)| *name);
                Some(Meaning::File(items))
            }
            Entity::Error => None,
        }
    }
}
