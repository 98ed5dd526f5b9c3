//! A session: a program that grows entry by entry, with the values computed so far.
//!
//! An entry goes through the same rooms as a file. All entries share one scope, in which a later
//! declaration replaces an earlier one of its name, for the earlier entries too: the session is at any time
//! the program that `save` writes. It is checked as a whole for every entry, which takes milliseconds;
//! values are kept ([`crate::interpret::session`]), except those that depend on a new declaration
//! (`dependencies`).

mod capabilities;
mod changes;
mod dependencies;
mod kept;
mod state;

pub(crate) mod command;
pub(crate) mod complete;
mod describe;
pub mod entry;
pub(crate) mod highlight;
mod locals;
mod members;
mod path_type;
mod reload;
mod save;

pub use capabilities::{EmbeddedConfiguration, Repertoire};
pub use changes::{Change, ChangeKind};
pub use kept::{FileSnapshot, Project};
pub use state::{Input, Reloaded, Reply, Session};
