//! A second thread for the second of two short parts of a computation. Results depend neither on the number of processors nor on
//! whether the thread is free: no part uses a result of the other, and each is the same computation wherever it runs.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// The thread, `None` where the system has none to give. It waits between computations: a thread that begins anew for each part takes
/// as long as some of them, and often begins on the processor that the first part has.
static SECOND: LazyLock<Option<ThreadPool>> = LazyLock::new(|| {
    ThreadPoolBuilder::new().num_threads(1).thread_name(|_| "second".to_owned()).build().ok()
});

/// True while the thread has a part to do: who asks for it in the meantime does both parts alone.
static BUSY: AtomicBool = AtomicBool::new(false);

/// Gives the thread back when dropped.
struct Release;

impl Drop for Release {
    fn drop(&mut self) {
        BUSY.store(false, Ordering::Release);
    }
}

/// Returns the results of two short functions, which run at once on two threads if the second thread is free, else one after the
/// other. It pays from some tens of microseconds on. Neither has a [`checkpoint`](super::checkpoint), which would not end the work on
/// the second thread.
pub fn both<A, B: Send>(here: impl FnOnce() -> A, beside: impl FnOnce() -> B + Send) -> (A, B) {
    let Some(second) = SECOND.as_ref().filter(|_| !BUSY.swap(true, Ordering::Acquire)) else {
        return (here(), beside());
    };
    let mut b = None;
    let a = second.in_place_scope(|scope| {
        scope.spawn(|_| {
            // It is free for others while the first part goes on.
            let _release = Release;
            b = Some(beside());
        });
        here()
    });
    (a, b.expect("a scope ends after all that began in it"))
}
