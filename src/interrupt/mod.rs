//! Cooperative cancellation of long work, progress reports from it, and a second thread for parts of it.
//!
//! Planners and the judge return a whole result or none. A [`checkpoint`] that finds the [`CancelState`]
//! of its thread cancelled, or more memory in use than the [limit](memory::limit), unwinds the stack to [`catch`], which
//! says so; no partial result can be mistaken for a whole one. The caller of `catch` restores what the work changed
//! outside of itself.
//!
//! If no checkpoint is passed for a while (inside a foreign solver), the waiting thread may abandon the
//! work ([`CancelState::abandon`]): it stops waiting, the work ends at its next checkpoint, and its result
//! is dropped.
//!
//! A progress report never changes what is computed.

pub mod memory;
pub mod second_thread;

use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex, PoisonError};

/// A cancellation token that any thread may set. Clones share one state.
#[derive(Clone, Default)]
pub struct CancelState(Arc<Flags>);

#[derive(Default)]
struct Flags {
    cancelled: AtomicBool,
    abandoned: AtomicBool,
    progress_requested: AtomicBool,
    on_abandon: Mutex<Option<Waker>>,
    /// The token whose cancellation cancels this one, too.
    parent: Option<CancelState>,
    /// True if the work of this token answers the progress requests of the parent, too.
    answers_parent: AtomicBool,
}

/// Wakes the thread that waits for the work.
type Waker = Box<dyn Fn() + Send>;

impl CancelState {
    /// Cancels the work of this token, and of every [`child`](Self::child): it unwinds at its next checkpoint.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Clears cancellation, abandonment and progress requests of this token, not of its parent, before new work
    /// starts.
    pub fn reset(&self) {
        self.resume_waiting();
        self.0.progress_requested.store(false, Ordering::Relaxed);
        self.0.cancelled.store(false, Ordering::Relaxed);
    }

    /// Clears abandonment only: a thread waits again for the cancelled work to end.
    pub fn resume_waiting(&self) {
        self.0.abandoned.store(false, Ordering::Relaxed);
    }

    /// Returns true if this token or its parent is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
            || self.0.parent.as_ref().is_some_and(CancelState::is_cancelled)
    }

    /// Returns a new token, for helper threads, that is also cancelled whenever this one is. Cancelling the child
    /// leaves this one alone, and the child has its own progress requests.
    pub fn child(&self) -> CancelState {
        CancelState(Arc::new(Flags { parent: Some(self.clone()), ..Flags::default() }))
    }

    /// Marks the work as abandoned: once it is cancelled, no thread waits for it any longer. Calls the function
    /// registered by [`CancelState::on_abandon`], on this thread.
    pub fn abandon(&self) {
        self.0.abandoned.store(true, Ordering::Relaxed);
        if let Some(wake) = &*self.0.on_abandon.lock().unwrap_or_else(PoisonError::into_inner) {
            wake();
        }
    }

    /// Returns true if the work is cancelled and abandoned.
    pub fn is_abandoned(&self) -> bool {
        self.is_cancelled() && self.0.abandoned.load(Ordering::Relaxed)
    }

    /// Registers the function that [`CancelState::abandon`] calls. It replaces the one registered before.
    pub fn on_abandon(&self, wake: impl Fn() + Send + 'static) {
        *self.0.on_abandon.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(wake));
    }

    /// Requests a progress report. The next [`progress_checkpoint`] of the work sends one.
    pub fn request_progress(&self) {
        self.0.progress_requested.store(true, Ordering::Relaxed);
    }

    /// Returns true if a progress request has not been answered yet.
    pub fn is_progress_requested(&self) -> bool {
        self.0.progress_requested.load(Ordering::Relaxed)
    }

    /// Returns true if a progress request waits, and takes it.
    fn take_progress_request(&self) -> bool {
        let answered = || self.0.parent.as_ref().filter(|_| self.0.answers_parent.load(Ordering::Relaxed));
        self.is_progress_requested() && self.0.progress_requested.swap(false, Ordering::Relaxed)
            || answered().is_some_and(CancelState::take_progress_request)
    }
}

impl fmt::Debug for CancelState {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_tuple("CancelState").field(&self.is_cancelled()).finish()
    }
}

/// The reason that work ended without a result: what unwinds from a checkpoint to [`catch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The user cancelled it.
    Cancelled,
    /// More memory is in use than the [limit](memory::limit).
    OutOfMemory,
}

/// The work on a thread.
#[derive(Clone)]
struct Work {
    cancel_state: CancelState,
    /// Receives progress reports.
    progress_sink: Rc<dyn Fn(String)>,
    /// The name of the running task, the prefix of each report; empty if there is none.
    task: String,
}

thread_local! {
    static WORK: RefCell<Option<Work>> = const { RefCell::new(None) };
}

