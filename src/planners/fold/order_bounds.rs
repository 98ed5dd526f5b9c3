//! Lower bounds on the energy of other orders than leaves first, without gravity.
//!
//! A hinge spends `3.75 |φ| K` on a face that it carries, where K is the moment of inertia of the face about the
//! line of the hinge, in the pose that the face has when the hinge folds. Seen from the hinge, that pose depends
//! only on which of the hinges between the two have folded before. So the energy of a layout in any order is a
//! sum over its faces, and what a face adds is no less than the cheapest path from it to the root with the cheapest order
//! of the hinges on that path.
//!
//! Proof: let `e_1` (at the face), ..., `e_k` (at the root) be the hinges of the face's path in some layout. Of two hinges
//! on one path one folds before the other, so the order of folding orders `e_1`, ..., `e_k`. The pose at `e_i` is that of the set
//! `S_i` of those among `e_1`, ..., `e_(i-1)` that come before `e_i`, and `S_i` follows from the order of `e_1`, ..., `e_i` alone. So
//! `Σ 3.75 |φ_i| K(e_i | S_i)` is one of the sums over which the minimum is taken. The minima of all faces come to no more
//! than the energy, whatever layout and order the faces share. ∎
//!
//! Of long paths only the order of the first [`WINDOW`] hinges is kept: at a hinge beyond, each hinge after those has
//! folded or not as is cheapest. That allows more than orders do, so it is a bound as well.
//!
//! A face may have any pose when another hinge than its own turns, if hinges may stop on their way. Its own sees it in
//! one pose only, each other spends on it no less than its least moment of inertia about any line costs, and all turns
//! of a hinge come to its fold angle at least. So the least sum over a path holds for these, too.
//!
//! Paths are searched upwards from the face, the cheapest first (Dijkstra 1959), so the first that comes to a root is the
//! cheapest to it. The rest of a path that is open when the work ends costs no less than the least moment of inertia of
//! the face about any line by the least sum of angles on the way to the root. Faces that are equal by symmetry are
//! searched once: over the faces of an orbit the costs to one root come to as many as those from one face to the roots of an
//! orbit, but for the sizes of the two orbits.

use super::inertia::{Body, Inertia, moment_in};
use super::kinematics::about;
use super::symmetry;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::{QUINTIC, Weights};
use crate::geometry::{Pose, Vec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The greatest work of all searches: poses of faces, orders of hinges and faces of paths that are looked at. Some tenths
/// of a second.
const WORK_MAX: usize = 1 << 21;

/// The number of hinges from the face on whose order is kept. With one more there are seven times as many orders, and the
/// icosahedron's bound rises by 2 %.
const WINDOW: usize = 6;

/// The orders of folding for which a lower bound holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orders {
    /// The orders in which a hinge folds after all hinges that it carries.
    LeavesFirst,
    /// The orders in which a hinge folds before all hinges that it carries.
    RootFirst,
    /// All orders of the hinges, without restriction.
    Any,
    /// All orders of turns of the hinges, each of which may stop on its way and go on later.
    WithStops,
}

impl Orders {
    /// Returns the number of poses that a face may have after so many hinges.
    fn poses(self, hinges: usize) -> usize {
        match self {
            Orders::LeavesFirst | Orders::RootFirst | Orders::WithStops => 1,
            Orders::Any => {
                u32::try_from(hinges).ok().and_then(|h| 1_usize.checked_shl(h)).unwrap_or(usize::MAX)
            }
        }
    }

    /// Returns the number of hinges from the face on whose order is kept, of a path of so many.
    fn window(self, hinges: usize) -> usize {
        if self == Orders::Any { hinges.min(WINDOW) } else { 0 }
    }

    /// Extends the poses that a face may have seen from one hinge to those seen from the next; `level` is the rotation that
    /// opens the one. In any order, bit i of the number of a pose says whether hinge i of the path has folded.
    fn extend(self, poses: &mut Vec<Pose>, level: &Pose) {
        if self == Orders::LeavesFirst {
            return;
        }
        let folded = if self == Orders::Any { poses.clone() } else { Vec::new() };
        poses.iter_mut().for_each(|pose| *pose = level * *pose);
        poses.extend(folded);
    }
}

