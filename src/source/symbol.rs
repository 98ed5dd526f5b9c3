//! Interned names: equal names are one pointer, so comparing and copying them is cheap.

use std::collections::HashSet;
use std::sync::{LazyLock, Mutex};

/// All interned names.
static NAMES: LazyLock<Mutex<HashSet<&'static str>>> = LazyLock::new(Default::default);

/// An interned name, which is compared and copied as cheaply as a pointer. It is never freed: a program has few
/// distinct names.
///
/// Equality compares pointers; order compares text, so that sorting is reproducible.
#[derive(Clone, Copy, Eq)]
pub struct Symbol(&'static str);

impl Symbol {
    /// Returns the symbol of a text, which stays in memory until the process ends.
    pub fn new(text: &str) -> Symbol {
        let mut names = NAMES.lock().expect("interning cannot panic");
        if let Some(name) = names.get(text) {
            return Symbol(name);
        }
        let name: &'static str = Box::leak(text.into());
        names.insert(name);
        Symbol(name)
    }

    /// Returns the text of the name.
    pub fn as_str(self) -> &'static str {
        self.0
    }
}

impl PartialEq for Symbol {
    fn eq(&self, other: &Symbol) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl std::hash::Hash for Symbol {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.as_ptr().hash(state);
    }
}

impl PartialOrd for Symbol {
    fn partial_cmp(&self, other: &Symbol) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Symbol {
    fn cmp(&self, other: &Symbol) -> std::cmp::Ordering {
        self.0.cmp(other.0)
    }
}

impl PartialEq<str> for Symbol {
    fn eq(&self, other: &str) -> bool {
        self.0 == other
    }
}

impl PartialEq<&str> for Symbol {
    fn eq(&self, other: &&str) -> bool {
        self.0 == *other
    }
}

impl From<&str> for Symbol {
    fn from(text: &str) -> Symbol {
        Symbol::new(text)
    }
}

impl std::fmt::Display for Symbol {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.0)
    }
}

impl std::fmt::Debug for Symbol {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}`", self.0)
    }
}