/// Runs `work` on this thread under a cancellation token, and returns its result. `progress_sink` receives each progress
/// report as one line of text. Calls may nest: the inner token and sink replace the outer ones until the inner work ends.
/// A panic of the work goes on to the caller. `cancel_state`: the token.
///
/// # Errors
/// The reason that a checkpoint ended the work.
pub fn catch<T>(
    cancel_state: &CancelState,
    progress_sink: impl Fn(String) + 'static,
    work: impl FnOnce() -> T,
) -> Result<T, Ended> {
    let (cancel_state, progress_sink) = (cancel_state.clone(), Rc::new(progress_sink));
    let before = WORK.replace(Some(Work { cancel_state, progress_sink, task: String::new() }));
    let ended = catch_unwind(AssertUnwindSafe(work));
    WORK.set(before);
    match ended {
        Ok(result) => Ok(result),
        Err(thrown) => match thrown.downcast_ref::<Ended>() {
            Some(&why) => Err(why),
            None => resume_unwind(thrown),
        },
    }
}

/// Does two independent pieces of work, `here` on this thread and `beside` on another, and returns both results. A
/// cancellation of this thread's work ends both, and a panic of either goes on to the caller. Progress is that of
/// `here` until it is done, then that of `beside`. Without a second thread, `beside` is done after `here`.
///
/// ```
/// let (sum, product) = modl::interrupt::join(|| 2 + 3, || 2 * 3);
/// assert_eq!((sum, product), (5, 6));
/// ```
pub fn join<A, B: Send>(here: impl FnOnce() -> A, beside: impl FnOnce() -> B + Send) -> (A, B) {
    let cancel_state = current().map_or_else(CancelState::default, |user| user.child());
    let beside = Mutex::new(Some(beside));
    let take = || beside.lock().unwrap_or_else(PoisonError::into_inner).take().expect("it is done once");
    let (reports, received) = channel();
    std::thread::scope(|scope| {
        let report = move |line| drop(reports.send(line));
        let work = || catch(&cancel_state, report, || take()());
        let helper = std::thread::Builder::new().spawn_scoped(scope, work);
        // However this scope is left, the helper ends.
        let cancels = CancelOnDrop(&cancel_state);
        let a = here();
        let Ok(helper) = helper else { return (a, take()()) };
        cancel_state.0.answers_parent.store(true, Ordering::Relaxed);
        received.into_iter().for_each(report_progress);
        let b = helper.join().unwrap_or_else(|panic| resume_unwind(panic));
        drop(cancels);
        (a, b.unwrap_or_else(|why| unwind(why)))
    })
}

/// Cancels its token when dropped, so that threads that work under it end however their scope is left.
pub struct CancelOnDrop<'a>(pub &'a CancelState);

impl Drop for CancelOnDrop<'_> {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

/// Unwinds to [`catch`] if the work of this thread is cancelled, or more memory is in use than the limit; does nothing
/// outside of `catch`. It costs a few nanoseconds; every loop that may take long passes one at least every few
/// milliseconds.
pub fn checkpoint() {
    let why = WORK.with_borrow(|work| match work {
        Some(work) if work.cancel_state.is_cancelled() => Some(Ended::Cancelled),
        Some(_) if memory::is_exceeded() => Some(Ended::OutOfMemory),
        _ => None,
    });
    if let Some(why) = why {
        unwind(why);
    }
}

/// Returns the cancellation token of the innermost [`catch`] on this thread; `None` outside of every one.
pub fn current() -> Option<CancelState> {
    WORK.with_borrow(|work| work.as_ref().map(|work| work.cancel_state.clone()))
}

/// Unwinds to [`catch`], which returns the reason. Outside of `catch` it unwinds the thread, as a panic does, without a
/// message.
pub fn unwind(why: Ended) -> ! {
    resume_unwind(Box::new(why));
}

/// Starts a task by name (`folding 20 panels`), which stands before the progress reports from here on, and reports
/// the name alone unless it is empty. Does nothing outside of [`catch`].
pub fn start_task(task: String) {
    let work = WORK.with_borrow_mut(|work| {
        let work = work.as_mut()?;
        work.task.clone_from(&task);
        Some(work.clone())
    });
    if let Some(work) = work.filter(|work| !work.task.is_empty()) {
        (work.progress_sink)(task);
    }
}

/// Passes a [`checkpoint`], and reports progress if somebody requested it. `report` is called only then; its text
/// follows the name of the task.
pub fn progress_checkpoint(report: impl FnOnce() -> String) {
    checkpoint();
    if WORK.with_borrow(|work| work.as_ref().is_some_and(|work| work.cancel_state.take_progress_request())) {
        report_progress(report());
    }
}

/// Reports progress, requested or not: for what happens seldom. The name of the task goes before it. Does nothing
/// outside of [`catch`].
pub fn report_progress(report: String) {
    if let Some(work) = WORK.with_borrow(Clone::clone) {
        let line = if work.task.is_empty() { report } else { format!("{}: {report}", work.task) };
        (work.progress_sink)(line);
    }
}
