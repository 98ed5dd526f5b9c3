//! Pairs of balls that are near each other.

use super::robot::Robot;
use super::tree::Tree;
use crate::geometry::{RigidTransform, Vec3};

/// Calls `found` for every pair of places whose balls are nearer than `reach`, the smaller first.
///
/// Balls are sorted into cubes of that size, cubes into columns, and columns by their places: so the three
/// cubes of a column that may hold a ball's neighbours are one stretch of the list, and for each of
/// the columns around the stretch goes on as the balls do.
pub fn pairs(poses: &[RigidTransform], reach: f64, found: &mut dyn FnMut(usize, usize, f64)) {
    let cube = |x: f64| (libm::floor(x / reach) as i64 + CUBES_HALF) as u64;
    let key = |p: &Vec3| cube(p.x) * COLUMN * COLUMN + cube(p.y) * COLUMN + cube(p.z);
    let mut order: Vec<(u64, u32)> =
        poses.iter().enumerate().map(|(place, pose)| (key(&pose.translation), place as u32)).collect();
    order.sort_unstable();
    let sorted: Vec<Vec3> = order.iter().map(|(_, place)| poses[*place as usize].translation).collect();
    let mut see = |i: usize, j: usize| {
        let squared = (sorted[j] - sorted[i]).norm_squared();
        if squared < reach * reach {
            let (a, b) = (order[i].1 as usize, order[j].1 as usize);
            found(a.min(b), a.max(b), squared);
        }
    };
    let columns = [COLUMN, COLUMN * COLUMN - COLUMN, COLUMN * COLUMN, COLUMN * COLUMN + COLUMN];
    let mut first = [0; 4];
    for (i, (here, _)) in order.iter().enumerate() {
        for (j, (there, _)) in order.iter().enumerate().skip(i + 1) {
            if *there > here + 1 {
                break;
            }
            see(i, j);
        }
        for (first, column) in first.iter_mut().zip(columns) {
            while *first < order.len() && order[*first].0 < here + column - 1 {
                *first += 1;
            }
            for (j, (there, _)) in order.iter().enumerate().skip(*first) {
                if *there > here + column + 1 {
                    break;
                }
                see(i, j);
            }
        }
    }
}

/// Cubes are counted from the middle of so many in every direction, which is farther than robots reach.
const COLUMN: u64 = 1 << 21;
const CUBES_HALF: i64 = 1 << 20;

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
pub fn least(tree: &Tree, docked: &[(usize, usize)], poses: &[RigidTransform], reach: f64) -> f64 {
    let mut least = f64::INFINITY;
    pairs(poses, reach, &mut |a, b, squared| {
        if squared < least && !touch_always(tree, a, b, docked) {
            least = squared;
        }
    });
    libm::sqrt(least)
}
