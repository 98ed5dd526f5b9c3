//! Motion bounds of pairs of clusters of balls: until when two clusters are surely apart, from the distance of their
//! bounding spheres and the fastest that joints let them approach each other (conservative advancement, Mirtich 1996, over
//! clusters of the kinematic tree as in Lotan, Schwarzer, Halperin and Latombe 2002).
//!
//! A cluster is a contiguous range of the tree's order, and falls into two halves. The speed of a ball, seen from any of
//! its ancestors, is at most the sum over the joints between them of rate times arm, where an arm is no longer than the path
//! along the tree. Two clusters are seen from the last common ancestor of all their balls. A pair of clusters is examined
//! only in the step of the motion up to which it was known to be apart, and split into pairs of halves where the bound does
//! not keep it apart for the whole step. So balls that move with each other, and far ones, cost next to nothing.

use super::motion_check::Scene;
use super::tree::Tree;
use crate::geometry::{RigidTransform, Vec3};

/// The distance of centres, in pitches, from which on two balls are surely apart: that of balls that touch, and what the
/// straight lines may be off by on which balls go in a step.
const APART: f64 = 1.001;

/// The growth of the radius of a cluster, relative to the radius and a pitch, from which on it is measured anew.
const GROWTH_MAX: f64 = 0.125;

/// The part of a cluster whose balls are of several rigid parts.
const SEVERAL: usize = usize::MAX;

/// The pairs of clusters of a robot during a straight motion in joint space, each with the time until which it is apart.
pub(super) struct ClusterPairs<'a> {
    scene: &'a Scene<'a>,
    /// The rigid part of each ball, by index in the tree's order.
    parts: &'a [usize],
    /// The bound on the speed of each ball, as it follows from these sums over its ancestors.
    reaches: Vec<Reach>,
    /// The clusters: the first is that of all balls, and each is followed by its first half with all that this falls into,
    /// then by its second half.
    clusters: Vec<Cluster>,
    /// The pairs whose balls may meet, in no particular order.
    pairs: Vec<ClusterPair>,
    /// The last common ancestors of balls.
    ancestors: Ancestors,
}

/// Sums over the joints between the root and a ball, in the motion from time 0 to time 1.
#[derive(Clone, Copy, Default)]
struct Reach {
    /// The number of steps of the tree from the root to the ball.
    depth: f64,
    /// The sum of the angles by which joints turn, rad.
    turns: f64,
    /// The sum of these angles times the depth at which they turn, rad.
    moments: f64,
}

/// A contiguous range of balls in the tree's order.
#[derive(Clone, Copy)]
struct Cluster {
    from: u32,
    to: u32,
    /// The rigid part of all balls; [`SEVERAL`] if they are not of one part.
    part: usize,
    /// The greatest depth and turns of a ball.
    depth: f64,
    turns: f64,
    /// A bound on the rate at which a ball parts from the one in the middle, in pitches per duration of the motion.
    growth: f64,
    /// The radius of the sphere around the ball in the middle that held all at a time, in pitches.
    radius: f64,
    /// The time of the radius; not a number before it is first measured.
    at: f64,
}

/// Two clusters, or one with itself, by their indices; the balls of `a` come before those of `b`.
#[derive(Clone, Copy)]
struct ClusterPair {
    /// The time until which all their balls are apart.
    until: f64,
    a: u32,
    b: u32,
    /// A bound on the rate at which two of their balls approach each other, in pitches per duration of the motion.
    rate: f64,
}

