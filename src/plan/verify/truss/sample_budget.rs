//! The number of samples that conservative advancement and bisection may take in the judgement of one plan.
//!
//! A pair that keeps a distance to spare takes fewer than ten samples on a step. One that creeps along its clearance
//! takes many, and a plan in which all pairs do so would keep the judge for minutes.

use std::cell::Cell;

/// Greatest number of samples of one pair, node, angle or sum on one step.
const STEP_SAMPLES_MAX: usize = 100_000;
/// Number of samples that each of them may take on every step, whatever the others took.
const STEP_SAMPLES_MIN: usize = 1_000;
/// Greatest number of samples beyond [`STEP_SAMPLES_MIN`] that all checks of a plan take together: seconds.
const PLAN_SAMPLES_MAX: usize = 4_000_000;

/// The samples that the checks of a plan may still take beyond those that each may take on every step, of
/// [`PLAN_SAMPLES_MAX`].
pub(super) struct SampleBudget(Cell<usize>);

impl SampleBudget {
    /// Returns the full budget, of which nothing is spent.
    pub(super) fn new() -> SampleBudget {
        SampleBudget(Cell::new(PLAN_SAMPLES_MAX))
    }

    /// Calls `sample` until it returns a result, and returns that. `None` if it has none after as many calls as the
    /// budget allows, so that nothing is proved.
    pub(super) fn advance<T>(&self, mut sample: impl FnMut() -> Option<T>) -> Option<T> {
        let most = STEP_SAMPLES_MAX.min(STEP_SAMPLES_MIN + self.0.get());
        for taken in 1..=most {
            let found = sample();
            if found.is_some() || taken == most {
                self.0.set(self.0.get() - taken.saturating_sub(STEP_SAMPLES_MIN));
                return found;
            }
        }
        None
    }
}