/// Returns for each root, by face, the lower bound on the energy of all layouts in these orders, N·m for steps of one
/// second; `masses`: by face, kg; `inertia`: how the mass of a panel is spread; `weights`: the costs with the leaves first,
/// which say what faces are equal.
pub(super) fn energies(
    target: &Target,
    weights: &Weights,
    masses: &[f64],
    inertia: Inertia,
    orders: Orders,
) -> Vec<f64> {
    let faces = masses.len();
    let orbits = symmetry::orbits(target, weights);
    let mut sizes = vec![0.0; faces];
    orbits.iter().for_each(|orbit| sizes[*orbit] += 1.0);
    let angles = least_angles(target);
    let goals: Vec<usize> = (0..faces).filter(|face| orbits[*face] == *face).collect();
    let mut sums = vec![0.0; faces];
    let mut work_left = WORK_MAX;
    for (done, &goal) in goals.iter().enumerate() {
        crate::interrupt::checkpoint();
        let corners = target.corners(goal);
        let mut share = work_left / (goals.len() - done);
        work_left -= share;
        let search = PathSearch { target, angles: &angles, corners, mass: masses[goal], inertia, orders };
        let costs = match orders {
            Orders::WithStops => search.own_hinge_costs(goal, weights),
            _ => search.least_costs(goal, &mut share),
        };
        work_left += share;
        let mut by_orbit = vec![0.0; faces];
        orbits.iter().zip(costs).for_each(|(orbit, cost)| by_orbit[*orbit] += cost);
        for (sum, &orbit) in sums.iter_mut().zip(&orbits) {
            *sum += by_orbit[orbit] * sizes[goal] / sizes[orbit];
        }
    }
    // Faces are equal up to rounding.
    sums.into_iter().map(|sum| sum * (1.0 - TOLERANCES.symmetry)).collect()
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

/// The search for the cheapest paths from one face upwards.
struct PathSearch<'t> {
    target: &'t Target,
    /// The least sums of angles between two faces, rad.
    angles: &'t [Vec<f64>],
    corners: &'t [Vec3],
    mass: f64,
    inertia: Inertia,
    orders: Orders,
}

/// A path from a face upwards.
struct OpenPath {
    /// The least cost of all orders, N·m for steps of one second.
    cost: f64,
    /// The number of the path, by which those of equal cost are ordered.
    number: usize,
    /// The faces of the path, from that at which it begins to the one up to which it leads.
    faces: Vec<usize>,
    /// The hinges between these.
    hinges: Vec<usize>,
    /// The orders of the first hinges, each with its cost.
    orders: Vec<HingeOrder>,
}

/// An order of the first hinges of a path.
#[derive(Clone, Copy)]
struct HingeOrder {
    /// The hinges by their place on the path, in the order in which they fold.
    order: [u8; WINDOW],
    /// The least cost of the path in this order, N·m for steps of one second.
    cost: f64,
}

impl HingeOrder {
    /// Returns the order of one hinge more, the last of `count + 1`, which takes this place.
    fn with(&self, count: usize, place: usize, cost: f64) -> HingeOrder {
        let mut order = self.order;
        order.copy_within(place..count, place + 1);
        order[place] = count as u8;
        HingeOrder { order, cost }
    }
}