impl<'a> ClusterPairs<'a> {
    /// Returns the pairs at the start of the motion from `from` to `to` (rad, by module). `parts`: the rigid parts of the
    /// robot during the motion, as by [`Tree::parts`].
    pub(super) fn new(
        scene: &'a Scene<'a>,
        parts: &'a [usize],
        from: &[[f64; 3]],
        to: &[[f64; 3]],
    ) -> ClusterPairs<'a> {
        let reaches = reaches(scene.tree, from, to);
        let mut clusters = Vec::with_capacity(2 * parts.len());
        let ancestors = Ancestors::new(scene.tree);
        halve(&mut clusters, (&ancestors, parts, &reaches), (0, parts.len()));
        let whole = ClusterPair { until: 0.0, a: 0, b: 0, rate: f64::INFINITY };
        ClusterPairs { scene, parts, reaches, clusters, pairs: vec![whole], ancestors }
    }

    /// Returns true if two balls that may meet come nearer than `apart` (pitches, less than [`APART`]) in the step of the
    /// motion between two times, while all balls go straight from their first poses to the second, and on to the third.
    /// Steps must follow each other.
    pub(super) fn overlap(
        &mut self,
        (since, until): (f64, f64),
        poses: [&[RigidTransform]; 3],
        apart: f64,
    ) -> bool {
        let mut next = 0;
        while let Some(&pair) = self.pairs.get(next) {
            if pair.until >= until {
                next += 1;
                continue;
            }
            let [a, b] = [pair.a, pair.b].map(|index| self.clusters[index as usize]);
            let single = a.to - a.from == 1 && b.to - b.from == 1;
            let distance = if pair.a == pair.b {
                0.0
            } else if single {
                let (i, j) = (a.from as usize, b.from as usize);
                if is_nearer(i, j, poses, apart) {
                    return true;
                }
                (poses[0][j].translation - poses[0][i].translation).norm()
            } else {
                let radii = [pair.a, pair.b].map(|index| self.radius(index, since, poses[0]));
                let [x, y] = [a, b].map(|cluster| poses[0][cluster.middle()].translation);
                (y - x).norm() - radii[0] - radii[1]
            };
            let safe = since + (distance - APART).max(0.0) / pair.rate;
            if safe >= until || single {
                // Two balls were examined for the whole step.
                self.pairs[next].until = safe.max(until);
                next += 1;
                continue;
            }
            self.pairs.swap_remove(next);
            if pair.a == pair.b {
                let [left, right] = self.halves(pair.a);
                self.open(left, left);
                self.open(left, right);
                self.open(right, right);
            } else if a.to - a.from >= b.to - b.from {
                self.halves(pair.a).into_iter().for_each(|half| self.open(half, pair.b));
            } else {
                self.halves(pair.b).into_iter().for_each(|half| self.open(pair.a, half));
            }
        }
        false
    }

    /// Returns the two halves of a cluster of several balls.
    fn halves(&self, cluster: u32) -> [u32; 2] {
        let Cluster { from, to, .. } = self.clusters[cluster as usize];
        let first = to - from - (to - from) / 2;
        [cluster + 1, cluster + 2 * first]
    }

    /// Adds a pair of clusters, unless none of their balls can meet.
    fn open(&mut self, a: u32, b: u32) {
        let [x, y] = [a, b].map(|index| &self.clusters[index as usize]);
        let (first, last) = (x.from as usize, y.to as usize - 1);
        let one_part = x.part == y.part && x.part != SEVERAL;
        let single = x.to - x.from == 1 && y.to - y.from == 1;
        if one_part || (single && !self.scene.may_meet(self.parts, first, last)) {
            return;
        }
        let seen_from = self.reaches[self.ancestors.last(first, last)];
        let rate = if a == b {
            f64::INFINITY
        } else if single {
            self.reaches[first].speed(&seen_from) + self.reaches[last].speed(&seen_from)
        } else {
            x.speed(&seen_from) + y.speed(&seen_from)
        };
        self.pairs.push(ClusterPair { until: 0.0, rate, a, b });
    }

    /// Returns the radius of a sphere around the ball in the middle of a cluster that holds the centres of all its balls
    /// at a time, in pitches. `poses`: those at that time.
    fn radius(&mut self, index: u32, time: f64, poses: &[RigidTransform]) -> f64 {
        let cluster = &mut self.clusters[index as usize];
        let grown = cluster.growth * (time - cluster.at);
        if grown <= GROWTH_MAX * (1.0 + cluster.radius) {
            return cluster.radius + grown;
        }
        let centre = poses[cluster.middle()].translation;
        let balls = &poses[cluster.from as usize..cluster.to as usize];
        let squared = balls.iter().map(|pose| (pose.translation - centre).norm_squared()).fold(0.0, f64::max);
        (cluster.radius, cluster.at) = (libm::sqrt(squared), time);
        cluster.radius
    }
}

impl Cluster {
    /// Returns the index of the ball in the middle.
    fn middle(&self) -> usize {
        ((self.from + self.to) / 2) as usize
    }

