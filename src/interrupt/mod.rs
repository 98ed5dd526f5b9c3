//! The wish that long work ends, and the question how far it is: raised from outside, obeyed and answered
//! at checkpoints.
//!
//! Planners and the judge give a whole result or none, so there is nothing between that a caller
//! could take for one: a checkpoint that finds the wish raised unwinds the stack up to [`catch`]. What
//! the work had changed outside of itself is the caller's to put back.
//!
//! Where no checkpoint comes for a while (somebody else's solver is at work), whoever waits may give
//! up: the work then ends at its next checkpoint, and nobody takes what comes of it.
//!
//! Nobody's answer to the question how far it is changes what is computed.

use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A wish that any thread may raise; copies are one and the same.
#[derive(Clone, Default)]
pub struct Interrupt(Arc<Wish>);

#[derive(Default)]
struct Wish {
    raised: AtomicBool,
    given_up: AtomicBool,
    asked: AtomicBool,
    waker: Mutex<Option<Waker>>,
    /// A wish that counts as this one, too.
    above: Option<Interrupt>,
}

/// Wakes who waits for the work.
type Waker = Box<dyn Fn() + Send>;

impl Interrupt {
    pub fn raise(&self) {
        self.0.raised.store(true, Ordering::Relaxed);
    }

    /// Takes the wish back, before new work begins.
    pub fn lower(&self) {
        self.wait_again();
        self.0.asked.store(false, Ordering::Relaxed);
        self.0.raised.store(false, Ordering::Relaxed);
    }

    /// Somebody waits once more for the end that is wished.
    pub fn wait_again(&self) {
        self.0.given_up.store(false, Ordering::Relaxed);
    }

    pub fn raised(&self) -> bool {
        self.0.raised.load(Ordering::Relaxed) || self.0.above.as_ref().is_some_and(Interrupt::raised)
    }

    /// A wish of its own, that is raised where this one is, too: for helpers at one piece of the work.
    pub fn below(&self) -> Interrupt {
        Interrupt(Arc::new(Wish { above: Some(self.clone()), ..Wish::default() }))
    }

    /// Nobody is to wait any longer for work whose end is wished.
    pub fn give_up(&self) {
        self.0.given_up.store(true, Ordering::Relaxed);
        if let Some(wake) = &*self.0.waker.lock().unwrap_or_else(PoisonError::into_inner) {
            wake();
        }
    }

    pub fn given_up(&self) -> bool {
        self.raised() && self.0.given_up.load(Ordering::Relaxed)
    }

    /// What [`Interrupt::give_up`] calls, in place of what it called before.
    pub fn on_give_up(&self, wake: impl Fn() + Send + 'static) {
        *self.0.waker.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(wake));
    }

    /// Asks the work how far it is. It answers at its next checkpoint that knows.
    pub fn ask(&self) {
        self.0.asked.store(true, Ordering::Relaxed);
    }

    pub fn asked(&self) -> bool {
        self.0.asked.load(Ordering::Relaxed)
    }
}

impl fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_tuple("Interrupt").field(&self.raised()).finish()
    }
}

/// What is thrown from a checkpoint to [`catch`].
struct Interrupted;

/// The work on a thread: what it obeys, who hears how far it is, and what it is about.
#[derive(Clone)]
struct Work {
    interrupt: Interrupt,
    hear: Rc<dyn Fn(String)>,
    about: String,
}

thread_local! {
    static WORK: RefCell<Option<Work>> = const { RefCell::new(None) };
}

/// Does work that ends once the wish is raised, and then gives `None`. `hear` is told how far it is.
pub fn catch<T>(
    interrupt: &Interrupt,
    hear: impl Fn(String) + 'static,
    work: impl FnOnce() -> T,
) -> Option<T> {
    let own = Work { interrupt: interrupt.clone(), hear: Rc::new(hear), about: String::new() };
    let before = WORK.replace(Some(own));
    let ended = catch_unwind(AssertUnwindSafe(work));
    WORK.set(before);
    match ended {
        Ok(result) => Some(result),
        Err(thrown) if thrown.is::<Interrupted>() => None,
        Err(panic) => resume_unwind(panic),
    }
}

/// Ends the work at hand if somebody wished it. Costs a few nanoseconds; every loop that may take
/// long passes one at least every few milliseconds.
pub fn checkpoint() {
    if WORK.with_borrow(|work| work.as_ref().is_some_and(|work| work.interrupt.raised())) {
        leave();
    }
}

/// The wish that the work at hand obeys.
pub fn current() -> Option<Interrupt> {
    WORK.with_borrow(|work| work.as_ref().map(|work| work.interrupt.clone()))
}

/// Ends the work at hand.
pub fn leave() -> ! {
    resume_unwind(Box::new(Interrupted));
}

/// The work at hand is now about this: `folding 20 panels`.
pub fn begin(about: String) {
    let work = WORK.with_borrow_mut(|work| {
        let work = work.as_mut()?;
        work.about.clone_from(&about);
        Some(work.clone())
    });
    if let Some(work) = work.filter(|work| !work.about.is_empty()) {
        (work.hear)(about);
    }
}

/// A checkpoint that knows how far the work is, and what is best so far. Words are found only where
/// somebody asked.
pub fn progress(how_far: impl FnOnce() -> String) {
    checkpoint();
    let asked = WORK.with_borrow(|work| {
        let asked = work.as_ref().map(|work| &work.interrupt.0.asked);
        asked.is_some_and(|asked| asked.load(Ordering::Relaxed) && asked.swap(false, Ordering::Relaxed))
    });
    if asked {
        tell(how_far());
    }
}

/// Tells how far the work is, whether or not somebody asked: for what happens seldom.
pub fn tell(how_far: String) {
    if let Some(work) = WORK.with_borrow(Clone::clone) {
        let both = if work.about.is_empty() { how_far } else { format!("{}: {how_far}", work.about) };
        (work.hear)(both);
    }
}
