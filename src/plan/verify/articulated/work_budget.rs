//! The limit of the work that conservative advancement may do, counted and not timed, so that it is the same
//! everywhere.

/// The work that may be done for each sample that the settings allow, in comparisons of two bounding spheres. Most
/// intervals of most robots take less.
const WORK_PER_SAMPLE: usize = 2_000;

/// The number of modules from which on work is limited: a robot of at least `n` times as many, `n` a whole number of
/// 2 or more, may take an n-th of the work, since an interval takes the more work the larger a robot is.
pub(super) const MODULES_SMALL: usize = 500;

/// The work of placing a link in the middle of an interval, in comparisons of two bounding spheres, as measured.
pub(super) const LINK_WORK: usize = 8;
/// The work of measuring a slab between two bodies, in comparisons of two bounding spheres.
pub(super) const SLAB_WORK: usize = 4;
/// The work of measuring the distance of two bodies, in comparisons of two bounding spheres.
pub(super) const DISTANCE_WORK: usize = 20;

/// The work done so far, in comparisons of two bounding spheres, and the most that may be done.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorkBudget {
    spent: usize,
    most: usize,
}

impl WorkBudget {
    /// Returns the budget of a robot of `modules` modules, of which nothing is spent; `samples_max`: that of the
    /// settings.
    pub(super) fn new(samples_max: usize, modules: usize) -> WorkBudget {
        WorkBudget { spent: 0, most: work_max(samples_max, modules) }
    }

    /// Counts `work` comparisons of two bounding spheres as spent.
    pub(super) fn spend(&mut self, work: usize) {
        self.spent = self.spent.saturating_add(work);
    }

    /// Returns true if as much work was done as may be.
    pub(super) fn is_spent(&self) -> bool {
        self.spent >= self.most
    }
}

/// Returns the most work that may be done to judge a robot of `modules` modules, in comparisons of two bounding
/// spheres; `samples_max`: that of the settings.
pub(super) fn work_max(samples_max: usize, modules: usize) -> usize {
    samples_max.saturating_mul(WORK_PER_SAMPLE) / (modules / MODULES_SMALL).max(1)
}
