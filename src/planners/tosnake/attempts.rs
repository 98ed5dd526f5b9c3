//! Attempts at pairs, several at a time on threads.
//!
//! The result does not depend on the number of threads. Each attempt draws the random numbers that it would
//! draw if those before it had been made one after the other, and the first success in order counts. The
//! results of later attempts are dropped.

use super::merging::Attempt;
use super::motion_check::Scene;
use super::parallel;
use super::state::{Joints, State};
use crate::optimize::random::SplitMix64;

/// An attempt to bring one pair of docks together, with its own generator of random numbers.
pub(super) struct Job<'a> {
    /// The attempt at one pair.
    pub(super) attempt: Attempt<'a>,
    /// The generator at the state that it would have if all jobs before had been done in turn.
    pub(super) rng: SplitMix64,
}

/// The result of a [`Job`]: the path found, and the work.
pub(super) struct Done {
    /// The index of the job in the list given, from 0.
    pub(super) job: usize,
    /// The path that the attempt found, as the postures of [`Attempt::path`]; `None` if it found none.
    pub(super) path: Option<Vec<Joints>>,
    /// The number of forward kinematics of the whole robot that were evaluated.
    pub(super) work: u64,
}

/// The number of jobs done before threads start: the first often succeeds.
const SEQUENTIAL_JOBS: usize = 1;

/// Runs jobs on up to `threads` threads and calls `take` with their results in the order of `jobs`, until it returns
/// true or all are done. `state`: the robot at which all attempts start. With more than one thread the robot must
/// float, for a gravity model notes overloads in the state.
pub(super) fn in_order(state: &State, jobs: &[Job], threads: usize, take: &mut dyn FnMut(Done) -> bool) {
    let (tree, docked, here) = (&state.tree, &state.docked, &state.robot.joints);
    let done = |job: usize, scene: &Scene| {
        let Job { attempt, rng } = &jobs[job];
        let mut work = 0;
        let path = attempt.path(scene, here, &mut rng.clone(), &mut work);
        Done { job, path, work }
    };
    // The first jobs, or all of them, on this thread.
    let sequential = if threads > 1 { SEQUENTIAL_JOBS.min(jobs.len()) } else { jobs.len() };
    let scene = state.scene();
    if (0..sequential).any(|job| take(done(job, &scene))) || sequential == jobs.len() {
        return;
    }
    let done =
        |job: usize| done(job, &Scene { tree, docked: docked.clone(), load_limit: None, stance: None });
    parallel::in_order(sequential..jobs.len(), threads, &done, take);
}
