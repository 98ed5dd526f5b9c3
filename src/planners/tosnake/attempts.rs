//! Attempts at bringing pairs together, several at a time on threads.
//!
//! What is found does not depend on how many threads there are. Each attempt throws the rng that it
//! would throw if those before it had been made one after the other; and they count in their order up to
//! the first that succeeds. What later ones have done by then is forgotten.

use super::merging::Attempt;
use super::state::{Joints, State};
use super::sweep::Scene;
use crate::interrupt::{self, CancelState};
use crate::planners::random::SplitMix64;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread;

/// An attempt with the rng that it throws.
pub struct Job<'a> {
    pub attempt: Attempt<'a>,
    pub rng: SplitMix64,
}

/// What came of a job.
pub struct Made {
    /// Its number.
    pub job: usize,
    /// See [`Attempt::way`].
    pub way: Option<Vec<Joints>>,
    /// Poses that it took.
    pub work: u64,
}

/// Does jobs, and calls `take` with what came of each, in their order, until it says that it has enough.
/// With more than one thread nothing may pull at the robot.
pub fn in_order(state: &State, jobs: &[Job], threads: usize, take: &mut dyn FnMut(Made) -> bool) {
    let (tree, docked, here) = (&state.tree, &state.docked, &state.robot.joints);
    let made = |job: usize, scene: &Scene| {
        let Job { attempt, rng } = &jobs[job];
        let mut work = 0;
        let way = attempt.way(scene, here, &mut rng.clone(), &mut work);
        Made { job, way, work }
    };
    // What comes first often succeeds: threads would only get in each other's way.
    let alone = if threads > 1 { ALONE.min(jobs.len()) } else { jobs.len() };
    let scene = state.scene();
    if (0..alone).any(|job| take(made(job, &scene))) || alone == jobs.len() {
        return;
    }
    let cancel_state = interrupt::current().map_or_else(CancelState::default, |user| user.child());
    let next = AtomicUsize::new(alone);
    let (sender, results) = channel();
    thread::scope(|scope| {
        for _ in 0..threads.min(jobs.len() - alone) {
            let (sender, next, cancel_state, made) = (sender.clone(), &next, &cancel_state, &made);
            scope.spawn(move || {
                let scene = Scene { tree, docked: docked.clone(), burden: None };
                let work = || {
                    loop {
                        let job = next.fetch_add(1, Ordering::Relaxed);
                        if job >= jobs.len() || sender.send(made(job, &scene)).is_err() {
                            return;
                        }
                    }
                };
                interrupt::catch(cancel_state, |_| {}, work)
            });
        }
        drop(sender);
        // Whichever way this is left, the threads are to end.
        let _cancels = CancelOnDrop(&cancel_state);
        let mut early = BTreeMap::new();
        let mut awaited = alone;
        for made in results {
            early.insert(made.job, made);
            while let Some(made) = early.remove(&awaited) {
                awaited += 1;
                if take(made) {
                    return;
                }
            }
        }
        // Before all results came only the user's cancellation ends the threads.
        interrupt::checkpoint();
    });
}

/// Jobs that are done before threads begin.
const ALONE: usize = 1;

/// Cancels its token when dropped.
struct CancelOnDrop<'a>(&'a CancelState);

impl Drop for CancelOnDrop<'_> {
    fn drop(&mut self) {
        self.0.cancel();
    }
}
