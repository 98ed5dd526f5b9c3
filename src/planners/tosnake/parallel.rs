//! Independent jobs on threads, whose results are taken in the order of the jobs, whatever the number of threads is.

use crate::interrupt::{self, CancelState};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread;

/// Does jobs on up to `threads` threads, and calls `take` with their results in their order until it returns true or all
/// are done; results of later jobs are then dropped. With one thread, or where the system gives none, they are done on
/// this one.
pub(super) fn in_order<D: Send>(
    jobs: Range<usize>,
    threads: usize,
    done: &(impl Fn(usize) -> D + Sync),
    take: &mut dyn FnMut(D) -> bool,
) {
    if threads <= 1 || jobs.len() <= 1 {
        jobs.into_iter().any(|job| take(done(job)));
        return;
    }
    let cancel_state = interrupt::current().map_or_else(CancelState::default, |user| user.child());
    let next = AtomicUsize::new(jobs.start);
    let (sender, results) = channel();
    thread::scope(|scope| {
        let worker = |_| {
            let (sender, next, cancel_state, end) = (sender.clone(), &next, &cancel_state, jobs.end);
            // Each thread takes the next job that none has begun.
            let work = move || {
                loop {
                    let job = next.fetch_add(1, Ordering::Relaxed);
                    if job >= end || sender.send((job, done(job))).is_err() {
                        return;
                    }
                }
            };
            let work = move || interrupt::catch(cancel_state, |_| {}, work);
            thread::Builder::new().spawn_scoped(scope, work).ok()
        };
        // The system may give fewer threads.
        let workers: Vec<_> = (0..threads.min(jobs.len())).map_while(worker).collect();
        drop(sender);
        if workers.is_empty() {
            jobs.into_iter().any(|job| take(done(job)));
            return;
        }
        // However this scope is left, the threads end.
        let _cancels = interrupt::CancelOnDrop(&cancel_state);
        // Results that came early wait for those before them.
        let mut early = BTreeMap::new();
        let mut awaited = jobs.start;
        for (job, done) in results {
            early.insert(job, done);
            while let Some(done) = early.remove(&awaited) {
                awaited += 1;
                if take(done) {
                    return;
                }
            }
        }
        // Before all results came only the user's cancellation, or a limit, ends the threads.
        interrupt::checkpoint();
        for worker in workers {
            let ended = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            ended.unwrap_or_else(|why| interrupt::unwind(why));
        }
    });
}
