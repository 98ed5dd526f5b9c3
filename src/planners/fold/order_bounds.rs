//! Lower bounds on the energy of other orders than leaves first, without gravity.
//!
//! A hinge spends `3.75 |φ| K` on a face that it carries, where K is the moment of inertia of the face about the
//! line of the hinge, in the pose that the face has when the hinge folds. Seen from the hinge, that pose depends
//! only on which of the hinges between the two have folded before. So the energy of a layout in any order is a
//! sum over its faces, and what a face adds is no less than its cheapest path with the least K at each hinge:
//! over all poses in any order, and over the level pose alone where the root folds first.
//!
//! The paths of a face are enumerated upwards from the face, to a depth that bounds the number of poses. From
//! there on a hinge spends no less than the least moment of inertia of the face about any line, so the rest of a
//! path costs no less than that by the least sum of angles on the way to the root.

use super::inertia::{Body, Inertia, moment_in};
use super::kinematics::about;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::QUINTIC;
use crate::geometry::{Pose, Vec3};

/// The greatest number of poses of faces over which moments of inertia are computed: some tenths of a second.
const POSES_MAX: usize = 1 << 20;

/// The orders of folding for which a lower bound holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orders {
    /// The orders in which a hinge folds after all hinges that it carries.
    LeavesFirst,
    /// The orders in which a hinge folds before all hinges that it carries.
    RootFirst,
    /// All orders of the hinges, without restriction.
    Any,
}

impl Orders {
    /// Returns the factor by which the number of poses of a face grows with each hinge of its path.
    fn growth(self) -> usize {
        match self {
            Orders::LeavesFirst | Orders::RootFirst => 1,
            Orders::Any => 2,
        }
    }

    /// Returns the poses that a face may have seen from the next hinge, from those seen from this one; `level` is the
    /// rotation that opens this one.
    fn next(self, poses: &[Pose], level: &Pose) -> Vec<Pose> {
        match self {
            Orders::LeavesFirst => poses.to_vec(),
            Orders::RootFirst => poses.iter().map(|pose| level * pose).collect(),
            Orders::Any => poses.iter().flat_map(|pose| [level * pose, *pose]).collect(),
        }
    }
}

/// Returns for each root, by face, the lower bound on the energy of all layouts in these orders, N·m for steps of one
/// second; `masses`: by face, kg; `inertia`: how the mass of a panel is spread.
pub(super) fn energies(target: &Target, masses: &[f64], inertia: Inertia, orders: Orders) -> Vec<f64> {
    let faces = masses.len();
    let angles = least_angles(target);
    let depth = depth(target, orders);
    let mut sums = vec![0.0; faces];
    for (goal, &mass) in masses.iter().enumerate() {
        crate::interrupt::checkpoint();
        let mut search = PathSearch {
            target,
            corners: target.corners(goal),
            mass,
            inertia,
            orders,
            depth,
            on_path: vec![false; faces],
            least: vec![f64::INFINITY; faces],
            cut: vec![f64::INFINITY; faces],
        };
        search.extend_path(goal, 0, &[Pose::identity()], 0.0);
        let slope = QUINTIC * least_moment(search.corners, mass, inertia);
        let cut = || search.cut.iter().enumerate().filter(|(_, cost)| cost.is_finite());
        for (root, sum) in sums.iter_mut().enumerate() {
            let beyond = cut().map(|(face, cost)| cost + slope * angles[face][root]);
            *sum += beyond.fold(search.least[root], f64::min);
        }
    }
    sums
}

/// Returns the number of hinges up to which paths are enumerated, at least one.
fn depth(target: &Target, orders: Orders) -> usize {
    let faces = target.faces.len();
    // A triangle has three neighbours, and every one after it two that the path has not passed.
    let growth = 2 * orders.growth();
    let within = |depth: &usize| growth.checked_pow(*depth as u32).is_some_and(|n| n <= POSES_MAX / faces);
    let of_triangles = (1..faces.max(2)).take_while(within).last().unwrap_or(1);
    if target.faces.iter().all(|face| face.len() == 3) {
        return of_triangles;
    }
    // From other faces more ways lead on: their poses are counted.
    (1..=of_triangles).rev().find(|depth| has_few_poses(target, orders, *depth)).unwrap_or(1)
}

