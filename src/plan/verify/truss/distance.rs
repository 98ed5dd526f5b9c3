//! Distances between struts whose ends go straight on: proved between the samples. A distance changes no
//! faster than the ends move against each other, so from every sample it is known for how long it
//! lasts (conservative advancement).

use super::judge::Leg;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::closest_points::segment_segment_distance;
use crate::plan::NodePaths;

/// A distance may be less than the clearance by this much: rounding, m.
const TOL_DISTANCE: f64 = 1e-9;
/// Samples of one pair on one leg. A pair that stays at its clearance needs many.
const SAMPLES_MAX: usize = 100_000;

/// Two struts near each other.
pub struct Near {
    pub struts: (usize, usize),
    /// The least distance that was seen, m, and when, as a part of the leg.
    pub distance: f64,
    pub part: f64,
    /// Whether they are proved to keep the clearance.
    pub holds: bool,
}

/// The pairs that come near each other, or too near.
pub fn nearest(paths: &NodePaths, leg: &Leg, clearance: f64) -> Vec<Near> {
    let shares = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (paths.struts[i], paths.struts[j]);
        a == c || a == d || b == c || b == d
    };
    let swept = |&(a, b): &(usize, usize)| Aabb::around([leg.from[a], leg.from[b], leg.to[a], leg.to[b]]);
    let boxes: Vec<Aabb> = paths.struts.iter().map(swept).collect();
    // A cell of the grid is as large as a box is in the mean.
    let sizes: f64 = boxes.iter().map(|swept| (swept.high - swept.low).max()).sum();
    let cell = sizes / boxes.len().max(1) as f64;
    // Twice the clearance, so that a distance is told where nothing is nearer.
    let reach = 2.0 * clearance;
    let mut found = Vec::new();
    near_boxes(&boxes, reach, cell, &mut |i, j| {
        if !shares(i, j) {
            found.push(pair(paths, leg, (i, j), clearance));
        }
    });
    found.sort_by_key(|near| near.struts);
    found
}

fn pair(paths: &NodePaths, leg: &Leg, struts: (usize, usize), clearance: f64) -> Near {
    let ((a, b), (c, d)) = (paths.struts[struts.0], paths.struts[struts.1]);
    let way = |node: usize| leg.to[node] - leg.from[node];
    let speed = [(a, c), (a, d), (b, c), (b, d)].map(|(p, q)| (way(p) - way(q)).norm());
    let speed = speed.into_iter().fold(0.0, f64::max);
    let mut near = Near { struts, distance: f64::INFINITY, part: 0.0, holds: false };
    let mut part = 0.0;
    let apart = |part: f64| {
        let at = |node: usize| leg.from[node] + way(node) * part;
        segment_segment_distance((at(a), at(b)), (at(c), at(d)))
    };
    let end = apart(1.0);
    if end < near.distance {
        (near.distance, near.part) = (end, 1.0);
    }
    for _ in 0..SAMPLES_MAX {
        let distance = apart(part);
        if distance < near.distance {
            (near.distance, near.part) = (distance, part);
        }
        let spare = distance - clearance + TOL_DISTANCE;
        if spare < 0.0 {
            return near;
        }
        if part >= 1.0 || spare >= speed * (1.0 - part) {
            near.holds = true;
            return near;
        }
        part = (part + spare / speed).min(1.0);
    }
    near
}