impl PathSearch<'_> {
    /// Returns for each root, by face, the least cost of a path to it, or a lower bound on that where the work ends;
    /// `work_left` counts down.
    fn least_costs(&self, goal: usize, work_left: &mut usize) -> Vec<f64> {
        let mut least = vec![f64::INFINITY; self.target.faces.len()];
        let mut unsettled = least.len();
        let start = HingeOrder { order: [0; WINDOW], cost: 0.0 };
        let first =
            OpenPath { cost: 0.0, number: 0, faces: vec![goal], hinges: Vec::new(), orders: vec![start] };
        let (mut open, mut count) = (BinaryHeap::from([first]), 1);
        while let Some(path) = open.pop() {
            let end = path.end();
            if least[end].is_infinite() {
                least[end] = path.cost;
                unsettled -= 1;
            }
            if unsettled == 0 {
                return least;
            }
            let onward = self.target.around(end).filter(|(_, face)| !path.faces.contains(face));
            let onward: Vec<(usize, usize)> = onward.collect();
            if onward.is_empty() {
                continue;
            }
            let each =
                self.orders.poses(path.hinges.len()).saturating_add(path.orders.len() + path.faces.len());
            let Some(left) = work_left.checked_sub(each.saturating_mul(onward.len())) else {
                open.push(path);
                break;
            };
            *work_left = left;
            let poses = self.poses(&path);
            for (hinge, parent) in onward {
                open.push(self.extended(&path, &poses, hinge, parent, count));
                count += 1;
            }
        }
        // Every path to a root that was not reached goes on from an open one.
        let slope = QUINTIC * least_moment(self.corners, self.mass, self.inertia);
        for path in &open {
            let angles = &self.angles[path.end()];
            for (cost, angle) in least.iter_mut().zip(angles).filter(|(cost, _)| **cost > path.cost) {
                *cost = cost.min(path.cost + slope * angle);
            }
        }
        least
    }

    /// Returns for each root, by face, a lower bound on the cost of a path to it on which hinges may stop: that of the
    /// face's own hinge, which sees it in one pose, and beyond it the least moment of inertia by the least sum of angles.
    fn own_hinge_costs(&self, goal: usize, weights: &Weights) -> Vec<f64> {
        let slope = QUINTIC * least_moment(self.corners, self.mass, self.inertia);
        let cost = |root: usize| {
            let over =
                |(hinge, parent): (usize, usize)| weights.at(hinge, goal) + slope * self.angles[parent][root];
            self.target.around(goal).map(over).fold(f64::INFINITY, f64::min)
        };
        (0..self.angles.len()).map(|root| if root == goal { 0.0 } else { cost(root) }).collect()
    }

    /// Returns the poses of the face that the hinge after a path may see.
    fn poses(&self, path: &OpenPath) -> Vec<Pose> {
        let mut poses = vec![Pose::identity()];
        for (&hinge, &parent) in path.hinges.iter().zip(&path.faces[1..]) {
            let hinge = &self.target.hinges[hinge];
            self.orders.extend(&mut poses, &about(&hinge.point, hinge.axis_from(parent), -hinge.angle));
        }
        poses
    }

    /// Returns a path with one more hinge, to the face `parent`; `poses`: those that this hinge may see.
    fn extended(
        &self,
        path: &OpenPath,
        poses: &[Pose],
        hinge: usize,
        parent: usize,
        number: usize,
    ) -> OpenPath {
        let line = &self.target.hinges[hinge];
        let axis = line.axis_from(parent);
        let count = path.hinges.len();
        let window = self.orders.window(count);
        // The least cost of the hinge by the set of the first hinges that have folded, as a number in bits.
        let mut by_set = vec![f64::INFINITY; 1 << window];
        for (pose, number) in poses.iter().zip(0..) {
            let moment = moment_in(pose, self.corners, self.mass, self.inertia, &line.point, &axis);
            let least: &mut f64 = &mut by_set[number & ((1 << window) - 1)];
            *least = least.min(QUINTIC * line.angle.abs() * moment);
        }
        let mut orders = Vec::new();
        for known in &path.orders {
            let mut folded = 0;
            let mut least = f64::INFINITY;
            for place in 0..=window {
                let cost = known.cost + by_set[folded];
                least = least.min(cost);
                if self.orders.window(count + 1) > window {
                    orders.push(known.with(count, place, cost));
                }
                if place < window {
                    folded |= 1 << known.order[place];
                }
            }
            if self.orders.window(count + 1) == window {
                orders.push(HingeOrder { cost: least, ..*known });
            }
        }
        let cost = orders.iter().map(|order| order.cost).fold(f64::INFINITY, f64::min);
        let (mut faces, mut hinges) = (path.faces.clone(), path.hinges.clone());
        faces.push(parent);
        hinges.push(hinge);
        OpenPath { cost, number, faces, hinges, orders }
    }
}

impl OpenPath {
    /// Returns the face up to which the path leads.
    fn end(&self) -> usize {
        self.faces[self.faces.len() - 1]
    }
}

impl PartialEq for OpenPath {
    fn eq(&self, other: &OpenPath) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for OpenPath {}

impl PartialOrd for OpenPath {
    fn partial_cmp(&self, other: &OpenPath) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The cheapest path comes first in a [`BinaryHeap`].
impl Ord for OpenPath {
    fn cmp(&self, other: &OpenPath) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.number.cmp(&self.number))
    }
}
