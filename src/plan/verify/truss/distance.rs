//! Distances between struts whose ends go straight on: proved between the samples. A distance changes no
//! faster than the ends move against each other, so from every sample it is known for how long it
//! lasts (conservative advancement).

use super::judge::Leg;
use crate::geometry::Vec3;
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
    let swept = |&(a, b): &(usize, usize)| {
        let all = [leg.from[a], leg.from[b], leg.to[a], leg.to[b]];
        let low = all.iter().skip(1).fold(all[0], |low, p| low.inf(p));
        let high = all.iter().skip(1).fold(all[0], |high, p| high.sup(p));
        (low, high)
    };
    let boxes: Vec<(Vec3, Vec3)> = paths.struts.iter().map(swept).collect();
    // Sorted by where they begin along x, those that a box can meet follow it.
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| boxes[i].0.x.total_cmp(&boxes[j].0.x).then(i.cmp(&j)));
    // Twice the clearance, so that a distance is told where nothing is nearer.
    let reach = 2.0 * clearance;
    let mut found = Vec::new();
    for (at, &i) in order.iter().enumerate() {
        for &j in order[at + 1..].iter().take_while(|&&j| boxes[j].0.x <= boxes[i].1.x + reach) {
            let meet = (1..3)
                .all(|k| boxes[i].0[k] <= boxes[j].1[k] + reach && boxes[j].0[k] <= boxes[i].1[k] + reach);
            if meet && !shares(i, j) {
                found.push(pair(paths, leg, (i.min(j), i.max(j)), clearance));
            }
        }
    }
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
        distance([at(a), at(b)], [at(c), at(d)])
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

/// Between two segments: inside both where they cross as seen along their common perpendicular, else
/// from an end.
fn distance(p: [Vec3; 2], q: [Vec3; 2]) -> f64 {
    let (u, v) = (p[1] - p[0], q[1] - q[0]);
    let normal = u.cross(&v);
    let ends = [to_segment(p[0], q), to_segment(p[1], q), to_segment(q[0], p), to_segment(q[1], p)];
    let least = ends.into_iter().fold(f64::INFINITY, f64::min);
    let area = normal.norm_squared();
    let apart = q[0] - p[0];
    // Where the lines are nearest, by Cramer's rule.
    let (s, t) = (apart.cross(&v).dot(&normal), apart.cross(&u).dot(&normal));
    let inside = |x: f64| 0.0 < x && x < area;
    if area > 0.0 && inside(s) && inside(t) {
        least.min(apart.dot(&normal).abs() / area.sqrt())
    } else {
        least
    }
}

fn to_segment(point: Vec3, [a, b]: [Vec3; 2]) -> f64 {
    let along = b - a;
    let length = along.norm_squared();
    let part = if length > 0.0 { ((point - a).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (point - a - along * part).norm()
}
