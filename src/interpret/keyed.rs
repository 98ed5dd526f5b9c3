//! Shared things that are found by a number which is the same for those that are alike.

use std::collections::BTreeMap;
use std::rc::Rc;

/// Things by a key, several to a key.
pub struct Keyed<T>(BTreeMap<u64, Vec<Rc<T>>>);

impl<T> Clone for Keyed<T> {
    fn clone(&self) -> Keyed<T> {
        Keyed(self.0.clone())
    }
}

impl<T> Default for Keyed<T> {
    fn default() -> Keyed<T> {
        Keyed(BTreeMap::new())
    }
}

impl<T> Keyed<T> {
    /// Returns the first thing with this key for which `is_wanted` is true; `None` if there is none.
    pub fn find(&self, key: u64, is_wanted: impl Fn(&T) -> bool) -> Option<Rc<T>> {
        self.0.get(&key)?.iter().find(|thing| is_wanted(thing)).cloned()
    }

    /// Adds a thing.
    pub fn push(&mut self, key: u64, thing: Rc<T>) {
        self.0.entry(key).or_default().push(thing);
    }

    /// Removes a thing, the very same one.
    pub fn remove(&mut self, thing: &Rc<T>) {
        self.0.values_mut().for_each(|alike| alike.retain(|known| !Rc::ptr_eq(known, thing)));
    }

    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}
