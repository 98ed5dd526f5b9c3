//! The threads that compute rows.

use super::claims::Journal;
use super::identity::Recorder;
use crate::check::Checked;
use crate::check::typed::DefId;
use crate::execute;
use crate::interpret::study::{RowCells, StudyWorker};
use crate::interpret::{Host, Options, WriteError};
use crate::interrupt::CancelState;
use crate::source::Diagnostic;
use crate::study::Coordinate;
use std::collections::VecDeque;
use std::sync::mpsc::Sender;
use std::sync::{Condvar, Mutex, PoisonError};

/// A row to be computed.
pub(super) struct Task {
    /// The number of the row.
    pub row: u64,
    /// The coordinates of the axes that the sampler chooses.
    pub point: Vec<Coordinate>,
    /// The indices of the values of the other axes.
    pub each: Vec<u64>,
    /// True if the row is set aside: it is not computed again.
    pub aside: bool,
}

/// A message of a thread.
pub(super) enum Told {
    /// A row was computed.
    Row(u64, Box<RowCells>),
    /// The study has no rows, for these reasons.
    Failed(Vec<Diagnostic>),
    /// The user cancelled.
    Cancelled,
}

/// The tasks that wait for a thread.
#[derive(Default)]
pub(super) struct Queue {
    waiting: Mutex<(VecDeque<Task>, bool)>,
    changed: Condvar,
}

impl Queue {
    /// Adds a task.
    pub(super) fn push(&self, task: Task) {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner).0.push_back(task);
        self.changed.notify_one();
    }

    /// Lets the threads end, and drops what waits.
    pub(super) fn close(&self) {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.0.clear();
        waiting.1 = true;
        self.changed.notify_all();
    }

    /// Returns the next task, once there is one; `None` at the end.
    fn take(&self) -> Option<Task> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if let Some(task) = waiting.0.pop_front() {
                return Some(task);
            }
            if waiting.1 {
                return None;
            }
            waiting = self.changed.wait(waiting).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Closes a queue when it is dropped, so that threads end however their scope is left.
pub(super) struct CloseOnDrop<'q>(pub &'q Queue);

impl Drop for CloseOnDrop<'_> {
    fn drop(&mut self) {
        self.0.close();
    }
}

/// The host of a study's rows, which neither print nor write.
pub(super) struct Quiet(pub CancelState);

impl Host for Quiet {
    fn print(&mut self, _: &str) {}

    fn write(&mut self, _: &str, _: &[u8]) -> Result<String, WriteError> {
        Err(WriteError::Failed("a study writes its table, and nothing else".to_owned()))
    }

    fn progress(&mut self, _: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.0.clone()
    }
}

/// The study whose rows are computed.
#[derive(Clone, Copy)]
pub(super) struct Subject<'s> {
    /// The checked program.
    pub checked: &'s Checked,
    /// The files that it reads.
    pub files: &'s Recorder<'s>,
    /// The choices of the user.
    pub options: &'s Options,
    /// The declaration of the study.
    pub study: DefId,
}

impl Subject<'_> {
    /// Calls `work` with an evaluator of rows; `None` if the user cancels.
    ///
    /// # Errors
    /// The diagnostics for which the study has no rows.
    pub(super) fn evaluate<T: Send>(
        &self,
        host: &mut dyn Host,
        work: impl FnOnce(&mut StudyWorker) -> T + Send,
    ) -> Result<Option<T>, Vec<Diagnostic>> {
        execute::with_study(self.checked, self.files, host, self.options, self.study, work)
    }

    /// Computes the rows of a queue until it is closed, as the thread of this number.
    pub(super) fn work(
        &self,
        queue: &Queue,
        journal: &Journal,
        thread: usize,
        cancel_state: CancelState,
        told: &Sender<Told>,
    ) {
        let sender = told.clone();
        let ended = self.evaluate(&mut Quiet(cancel_state), move |worker| {
            while let Some(task) = queue.take() {
                journal.note(thread, (!task.aside).then_some(task.row));
                let row = match task.aside {
                    true => Some(worker.set_aside(&task.point, &task.each)),
                    false => worker.row(&task.point, &task.each),
                };
                journal.note(thread, None);
                let Some(row) = row else { return false };
                if sender.send(Told::Row(task.row, Box::new(row))).is_err() {
                    return true;
                }
            }
            true
        });
        let last = match ended {
            Ok(Some(true)) => return,
            Ok(_) => Told::Cancelled,
            Err(diagnostics) => Told::Failed(diagnostics),
        };
        drop(told.send(last));
    }
}
