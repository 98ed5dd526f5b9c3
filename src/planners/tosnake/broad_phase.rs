//! The broad phase of collision checking: pairs of balls that are near each other, and those of them that touch by
//! design.

use super::robot::Robot;
use super::tree::Tree;
use crate::geometry::RigidTransform;
use crate::geometry::broad_phase::near_points;

/// Calls `found` with every pair of balls whose centres are nearer than `reach`: their indices in `poses`, the smaller
/// first, and the squared distance of the centres. The order of the pairs is that of [`near_points`]. `poses`: of the
/// shoes, in the tree's order ([`Tree::shoe`]); lengths in pitches.
pub fn pairs(poses: &[RigidTransform], reach: f64, found: &mut dyn FnMut(usize, usize, f64)) {
    near_points(poses.len(), |index| poses[index].translation, reach, found);
}

/// Returns true if two balls, given by their indices in the tree's order ([`Tree::shoe`]), are the two shoes of one
/// module, or shoes docked to each other, so that they touch at all times; true also for one ball and itself.
/// `docked`: the pairs as [`docked`] returns them, ascending with the smaller index first. Panics if an index is none
/// of the tree.
pub fn always_touch(tree: &Tree, a: usize, b: usize, docked: &[(usize, usize)]) -> bool {
    tree.shoe[a] / 2 == tree.shoe[b] / 2 || docked.binary_search(&(a.min(b), a.max(b))).is_ok()
}

/// Returns the pairs of shoes docked to each other by closed bonds, as indices in the tree's order ([`Tree::shoe`]),
/// the smaller first, in ascending order. `robot`: the configuration; `tree`: its kinematic tree.
pub fn docked(robot: &Robot, tree: &Tree) -> Vec<(usize, usize)> {
    let mut all: Vec<(usize, usize)> = robot
        .held()
        .map(|(_, bond)| {
            let (a, b) = (tree.index[bond.a.shoe()], tree.index[bond.b.shoe()]);
            (a.min(b), a.max(b))
        })
        .collect();
    all.sort_unstable();
    all
}

/// Returns the least distance of the centres of two balls that do not touch by design; infinite if none are nearer
/// than `reach`. `docked`: as by [`docked`]; `poses`: of the shoes, in the tree's order ([`Tree::shoe`]); lengths in
/// pitches.
pub fn least_distance(tree: &Tree, docked: &[(usize, usize)], poses: &[RigidTransform], reach: f64) -> f64 {
    let mut least = f64::INFINITY;
    pairs(poses, reach, &mut |a, b, squared| {
        if squared < least && !always_touch(tree, a, b, docked) {
            least = squared;
        }
    });
    libm::sqrt(least)
}
