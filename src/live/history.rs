//! Changes of a text that can be undone.

/// The most bytes of texts that are kept: the oldest changes are forgotten first.
const KEPT_MAX: usize = 64 << 20;

/// A text before and after a change.
#[derive(Clone, Debug)]
struct Step {
    before: String,
    after: String,
}

impl Step {
    fn size(&self) -> usize {
        self.before.len() + self.after.len()
    }
}

/// The changes of a text in order, with the place between those that are made and those that are undone.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
}

impl History {
    /// Records a change. Changes that were undone before can't be made again.
    pub(super) fn note(&mut self, before: &str, after: &str) {
        self.undone.clear();
        self.done.push(Step { before: before.to_owned(), after: after.to_owned() });
        let mut size: usize = self.done.iter().map(Step::size).sum();
        while size > KEPT_MAX && self.done.len() > 1 {
            size -= self.done.remove(0).size();
        }
    }

    /// Returns the text before the last change, if `now` is the text after it.
    pub(super) fn before(&self, now: &str) -> Option<&str> {
        self.done.last().filter(|step| step.after == now).map(|step| step.before.as_str())
    }

    /// Returns the text after the change that was undone last, if `now` is the text before it.
    pub(super) fn after(&self, now: &str) -> Option<&str> {
        self.undone.last().filter(|step| step.before == now).map(|step| step.after.as_str())
    }

    /// Goes back over the last change.
    pub(super) fn back(&mut self) {
        self.undone.extend(self.done.pop());
    }

    /// Goes forward over the change that was undone last.
    pub(super) fn forth(&mut self) {
        self.done.extend(self.undone.pop());
    }
}
