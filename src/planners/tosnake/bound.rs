//! A lower bound on the changes of connections on the way to a snake.

use crate::planners::disjoint_sets::DisjointSets;

/// Returns the least number of bonds that have to be docked or undocked so that modules become a snake. `modules`: their number;
/// `bonds`: of each bond that holds the two modules, by index, and true if the snake may have it.
///
/// The ends of a module take one bond each, so the bonds that may stay form chains and rings; a ring has to lose one.
pub(in crate::planners) fn fewest_changes(
    modules: usize,
    bonds: impl Iterator<Item = ([usize; 2], bool)>,
) -> usize {
    let mut chains = DisjointSets::new(modules);
    let (mut undocked, mut docked) = (0, modules.saturating_sub(1));
    for ([a, b], may_stay) in bonds {
        if may_stay && chains.join(a, b) {
            docked -= 1;
        } else {
            undocked += 1;
        }
    }
    docked + undocked
}