/// Returns true if the paths of at most so many hinges have at most [`POSES_MAX`] poses in all.
fn has_few_poses(target: &Target, orders: Orders, depth: usize) -> bool {
    let mut left = POSES_MAX;
    let mut on_path = vec![false; target.faces.len()];
    (0..target.faces.len()).all(|face| {
        crate::interrupt::checkpoint();
        count_poses(target, orders, face, depth, 1, &mut on_path, &mut left)
    })
}

/// Counts down the poses of the paths that go on from a face by at most `hinges` hinges, at the first of which there are
/// `poses`; returns false once there are none left.
fn count_poses(
    target: &Target,
    orders: Orders,
    face: usize,
    hinges: usize,
    poses: usize,
    on_path: &mut [bool],
    left: &mut usize,
) -> bool {
    if hinges == 0 {
        return true;
    }
    on_path[face] = true;
    let is_within = target.around(face).all(|(_, other)| {
        if on_path[other] {
            return true;
        }
        *left = left.saturating_sub(poses);
        *left > 0 && count_poses(target, orders, other, hinges - 1, poses * orders.growth(), on_path, left)
    });
    on_path[face] = false;
    is_within
}

/// Returns by pair of faces the least sum of absolute fold angles on a path between them, rad (Floyd-Warshall).
fn least_angles(target: &Target) -> Vec<Vec<f64>> {
    let faces = target.faces.len();
    let mut angles = vec![vec![f64::INFINITY; faces]; faces];
    angles.iter_mut().enumerate().for_each(|(face, row)| row[face] = 0.0);
    for hinge in &target.hinges {
        let ([a, b], angle) = (hinge.faces, hinge.angle.abs());
        let least = angles[a][b].min(angle);
        (angles[a][b], angles[b][a]) = (least, least);
    }
    for by in 0..faces {
        crate::interrupt::checkpoint();
        let onwards = angles[by].clone();
        for row in &mut angles {
            let before = row[by];
            row.iter_mut().zip(&onwards).for_each(|(sum, onwards)| *sum = sum.min(before + onwards));
        }
    }
    angles
}

/// Returns the least moment of inertia of a panel about any line, kg·m².
fn least_moment(corners: &[Vec3], mass: f64, inertia: Inertia) -> f64 {
    let moments = Body::of_panel(corners, mass, inertia).inertia.symmetric_eigenvalues();
    moments.min().max(0.0) * (1.0 - TOLERANCES.moment)
}

/// The enumeration of the paths from one face upwards.
struct PathSearch<'t> {
    target: &'t Target,
    corners: &'t [Vec3],
    mass: f64,
    inertia: Inertia,
    orders: Orders,
    /// The greatest number of hinges on a path.
    depth: usize,
    on_path: Vec<bool>,
    /// For each face: the least cost of the paths that end there.
    least: Vec<f64>,
    /// For each face: the least cost of the paths that were cut off there.
    cut: Vec<f64>,
}

impl PathSearch<'_> {
    /// Extends a path of `hinges` hinges that ends at the face `end` by one hinge; `poses`: those that the path's face
    /// may have seen from that hinge; `cost`: the least cost of the path, N·m for steps of one second.
    fn extend_path(&mut self, end: usize, hinges: usize, poses: &[Pose], cost: f64) {
        self.least[end] = self.least[end].min(cost);
        if hinges == self.depth {
            self.cut[end] = self.cut[end].min(cost);
            return;
        }
        self.on_path[end] = true;
        let target = self.target;
        for (index, parent) in target.around(end) {
            if self.on_path[parent] {
                continue;
            }
            let hinge = &target.hinges[index];
            let axis = hinge.axis_from(parent);
            let moment =
                |pose: &Pose| moment_in(pose, self.corners, self.mass, self.inertia, &hinge.point, &axis);
            let least = poses.iter().map(moment).fold(f64::INFINITY, f64::min);
            let next = self.orders.next(poses, &about(&hinge.point, axis, -hinge.angle));
            self.extend_path(parent, hinges + 1, &next, cost + QUINTIC * hinge.angle.abs() * least);
        }
        self.on_path[end] = false;
    }
}
