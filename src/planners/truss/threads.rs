//! Work on trusses on two threads at once. The results do not depend on the number of processors: what is done at once is
//! decided by the size of the truss alone, and no part of it uses a result of the other.

use super::structure::Structure;
use crate::interrupt;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::iter;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// The number of nodes from which on two threads find parts of a step: with fewer these take less time than a thread takes to
/// wake.
const NODES_MANY: usize = 200;

/// The thread for the second of two parts of a step, which take milliseconds; `None` where the system has none to give. It waits
/// between steps: a thread that begins anew for each part takes as long as some of them, and often begins on the processor
/// that the first part has.
static SECOND: LazyLock<Option<ThreadPool>> = LazyLock::new(|| {
    ThreadPoolBuilder::new().num_threads(1).thread_name(|_| "truss".to_owned()).build().ok()
});

/// True while a truss uses that thread: another one does both parts itself.
static BUSY: AtomicBool = AtomicBool::new(false);

/// Gives the second thread back when dropped.
struct Release;

impl Drop for Release {
    fn drop(&mut self) {
        BUSY.store(false, Ordering::Release);
    }
}

/// Returns true for a truss that is so large that parts of its steps are found on two threads.
pub(super) fn serve(truss: &Structure) -> bool {
    truss.nodes >= NODES_MANY
}

/// Returns the results of two short functions, which run at once on two threads if the truss is large and the second thread is
/// free, else one after the other.
pub(super) fn both<A, B: Send>(
    truss: &Structure,
    here: impl FnOnce() -> A,
    beside: impl FnOnce() -> B + Send,
) -> (A, B) {
    let Some(second) = SECOND.as_ref().filter(|_| serve(truss) && !BUSY.swap(true, Ordering::Acquire)) else {
        return (here(), beside());
    };
    let _release = Release;
    let mut b = None;
    let a = second.in_place_scope(|scope| {
        scope.spawn(|_| b = Some(beside()));
        here()
    });
    (a, b.expect("a scope ends after all that began in it"))
}

/// Returns what `of` has for all indices below `count`: where the truss is large, for every other one on each of two threads.
pub(super) fn by_turns<T: Send>(
    truss: &Structure,
    count: usize,
    of: impl Fn(&mut dyn Iterator<Item = usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    if !serve(truss) {
        return of(&mut (0..count));
    }
    // Moves that take long come one after the other.
    let (even, odd) = interrupt::join(|| of(&mut (0..count).step_by(2)), || of(&mut (1..count).step_by(2)));
    let mut odd = odd.into_iter();
    even.into_iter().flat_map(|value| iter::once(value).chain(odd.next())).collect()
}
