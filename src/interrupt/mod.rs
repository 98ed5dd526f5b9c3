//! The wish that long work ends: raised from outside, obeyed at checkpoints.
//!
//! Planners and the judge give a whole result or none, so there is nothing between that a caller
//! could take for one: a checkpoint that finds the wish raised unwinds the stack up to [`catch`]. What
//! the work had changed outside of itself is the caller's to put back.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A wish that any thread may raise; copies are one and the same.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Takes the wish back, before new work begins.
    pub fn lower(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    pub fn raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What is thrown from a checkpoint to [`catch`].
struct Interrupted;

thread_local! {
    /// What the work on this thread obeys.
    static OBEYED: RefCell<Option<Interrupt>> = const { RefCell::new(None) };
}

/// Does work that ends once the wish is raised, and then gives `None`.
pub fn catch<T>(interrupt: &Interrupt, work: impl FnOnce() -> T) -> Option<T> {
    let before = OBEYED.replace(Some(interrupt.clone()));
    let ended = catch_unwind(AssertUnwindSafe(work));
    OBEYED.set(before);
    match ended {
        Ok(result) => Some(result),
        Err(thrown) if thrown.is::<Interrupted>() => None,
        Err(panic) => resume_unwind(panic),
    }
}

/// Ends the work at hand if somebody wished it. Costs a few nanoseconds; every loop that may take
/// long passes one at least every few milliseconds.
pub fn checkpoint() {
    if OBEYED.with_borrow(|obeyed| obeyed.as_ref().is_some_and(Interrupt::raised)) {
        resume_unwind(Box::new(Interrupted));
    }
}
