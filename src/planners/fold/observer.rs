//! The observer of one planning call, shared by the searches that the call is made of.

use crate::planners::Progress;
use std::cell::{Cell, RefCell};

/// The observer of one planning call: it forwards the reports of all searches to one [`Progress`] and remembers if it
/// has ended the call.
pub struct Observer<'p> {
    progress: RefCell<Option<&'p mut dyn Progress>>,
    ended: Cell<bool>,
}

impl<'p> Observer<'p> {
    /// Returns an observer that forwards every report and every question to `progress`.
    pub fn new(progress: &'p mut dyn Progress) -> Observer<'p> {
        Observer { progress: RefCell::new(Some(progress)), ended: Cell::new(false) }
    }

    /// Returns an observer that ignores reports and never ends a search.
    pub fn none() -> Observer<'static> {
        Observer { progress: RefCell::new(None), ended: Cell::new(false) }
    }

    /// Forwards the state of a search to the [`Progress`]; `how_far` builds its line of text, and is called only if
    /// the text is read.
    pub fn report(&self, how_far: impl Fn() -> String) {
        if let Some(progress) = &mut *self.progress.borrow_mut() {
            progress.report(&how_far);
        }
    }

    /// Asks the [`Progress`], and returns false once the search has to end with the best solution so far; it stays
    /// false.
    pub fn should_continue(&self) -> bool {
        let goes_on = match &mut *self.progress.borrow_mut() {
            Some(progress) => progress.should_continue(),
            None => true,
        };
        self.ended.set(self.ended.get() || !goes_on);
        !self.ended.get()
    }
}
