//! Distances between struts whose ends move on straight lines, by conservative advancement (Mirtich 1996): a
//! distance changes no faster than the ends move relative to each other, so each sample proves the clearance for
//! some time, and the next sample is taken when that time is over.

use super::judgement::Step;
use super::sample_budget::SampleBudget;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::closest_points::segment_segment_distance;
use crate::plan::NodePaths;

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
/// proves that a pair keeps the clearance less `tolerance` (m).
pub(super) fn nearest(
    paths: &NodePaths,
    step: &Step,
    (clearance, tolerance): (f64, f64),
    samples: &SampleBudget,
) -> Vec<NearPair> {
    let shares = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (paths.struts[i], paths.struts[j]);
        a == c || a == d || b == c || b == d
    };
    let swept = |&(a, b): &(usize, usize)| Aabb::around([step.from[a], step.from[b], step.to[a], step.to[b]]);
    let boxes: Vec<Aabb> = paths.struts.iter().map(swept).collect();
    // A cell of the grid is as large as a box is in the mean.
    let sizes: f64 = boxes.iter().map(|swept| (swept.high - swept.low).max()).sum();
    let cell = sizes / boxes.len().max(1) as f64;
    // Twice the clearance, so that a distance is reported where nothing is nearer.
    let reach = 2.0 * clearance;
    let mut found = Vec::new();
    near_boxes(&boxes, reach, cell, |i, j| {
        if !shares(i, j) {
            found.push(pair(paths, step, (i, j), (clearance, tolerance), samples));
        }
    });
    found.sort_by_key(|near| near.struts);
    found
}

/// Advances along the step from sample to sample, each as far as the distance there proves the clearance.
fn pair(
    paths: &NodePaths,
    step: &Step,
    struts: (usize, usize),
    (clearance, tolerance): (f64, f64),
    samples: &SampleBudget,
) -> NearPair {
    let ((a, b), (c, d)) = (paths.struts[struts.0], paths.struts[struts.1]);
    let way = |node: usize| step.to[node] - step.from[node];
    let speed = [(a, c), (a, d), (b, c), (b, d)].map(|(p, q)| (way(p) - way(q)).norm());
    let speed = speed.into_iter().fold(0.0, f64::max);
    let mut near = NearPair { struts, distance: f64::INFINITY, part: 0.0, holds: false };
    let mut part = 0.0;
    let apart = |part: f64| {
        let at = |node: usize| step.from[node] + way(node) * part;
        segment_segment_distance((at(a), at(b)), (at(c), at(d)))
    };
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
