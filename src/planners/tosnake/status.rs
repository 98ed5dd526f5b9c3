//! The state of a search in figures, and its reports to an observer.

use super::state::State;
use crate::planners::Progress;

/// The figures of a search that is running or has ended: merges made of those needed, and the work so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchStatus {
    /// The number of merges of chains that lead to a snake: one less than there are chains once all loops are open.
    pub needed: usize,
    /// The number of merges made; in a refusal of the method of [Mrázek et al.](super) the greatest that it came to.
    pub made: usize,
    /// The number of attempts to bring a pair of ends together.
    pub tried: u64,
    /// The number of forward kinematics of the whole robot that were evaluated.
    pub work: u64,
    /// The number of perturbations: one after each round in which no pair came together, or the last chain did not
    /// become straight.
    pub perturbations: u64,
    /// The number of modules of the longest chain.
    pub longest: usize,
    /// The number of chains; a module without snake bonds is one.
    pub chains: usize,
}

impl SearchStatus {
    /// Sets the number of chains and the length of the longest (in modules) to those of the state.
    pub(super) fn count_chains(&mut self, state: &State) {
        let mut chains = state.chains();
        chains.sort_unstable();
        let lengths = chains.chunk_by(|a, b| a == b).map(<[usize]>::len);
        (self.chains, self.longest) = lengths.fold((0, 0), |(n, most), l| (n + 1, most.max(l)));
    }
}

/// The reporter of a search to its observer: it sends a new merge as a milestone, anything else as a report on request.
pub(super) struct Reporter<'a> {
    progress: &'a mut dyn Progress,
    made: Option<usize>,
}

impl<'a> Reporter<'a> {
    /// Returns a reporter to `progress` that has not reported any merge.
    pub(super) fn new(progress: &'a mut dyn Progress) -> Reporter<'a> {
        Reporter { progress, made: None }
    }

    /// Reports the status to the observer; returns false if the observer ends the search.
    pub(super) fn report(&mut self, status: &SearchStatus) -> bool {
        let SearchStatus { needed, made, tried, .. } = status;
        let words = || format!("{made} of {needed} connections made, {tried} pairs of ends tried");
        if self.made.replace(*made) == Some(*made) {
            self.progress.report(&words);
        } else {
            self.progress.milestone(&words);
        }
        self.progress.should_continue()
    }
}
