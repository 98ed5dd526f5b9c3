//! Work on large trusses on two threads at once. The results do not depend on the number of processors: no part uses a result of
//! the other.

use super::structure::Structure;
use crate::interrupt;
use std::iter;

/// The number of nodes from which on two threads find parts of a step: with fewer these take less time than a thread takes to
/// wake.
const NODES_MANY: usize = 200;

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
    if serve(truss) { interrupt::second_thread::both(here, beside) } else { (here(), beside()) }
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
