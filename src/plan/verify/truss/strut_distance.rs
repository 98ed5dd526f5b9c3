//! Distances between struts whose ends move on straight lines, by conservative advancement (Mirtich 1996): a
//! distance changes no faster than the ends move relative to each other, so each sample proves the clearance for
//! some time, and the next sample is taken when that time is over.

use super::judgement::{Judgement, Step};
use super::lengths;
use super::sample_budget::SampleBudget;
use crate::geometry::Vec3;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::closest_points::segment_segment_distance;

/// A pair of struts that come near each other on a step, with their least distance found.
pub(super) struct NearPair {
    /// The indices of the two struts in the plan, the lesser first.
    pub struts: (usize, usize),
    /// The least distance of the two struts at any sample, m.
    pub distance: f64,
    /// The time of that sample, as a part of the step: 0 at its start, 1 at its end.
    pub part: f64,
    /// True if the two struts are proved to keep the clearance during the whole step.
    pub holds: bool,
}

/// Returns the pairs of struts without a common node whose swept bounding boxes come within twice the `clearance` (m),
/// with the least distance found, ascending by their indices. [`NearPair::holds`] tells if conservative advancement
/// proves that a pair keeps the clearance less `tolerance` (m). `joining`: true if struts of nodes that are about to merge,
/// or have just split, keep it only outside of the reach of the joint.
pub(super) fn nearest(
    judgement: &Judgement,
    step: &Step,
    (clearance, tolerance): (f64, f64),
    joining: bool,
) -> Vec<NearPair> {
    let struts = &judgement.struts;
    let shares = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (struts[i], struts[j]);
        a == c || a == d || b == c || b == d
    };
    let swept = |&(a, b): &(usize, usize)| Aabb::around([step.from[a], step.from[b], step.to[a], step.to[b]]);
    let boxes: Vec<Aabb> = struts.iter().map(swept).collect();
    // A cell of the grid is as large as a box is in the mean.
    let sizes: f64 = boxes.iter().map(|swept| (swept.high - swept.low).max()).sum();
    let cell = sizes / boxes.len().max(1) as f64;
    // Twice the clearance, so that a distance is reported where nothing is nearer.
    let reach = 2.0 * clearance;
    let mut found = Vec::new();
    near_boxes(&boxes, reach, cell, |i, j| {
        if !shares(i, j) {
            let joint = if joining { judgement.joint(step, (i, j)) } else { None };
            let pair = Pair::new(struts[i], struts[j], joint.map(|ends| (ends, judgement.joint_reach())));
            found.push(near(step, ((i, j), &pair), (clearance, tolerance), &judgement.samples));
        }
    });
    found.sort_by_key(|near| near.struts);
    found
}

/// Two struts by their ends. Of two that are about to share a node, or have just done so, only what lies outside of the
/// reach of the joint is compared: each without its end there, and the whole of the other.
struct Pair {
    ends: [(usize, usize); 2],
    /// The reach of the joint, m, in which both struts begin with the ends stated first; `None` for struts that share no
    /// joint.
    reach: Option<f64>,
}

impl Pair {
    /// Returns the pair of two struts. `joint`: the ends at which they meet, and the reach of the joint, m.
    fn new(first: (usize, usize), second: (usize, usize), joint: Option<((usize, usize), f64)>) -> Pair {
        let from = |(a, b): (usize, usize), end: usize| if a == end { (a, b) } else { (b, a) };
        match joint {
            Some(((p, q), reach)) => Pair { ends: [from(first, p), from(second, q)], reach: Some(reach) },
            None => Pair { ends: [first, second], reach: None },
        }
    }

    /// Returns the distance of what is compared, with the nodes at these places, m.
    fn distance(&self, at: impl Fn(usize) -> Vec3) -> f64 {
        let [whole, other] = self.ends.map(|(a, b)| (at(a), at(b)));
        let Some(reach) = self.reach else { return segment_segment_distance(whole, other) };
        let outside = |(p, q): (Vec3, Vec3)| {
            let length = (q - p).norm();
            (if length > reach { p + (q - p) * (reach / length) } else { q }, q)
        };
        segment_segment_distance(outside(whole), other).min(segment_segment_distance(whole, outside(other)))
    }

    /// Returns a bound on how fast that distance changes, m for a whole step.
    fn speed(&self, step: &Step) -> f64 {
        let [(a, b), (c, d)] = self.ends;
        let way = |node: usize| step.to[node] - step.from[node];
        let speed = [(a, c), (a, d), (b, c), (b, d)].map(|(p, q)| (way(p) - way(q)).norm());
        let speed = speed.into_iter().fold(0.0, f64::max);
        // The place on a strut where the reach ends turns with it about its end.
        let Some(reach) = self.reach else { return speed };
        let turns = |(p, q): (usize, usize)| {
            let least = lengths::least(step.from[q] - step.from[p], step.to[q] - step.to[p]).0;
            reach * (way(q) - way(p)).norm() / least.max(reach)
        };
        speed + turns((a, b)) + turns((c, d))
    }
}

/// Advances along the step from sample to sample, each as far as the distance there proves the clearance. `pair`: two struts,
/// by their indices and by what is compared of them.
fn near(
    step: &Step,
    (struts, pair): ((usize, usize), &Pair),
    (clearance, tolerance): (f64, f64),
    samples: &SampleBudget,
) -> NearPair {
    let speed = pair.speed(step);
    let mut near = NearPair { struts, distance: f64::INFINITY, part: 0.0, holds: false };
    let mut part = 0.0;
    let apart = |part: f64| pair.distance(|node| step.from[node] + (step.to[node] - step.from[node]) * part);
    let end = apart(1.0);
    if end < near.distance {
        (near.distance, near.part) = (end, 1.0);
    }
    let decided = samples.advance(|| {
        let distance = apart(part);
        if distance < near.distance {
            (near.distance, near.part) = (distance, part);
        }
        let spare = distance - clearance + tolerance;
        if spare < 0.0 {
            return Some(false);
        }
        if part >= 1.0 || spare >= speed * (1.0 - part) {
            return Some(true);
        }
        part = (part + spare / speed).min(1.0);
        None
    });
    near.holds = decided.unwrap_or(false);
    near
}
