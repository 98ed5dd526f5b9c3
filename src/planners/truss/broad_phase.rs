//! Broad phase: pairs of struts that may come too near, by a uniform grid over their bounding boxes and a
//! neighbour list with a skin (Verlet) that serves several steps. Of the n² pairs of a truss of n struts
//! few are near each other, and few of those come nearer.

use super::structure::Structure;
use crate::geometry::Vec3;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::closest_points::{SegmentPair, segment_segment};

/// Default skin of the neighbour list, units: it is rebuilt when a node has moved this far beside the mean
/// motion of all.
const SKIN: f64 = 0.3;

/// Neighbour list: all pairs of struts without a common node that can come nearer than the clearance while
/// no node is farther than `skin` (m) from where it was, each with a lower bound on its distance.
#[derive(Clone, Debug)]
pub(super) struct NeighbourList {
    pairs: Vec<Pair>,
    skin: f64,
    /// Positions of the nodes when the list was made, and now, m.
    first: Vec<Vec3>,
    now: Vec<Vec3>,
}

/// A pair of struts that may come too near while the nodes move linearly.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearPair {
    /// The indices of the struts, the lesser first.
    pub struts: (usize, usize),
    /// The distance at the start of the motion, m, and the unit vector from the second strut's closest point to the first's there.
    pub start: (f64, Vec3),
    /// The distance at its end, m.
    pub end: f64,
}

/// A pair of struts of the list.
#[derive(Clone, Debug)]
struct Pair {
    struts: (usize, usize),
    /// A lower bound on the distance, m, and true if it is the present distance, but for the error of
    /// [`segment_segment`] with nearly parallel struts.
    apart: f64,
    exact: bool,
    /// The unit vector from the second strut's closest point to the first's; valid where `exact`.
    normal: Vec3,
}

impl Pair {
    /// Returns the distance with the nodes at `x`, m, which is kept.
    fn distance(&mut self, truss: &Structure, x: &[Vec3]) -> f64 {
        if !self.exact {
            let nearest = segment_segment(truss.segment(x, self.struts.0), truss.segment(x, self.struts.1));
            (self.apart, self.normal, self.exact) = (nearest.distance, nearest.normal, true);
        }
        self.apart
    }

    /// Returns the pair if the struts may come too near while the nodes move linearly from x, where the pair is known exactly, to y,
    /// both in m: where neither the direction in which they are nearest at the start nor that at the end separates them at both
    /// ends, and thus throughout.
    fn nearing(&self, truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Option<NearPair> {
        let (i, j) = self.struts;
        // The thickness of the slab between the struts along a direction.
        let thickness = |z: &[Vec3], normal: &Vec3| {
            let along = |(p, q): (Vec3, Vec3)| (p.dot(normal), q.dot(normal));
            let (first, second) = (along(truss.segment(z, i)), along(truss.segment(z, j)));
            first.0.min(first.1) - second.0.max(second.1)
        };
        if self.apart >= truss.clearance && thickness(y, &self.normal) >= truss.clearance {
            return None;
        }
        let SegmentPair { distance: end, normal, .. } =
            segment_segment(truss.segment(y, i), truss.segment(y, j));
        if end >= truss.clearance && thickness(x, &normal) >= truss.clearance {
            return None;
        }
        Some(NearPair { struts: self.struts, start: (self.apart, self.normal), end })
    }
}

impl NeighbourList {
    /// Makes the list with a skin of at least `wanted`, m.
    fn new(truss: &Structure, x: &[Vec3], wanted: f64) -> NeighbourList {
        let skin = wanted.max(SKIN * truss.unit);
        let pairs = pairs(truss, x, truss.clearance + 2.0 * skin);
        let pair = |(i, j, apart)| Pair { struts: (i, j), apart, exact: false, normal: Vec3::z() };
        let pairs = pairs.into_iter().map(pair).collect();
        NeighbourList { pairs, skin, first: x.to_vec(), now: x.to_vec() }
    }

