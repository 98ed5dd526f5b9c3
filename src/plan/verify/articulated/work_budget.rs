//! The limit of the work that conservative advancement may do, counted and not timed, so that it is the same everywhere.

/// The work that may be done for each sample that the settings allow, in comparisons of two bounding spheres. Most
/// intervals of most robots take less.
const WORK_PER_SAMPLE: usize = 2_000;

/// The number of modules by which the work of large robots is divided: a robot of `n` times as many, `n` rounded down, may
/// take an n-th of it, since an interval takes the more work the larger a robot is. Below twice this number a robot may
/// take all of it.
pub(super) const MODULES_SMALL: usize = 500;

/// The work of placing a link in the middle of an interval, in comparisons of two bounding spheres, as measured.
pub(super) const LINK_WORK: usize = 8;
/// The work of measuring a slab between two bodies, in the same unit.
pub(super) const SLAB_WORK: usize = 4;
/// The work of measuring the distance of two bodies, in the same unit.
pub(super) const DISTANCE_WORK: usize = 20;

/// The work done so far, in comparisons of two bounding spheres, and the most that may be done.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorkBudget {
    spent: usize,
    most: usize,
}

impl WorkBudget {
    /// Returns the budget of a robot of so many modules, of which nothing is spent.
    pub(super) fn new(samples_max: usize, modules: usize) -> WorkBudget {
        WorkBudget { spent: 0, most: work_max(samples_max, modules) }
    }

    /// Counts work.
    pub(super) fn spend(&mut self, work: usize) {
        self.spent = self.spent.saturating_add(work);
    }

    /// Returns true where as much work was done as may be.
    pub(super) fn is_spent(&self) -> bool {
        self.spent >= self.most
    }
}

/// Returns the most work that may be done to judge a robot of so many modules, in comparisons of two bounding spheres.
pub(super) fn work_max(samples_max: usize, modules: usize) -> usize {
    samples_max.saturating_mul(WORK_PER_SAMPLE) / (modules / MODULES_SMALL).max(1)
}
