//! The language server: answers what an editor asks about programs while they are typed, over the Language Server Protocol
//! 3.17.
//!
//! A program in an editor is checked like one on disk, with the texts of all open documents in place of their files
//! (`documents`), after each change on a thread that the next change cancels. Diagnostics go out from there (`publisher`): first
//! those of the types, then those that depend on values (`elaboration`), and what was asked to be verified (`verdicts`). All else
//! is asked: `names` finds declarations, `symbols` those of whole projects, `answers` gives the answers, with what the session
//! knows of names and candidates, `assistance` what is shown between the lines and what is offered to be written. Types of the
//! protocol stay in `wire`.

mod analysis;
mod answers;
mod assistance;
mod documents;
mod elaboration;
mod names;
mod places;
mod publisher;
mod server;
mod symbols;
mod verdicts;
mod wire;

pub use documents::{Opened, Workspace};
pub use server::serve;