    /// Returns the pairs of struts that may come nearer than the clearance plus `more`, m, while the nodes move linearly from x to y, m,
    /// but for those of which is known that they keep the clearance. `known`: the neighbour list of earlier calls; reuses it if it still
    /// covers the motion, else rebuilds it.
    pub(super) fn candidates(
        known: &mut Option<NeighbourList>,
        truss: &Structure,
        (x, y): (&[Vec3], &[Vec3]),
        more: f64,
    ) -> Vec<NearPair> {
        let still =
            known.take().filter(|known| known.now == x && farthest(&known.first, y) + more <= known.skin);
        let nearby =
            known.insert(still.unwrap_or_else(|| NeighbourList::new(truss, x, farthest(x, y) + more)));
        let reach = reach(truss, x, y);
        let mut found = Vec::new();
        for pair in &mut nearby.pairs {
            let (i, j) = pair.struts;
            let limit = truss.clearance + more + reach[i] + reach[j];
            if pair.apart < limit && pair.distance(truss, x) < limit {
                found.extend(pair.nearing(truss, x, y));
            }
        }
        found
    }

    /// Returns the least distance of two struts without a common node, m, with the nodes at `x`, m; infinite where all are at least
    /// twice the clearance apart. `known`: the neighbour list of earlier calls; reuses it if it still covers these positions, else
    /// rebuilds it.
    pub(super) fn least_distance(known: &mut Option<NeighbourList>, truss: &Structure, x: &[Vec3]) -> f64 {
        let still = known.take().filter(|known| farthest(&known.first, x) + truss.clearance <= known.skin);
        let nearby = known.insert(match still {
            Some(mut still) => {
                still.moved(truss, x);
                still
            }
            None => NeighbourList::new(truss, x, truss.clearance),
        });
        let limit = 2.0 * truss.clearance;
        let near = nearby.pairs.iter_mut().filter(|pair| pair.apart < limit);
        near.map(|pair| pair.distance(truss, x)).filter(|apart| *apart < limit).fold(f64::INFINITY, f64::min)
    }

    /// Lowers the bounds on distances in the list by what the nodes moved against their mean, now that they are at `y`
    /// (m, by index), which must be within the skin of where the list was made.
    pub(super) fn moved(&mut self, truss: &Structure, y: &[Vec3]) {
        if self.now == y {
            return;
        }
        let reach = reach(truss, &self.now, y);
        for pair in &mut self.pairs {
            pair.apart -= reach[pair.struts.0] + reach[pair.struts.1];
            pair.exact = false;
        }
        self.now.copy_from_slice(y);
    }
}

/// Returns for each strut a bound on the displacement of its points relative to the mean of all nodes, m.
fn reach(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<f64> {
    let moved: Vec<f64> = moved(x, y).collect();
    truss.struts.iter().map(|&(a, b)| moved[a].max(moved[b])).collect()
}

/// Returns the greatest displacement of a node relative to the mean of all, m.
fn farthest(x: &[Vec3], y: &[Vec3]) -> f64 {
    moved(x, y).fold(0.0, f64::max)
}

/// Returns the displacement of each node minus the mean displacement, which brings no strut nearer to
/// another, m.
fn moved(x: &[Vec3], y: &[Vec3]) -> impl Iterator<Item = f64> {
    let mean = x.iter().zip(y).map(|(p, q)| q - p).sum::<Vec3>() / x.len().max(1) as f64;
    x.iter().zip(y).map(move |(p, q)| (q - p - mean).norm())
}

/// Returns the pairs of struts without a common node whose bounding boxes, with the nodes at `x`, are within `reach`
/// of each other, as (index, index, distance): the lesser index first, and the distance between the boxes; both
/// lengths in m.
fn pairs(truss: &Structure, x: &[Vec3], reach: f64) -> Vec<(usize, usize, f64)> {
    let ends = |strut| -> [Vec3; 2] { truss.segment(x, strut).into() };
    let boxes: Vec<Aabb> = (0..truss.struts.len()).map(|strut| Aabb::around(ends(strut))).collect();
    let mut found = Vec::new();
    near_boxes(&boxes, reach, truss.unit, |i, j| {
        let squared = boxes[i].gap(&boxes[j]).norm_squared();
        if squared < reach * reach && !truss.share_node(i, j) {
            found.push((i, j, squared.sqrt()));
        }
    });
    found
}
