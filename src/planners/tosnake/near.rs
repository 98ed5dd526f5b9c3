//! Pairs of balls that are near each other.

use super::rigid::{Rigid, Vec3};
use super::robot::Robot;
use super::tree::Tree;

/// Calls `found` for every pair of places whose balls are nearer than `reach`, the smaller first.
pub fn pairs(poses: &[Rigid], reach: f64, found: &mut dyn FnMut(usize, usize, f64)) {
    let axis = widest(poses);
    let mut order: Vec<(f64, u32)> =
        poses.iter().enumerate().map(|(place, pose)| (pose.place[axis], place as u32)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let sorted: Vec<Vec3> = order.iter().map(|(_, place)| poses[*place as usize].place).collect();
    for i in 0..sorted.len() {
        let p = sorted[i];
        for j in i + 1..sorted.len() {
            if order[j].0 - order[i].0 >= reach {
                break;
            }
            let squared = (sorted[j] - p).norm_squared();
            if squared < reach * reach {
                let (a, b) = (order[i].1 as usize, order[j].1 as usize);
                found(a.min(b), a.max(b), squared);
            }
        }
    }
}

fn widest(poses: &[Rigid]) -> usize {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = -low;
    for pose in poses {
        low = low.inf(&pose.place);
        high = high.sup(&pose.place);
    }
    (high - low).imax()
}

/// Whether two places are shoes of one module, or docked to one another: then they always touch.
pub fn touch_always(tree: &Tree, a: usize, b: usize, docked: &[(usize, usize)]) -> bool {
    tree.shoe[a] / 2 == tree.shoe[b] / 2 || docked.binary_search(&(a.min(b), a.max(b))).is_ok()
}

/// The pairs of places that are docked, in order.
pub fn docked(robot: &Robot, tree: &Tree) -> Vec<(usize, usize)> {
    let mut all: Vec<(usize, usize)> = robot
        .held()
        .map(|(_, bond)| {
            let (a, b) = (tree.place[bond.a.shoe()], tree.place[bond.b.shoe()]);
            (a.min(b), a.max(b))
        })
        .collect();
    all.sort_unstable();
    all
}

/// The least distance of two balls that need not touch; infinite where there are none within `reach`.
pub fn least(tree: &Tree, docked: &[(usize, usize)], poses: &[Rigid], reach: f64) -> f64 {
    let mut least = f64::INFINITY;
    pairs(poses, reach, &mut |a, b, squared| {
        if squared < least && !touch_always(tree, a, b, docked) {
            least = squared;
        }
    });
    libm::sqrt(least)
}
