//! The broad phase of collision checking: pairs of balls that are near each other, by sort and sweep over a
//! grid of cubes.

use super::robot::Robot;
use super::tree::Tree;
use crate::geometry::{RigidTransform, Vec3};

/// Calls `found` with every pair of indices whose balls are nearer than `reach` (pitches), the smaller index
/// first, and with the squared distance of their centres.
///
/// Balls are sorted by cubes of that size, in columns along z. The three cubes of a column that may hold a
/// ball's neighbours are one stretch of the list, and for each of the columns around it that stretch moves on
/// as the balls do. So the time is that of a sort, for balls of bounded density.
pub fn pairs(poses: &[RigidTransform], reach: f64, found: &mut dyn FnMut(usize, usize, f64)) {
    let cube = |x: f64| (libm::floor(x / reach) as i64 + CUBES_HALF) as u64;
    let key = |p: &Vec3| cube(p.x) * COLUMN * COLUMN + cube(p.y) * COLUMN + cube(p.z);
    let mut order: Vec<(u64, u32)> =
        poses.iter().enumerate().map(|(index, pose)| (key(&pose.translation), index as u32)).collect();
    order.sort_unstable();
    let sorted: Vec<Vec3> = order.iter().map(|(_, index)| poses[*index as usize].translation).collect();
    let mut test = |i: usize, j: usize| {
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
            test(i, j);
        }
        for (first, column) in first.iter_mut().zip(columns) {
            while *first < order.len() && order[*first].0 < here + column - 1 {
                *first += 1;
            }
            for (j, (there, _)) in order.iter().enumerate().skip(*first) {
                if *there > here + column + 1 {
                    break;
                }
                test(i, j);
            }
        }
    }
}

/// Number of cubes along each axis; coordinates are counted from the middle, so a robot may be 2²⁰ cubes wide.
const COLUMN: u64 = 1 << 21;
/// Half of that number.
const CUBES_HALF: i64 = 1 << 20;

/// Returns true if two shoes, given by index, are of one module or docked to each other: then their balls touch
/// at all times.
pub fn always_touch(tree: &Tree, a: usize, b: usize, docked: &[(usize, usize)]) -> bool {
    tree.shoe[a] / 2 == tree.shoe[b] / 2 || docked.binary_search(&(a.min(b), a.max(b))).is_ok()
}

/// Returns the pairs of indices whose shoes are docked to each other, the smaller first, in order.
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

/// Returns the least distance in pitches of the centres of two balls that do not touch by design; infinite if
/// there are none nearer than `reach`.
pub fn least_distance(tree: &Tree, docked: &[(usize, usize)], poses: &[RigidTransform], reach: f64) -> f64 {
    let mut least = f64::INFINITY;
    pairs(poses, reach, &mut |a, b, squared| {
        if squared < least && !always_touch(tree, a, b, docked) {
            least = squared;
        }
    });
    libm::sqrt(least)
}
