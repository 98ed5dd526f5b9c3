//! The names that a plan file states beside its indices, compared with what the indices stand for.

use super::fault::PlanFault;
use std::collections::BTreeMap;

/// The names that stand beside the indices of a plan file, in the order of the file, each with the sort and the
/// number of what it names.
#[derive(Default)]
pub(super) struct Stated {
    names: Vec<(&'static str, usize, String)>,
    counts: BTreeMap<&'static str, usize>,
}

impl Stated {
    /// Adds the name of the next thing of the sort `what`, such as `joint`; things of one sort are numbered from 0.
    pub(super) fn add(&mut self, what: &'static str, name: &str) {
        let count = self.counts.entry(what).or_default();
        self.names.push((what, *count, name.to_owned()));
        *count += 1;
    }

    /// Adds the names of the next things of the sort `what`, in order.
    pub(super) fn add_all<'n>(&mut self, what: &'static str, names: impl IntoIterator<Item = &'n String>) {
        names.into_iter().for_each(|name| self.add(what, name));
    }

    /// Checks that the names are the same, in the same order, as those of `of_indices`, which the indices stand for.
    ///
    /// # Errors
    /// [`PlanFault::Name`] for the first name that differs, [`PlanFault::Names`] where there are too few of them or
    /// too many.
    pub(super) fn check(&self, of_indices: &Stated) -> Result<(), PlanFault> {
        for ((what, index, stated), (sort, number, name)) in self.names.iter().zip(&of_indices.names) {
            if (what, index) != (sort, number) {
                return Err(PlanFault::Names { what: sort });
            }
            if stated != name {
                let (stated, name) = (stated.clone(), name.clone());
                return Err(PlanFault::Name { what, index: *index, stated, name });
            }
        }
        match (self.names.get(of_indices.names.len()), of_indices.names.get(self.names.len())) {
            (Some((what, ..)), _) | (_, Some((what, ..))) => Err(PlanFault::Names { what }),
            (None, None) => Ok(()),
        }
    }
}
