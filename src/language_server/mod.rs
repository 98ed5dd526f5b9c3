//! The language server: answers what an editor asks about programs while they are typed, over the Language Server Protocol
//! 3.17.
//!
//! A program in an editor is checked like one on disk, with the texts of all open documents in place of their files
//! (`documents`). Diagnostics go out after each change, first those of the types, then, from a thread that the next change
//! cancels, those that depend on values (`elaboration`). All else is asked: `names` finds declarations, `answers` gives the
//! answers, with what the session knows of names and candidates, `assistance` what is shown between the lines and what is offered
//! to be written. Types of the protocol stay in `wire`.

mod analysis;
mod answers;
mod assistance;
mod documents;
mod elaboration;
mod names;
mod places;
mod server;
mod wire;

pub use documents::{Opened, Workspace};
pub use server::serve;
