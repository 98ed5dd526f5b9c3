//! Planners: each a room of its own that turns a problem into a plan. Their motions go before the same judge as
//! everything else, and none of them is believed.
//!
//! Each planner has one entry of the same shape,
//! `plan(&Problem, &Settings, &mut dyn Progress) -> Result<Solution<Report>, Refusal>`: a problem in
//! numbers (SI units, the world's frame), settings with defaults, and a body of a plan beside a report of
//! the search, or an enum that says why there is none. No entry knows spans or diagnostics.

mod disjoint_sets;
pub mod fastest;
pub mod fold;
pub mod fold_sheet;
pub mod goals;
pub mod locomote;
pub mod morph;
pub mod planar_path;
mod push;
pub mod reconfigure;
pub mod refold;
pub mod squeeze;
pub mod tosnake;
pub mod truss;
mod tunnel;
pub mod unwind;

use crate::interrupt;
use crate::plan;

/// The result of a planner: the motion, the program it came from, and the figures of the search.
#[derive(Clone, Debug)]
pub struct Solution<R> {
    /// The motion: joint tracks, lattice stages or node paths. All its causes are cause 0 unless the
    /// planner's documentation says otherwise.
    pub body: plan::Body,
    /// The series-parallel program that `body` executes; `None` from planners that give a motion only.
    pub program: Option<plan::Program>,
    /// The figures of the search, of the planner's own type: method, bounds, counts of steps.
    pub report: R,
}

/// An observer of a search: it receives reports of progress and may end the search early, for instance
/// at a time limit.
///
/// An observer changes a result only by ending the search: a planner that is asked to stop returns the
/// best solution so far, or its refusal for an exhausted limit if there is none. To unwind without any
/// result, see [`interrupt::checkpoint`].
pub trait Progress {
    /// Receives the start of a part of the work before its reports: `_task` builds its name, such as `unwinding
    /// Chair`. An observer with a time limit counts from here. By default it is ignored.
    fn task_started(&mut self, _task: &dyn Fn() -> String) {}

    /// Receives the state of the search. `how_far` builds one short line of text, such as
    /// `12 of 40 points reached`; an observer that shows nothing does not call it. Called at least every few
    /// milliseconds, so it must be cheap.
    fn report(&mut self, how_far: &dyn Fn() -> String);

    /// Receives an event that happens seldom, such as one goal of many that is reached, as a line of text: an
    /// observer that shows reports only on request shows this one unasked. By default it is a report like any other.
    fn milestone(&mut self, reached: &dyn Fn() -> String) {
        self.report(reached);
    }

    /// Returns false if the search has to end with the best solution so far. Searches ask between two of their steps,
    /// and may ask again after false.
    fn should_continue(&mut self) -> bool;
}

/// The observer that ignores all reports and never ends the search.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {
    fn report(&mut self, _how_far: &dyn Fn() -> String) {}

    fn should_continue(&mut self) -> bool {
        true
    }
}

/// The observer that answers requests for progress made through [`interrupt`], and never ends the search
/// otherwise than by unwinding at a checkpoint.
#[derive(Clone, Copy, Debug, Default)]
pub struct RequestedProgress;

impl Progress for RequestedProgress {
    fn report(&mut self, how_far: &dyn Fn() -> String) {
        interrupt::progress_checkpoint(how_far);
    }

    fn should_continue(&mut self) -> bool {
        interrupt::checkpoint();
        true
    }
}