    /// Returns a bound on the speed of its balls as seen from a common ancestor, in pitches per duration of the motion.
    fn speed(&self, from: &Reach) -> f64 {
        (self.depth - from.depth + 1.0) * (self.turns - from.turns)
    }
}

/// The last common ancestors of all pairs of balls: the parent of the least deep ball after the first, up to the second,
/// from a sparse table of range minima (Bender and Farach-Colton 2000).
struct Ancestors {
    /// For each power of two, from one on, and each index: the least index of a parent of as many balls from there.
    least: Vec<Vec<u32>>,
}

impl Ancestors {
    fn new(tree: &Tree) -> Ancestors {
        let mut least = vec![tree.parent.iter().map(|parent| *parent as u32).collect::<Vec<u32>>()];
        while 2 << (least.len() - 1) <= tree.shoes() {
            let (before, apart) = (&least[least.len() - 1], 1 << (least.len() - 1));
            let next = before.iter().zip(&before[apart..]).map(|(a, b)| *a.min(b)).collect();
            least.push(next);
        }
        Ancestors { least }
    }

    /// Returns the index of the last common ancestor of two balls and of all between them in the tree's order; the first
    /// must not come after the second.
    fn last(&self, first: usize, second: usize) -> usize {
        let Some(level) = (second - first).checked_ilog2() else { return first };
        let level = level as usize;
        let least = &self.least[level];
        least[first + 1].min(least[second + 1 - (1 << level)]) as usize
    }
}

impl Reach {
    /// Returns a bound on the speed of the ball as seen from an ancestor, in pitches per duration of the motion.
    fn speed(&self, from: &Reach) -> f64 {
        (self.depth + 1.0) * (self.turns - from.turns) - (self.moments - from.moments)
    }
}

/// Returns the sums of each ball, by index in the tree's order.
fn reaches(tree: &Tree, from: &[[f64; 3]], to: &[[f64; 3]]) -> Vec<Reach> {
    let mut reaches = vec![Reach::default(); tree.shoes()];
    for index in 1..tree.shoes() {
        let before = reaches[tree.parent[index]];
        let turned = tree.joints_at(index).map(|j| (to[j.module][j.joint] - from[j.module][j.joint]).abs());
        let (depth, turned) = (before.depth + 1.0, turned.sum::<f64>());
        reaches[index] =
            Reach { depth, turns: before.turns + turned, moments: before.moments + depth * turned };
    }
    reaches
}

/// Appends the cluster of a range of balls and all clusters into which it falls; returns its index.
fn halve(
    clusters: &mut Vec<Cluster>,
    scene @ (ancestors, parts, reaches): (&Ancestors, &[usize], &[Reach]),
    (from, to): (usize, usize),
) -> usize {
    let (part, Reach { depth, turns, .. }) = (parts[from], reaches[from]);
    let index = clusters.len();
    let (growth, radius, at) = (0.0, 0.0, 0.0);
    clusters.push(Cluster { from: from as u32, to: to as u32, part, depth, turns, growth, radius, at });
    if to - from > 1 {
        let middle = to - (to - from) / 2;
        let [a, b] = [(from, middle), (middle, to)].map(|range| halve(clusters, scene, range));
        let (a, b) = (clusters[a], clusters[b]);
        let whole = &mut clusters[index];
        whole.part = if a.part == b.part { a.part } else { SEVERAL };
        (whole.depth, whole.turns) = (a.depth.max(b.depth), a.turns.max(b.turns));
        whole.growth = 2.0 * whole.speed(&reaches[ancestors.last(from, to - 1)]);
        whole.at = f64::NAN;
    }
    index
}

/// Returns true if two balls come nearer than `apart` while they go straight from their first poses to the second, or from
/// there to the third.
fn is_nearer(a: usize, b: usize, poses: [&[RigidTransform]; 3], apart: f64) -> bool {
    let [r0, r1, r2] = poses.map(|poses| poses[b].translation - poses[a].translation);
    [(r0, r1), (r1, r2)].iter().any(|(r, s)| least_squared_length(r, &(s - r)) < apart * apart)
}

/// Returns the least squared length of `r + s·d` for s in [0, 1].
fn least_squared_length(r: &Vec3, d: &Vec3) -> f64 {
    let along = d.norm_squared();
    let s = if along > 0.0 { (-r.dot(d) / along).clamp(0.0, 1.0) } else { 0.0 };
    (r + d * s).norm_squared()
}
