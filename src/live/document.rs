//! A text that is changed by its picture and by whoever types it.

use super::edit::{Edit, changed};
use super::history::History;
use super::model::Model;
use crate::interrupt::CancelState;
use crate::session::Project;

/// A program with its text, the number of its version, and the changes that can be undone.
#[derive(Clone)]
pub struct Document {
    files: Project,
    program: String,
    text: String,
    version: u64,
    history: History,
}

/// The reason why a text is not changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The text has another version than the one that the change was made for.
    Outdated,
    /// Another reason, in the words of the program.
    Refused(String),
}

impl Document {
    /// Returns a program with a text. `files`: its project; `program`: its path in the project.
    pub fn new(files: Project, program: &str, text: &str) -> Document {
        let (program, text) = (program.to_owned(), text.to_owned());
        Document { files, program, text, version: 1, history: History::default() }
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the number of the version, which grows with each change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns the same document without its changes, for work beside it.
    pub fn reading(&self) -> Document {
        let (files, program, text) = (self.files.clone(), self.program.clone(), self.text.clone());
        Document { files, program, text, version: self.version, history: History::default() }
    }

    /// Returns true if the last change can be undone, and true if one that was undone can be made again.
    pub fn can(&self) -> (bool, bool) {
        (self.history.before(&self.text).is_some(), self.history.after(&self.text).is_some())
    }

    /// Returns what the text shows, with the declaration of the name `wanted` where it has one. Work ends early once `cancel` is
    /// cancelled.
    pub fn model(&self, wanted: Option<&str>, cancel: &CancelState) -> Model {
        Model::of(&self.files, &self.program, &self.text, wanted, cancel)
    }

    /// Returns the text after a change, with what it shows; the document stays as it is. `version`: that of the text that the
    /// change was made for; `before`: what that text shows, with the robot of the change. Work ends early once `cancel` is cancelled.
    ///
    /// # Errors
    /// A [`Refusal`] where the document has another version, the text can't be changed in this way, or the changed text has an error.
    pub fn edited(
        &self,
        version: u64,
        edit: &Edit,
        before: &Model,
        cancel: &CancelState,
    ) -> Result<(String, Model), Refusal> {
        if version != self.version {
            return Err(Refusal::Outdated);
        }
        let text = changed(&self.text, before, edit).map_err(Refusal::Refused)?;
        let model = Model::of(&self.files, &self.program, &text, Some(edit.robot()), cancel);
        match model.error() {
            Some(why) => Err(Refusal::Refused(why.to_owned())),
            None if cancel.is_cancelled() => Err(Refusal::Outdated),
            None => Ok((text, model)),
        }
    }

    /// Returns the text before the last change, or (`forth`) after the change that was undone last; the document stays as it is.
    /// `version`: that of the text that is shown.
    ///
    /// # Errors
    /// A [`Refusal`] where the document has another version, or there is no such change: a text that was typed since is not undone.
    pub fn moved(&self, version: u64, forth: bool) -> Result<String, Refusal> {
        if version != self.version {
            return Err(Refusal::Outdated);
        }
        let (found, what) = match forth {
            true => (self.history.after(&self.text), "made again"),
            false => (self.history.before(&self.text), "undone"),
        };
        let none = || Refusal::Refused(format!("there is nothing to be {what}, or the text was typed since"));
        found.map(str::to_owned).ok_or_else(none)
    }

    /// Takes on a text that [`edited`](Self::edited) returned, as one change that can be undone.
    pub fn accept(&mut self, text: String) {
        self.history.note(&self.text, &text);
        self.set(text);
    }

    /// Takes on a text that [`moved`](Self::moved) returned.
    pub fn accept_move(&mut self, text: String, forth: bool) {
        if forth {
            self.history.forth()
        } else {
            self.history.back()
        }
        self.set(text);
    }

    /// Takes on a text that somebody typed. Changes before it are undone only once it is typed back.
    pub fn replace(&mut self, text: &str) {
        if self.text != text {
            self.set(text.to_owned());
        }
    }

    /// Counts a version more of the same text, because a file that it imports has changed.
    pub fn touch(&mut self) {
        self.version += 1;
    }

    fn set(&mut self, text: String) {
        self.text = text;
        self.version += 1;
    }
}
