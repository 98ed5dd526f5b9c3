//! Conservative advancement of a step against obstacles and uneven ground, while every node moves linearly:
//! the same certificate as [`advancement`](super::advancement) gives between struts.

use super::constraint::{Constraint, SAMPLES};
use super::structure::Structure;
use crate::geometry::Vec3;

/// Returns the obstacle constraints that fall short by more than half of `margin`, m, somewhere while the nodes move
/// linearly from x to y, m, as (constraint, shortfall in m); both ends of a strut get one.
pub(super) fn obstacle_violations(
    truss: &Structure,
    x: &[Vec3],
    y: &[Vec3],
    margin: f64,
) -> Vec<(Constraint, f64)> {
    let mut found = Vec::new();
    for strut in 0..truss.struts.len() {
        let (from, to) = (truss.segment(x, strut), truss.segment(y, strut));
        let moved = (to.0 - from.0, to.1 - from.1);
        let reach = truss.clearance + margin + moved.0.norm().max(moved.1.norm());
        let parts = 0..truss.surroundings.parts.len();
        for part in parts.filter(|&part| truss.surroundings.may_collide(from, part, reach)) {
            if let Some(lack) = obstacle_shortfall(truss, from, moved, part, margin) {
                found.extend([0, 1].map(|end| (Constraint::ObstacleClearance(strut, part, end), lack)));
            }
        }
    }
    found
}

/// Returns the shortfall of the clearance of a strut from a part, m; `None` if there is none. The part stays behind
/// the plane through its closest point, and each end of the strut approaches that plane at a constant rate:
/// until the first end uses up the distance, the strut keeps it.
fn obstacle_shortfall(
    truss: &Structure,
    from: (Vec3, Vec3),
    moved: (Vec3, Vec3),
    part: usize,
    margin: f64,
) -> Option<f64> {
    let fastest = moved.0.norm().max(moved.1.norm());
    let at = |t: f64| {
        let ends = (from.0 + moved.0 * t, from.1 + moved.1 * t);
        let enough = truss.clearance + margin + fastest * (1.0 - t);
        (ends, truss.surroundings.signed_distance(ends, part, enough))
    };
    let (_, last) = at(1.0);
    if last.distance < truss.clearance {
        return Some(truss.clearance - last.distance);
    }
    let mut t = 0.0;
    loop {
        let (ends, nearest) = at(t);
        if nearest.distance < truss.clearance - margin / 2.0 {
            return Some(truss.clearance - nearest.distance);
        }
        let ahead = [ends.0, ends.1].map(|end| end.dot(&nearest.normal));
        let farthest = ahead[0].max(ahead[1]);
        let safe_times = [(ahead[0], moved.0), (ahead[1], moved.1)].map(|(at, moved)| {
            let spare = nearest.distance + farthest - at - truss.clearance + margin;
            spare / moved.dot(&nearest.normal).max(f64::MIN_POSITIVE)
        });
        t += safe_times[0].min(safe_times[1]);
        if t >= 1.0 {
            return None;
        }
    }
}

/// Returns the constraints of nodes and struts that get too far below uneven ground somewhere while the nodes move
/// linearly from x to y, m, as (constraint, depth in m); none on flat ground, where the ends of the step decide.
pub(super) fn ground_violations(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<(Constraint, f64)> {
    let Some(terrain) = &truss.surroundings.terrain else { return Vec::new() };
    let nodes = (0..truss.nodes).filter_map(|node| {
        let (_, height) = terrain.lowest(x[node], y[node]);
        let below = height < -truss.tolerances.rounding * truss.unit;
        below.then_some((Constraint::NodeHeight(node), -height))
    });
    let struts = (0..truss.struts.len()).filter_map(|strut| {
        let (along, depth) = strut_shortfall(truss, truss.segment(x, strut), truss.segment(y, strut))?;
        let sample = (libm::round(along * SAMPLES as f64) as usize).clamp(1, SAMPLES - 1);
        Some((Constraint::StrutHeight(strut, sample), depth))
    });
    nodes.chain(struts).collect()
}

/// Returns the parameter along a strut at which it gets too far below the ground, and the shortfall, m; `None` if it
/// does not. Its height changes no faster than its ends sink, plus the steepest slope times their horizontal speed.
fn strut_shortfall(truss: &Structure, from: (Vec3, Vec3), to: (Vec3, Vec3)) -> Option<(f64, f64)> {
    let around = &truss.surroundings;
    let terrain = around.terrain.as_ref()?;
    let margin = truss.tolerances.ground_margin * truss.unit;
    let sink_rate = |moved: Vec3| -moved.z + around.slope_max * libm::hypot(moved.x, moved.y);
    let moved = (to.0 - from.0, to.1 - from.1);
    let rate = sink_rate(moved.0).max(sink_rate(moved.1)).max(f64::MIN_POSITIVE);
    let lowest_end = [from.0.z, from.1.z, to.0.z, to.1.z].into_iter().fold(f64::INFINITY, f64::min);
    if lowest_end + around.sink_depth > around.height_max {
        return None;
    }
    let (along, height) = terrain.lowest(to.0, to.1);
    if height + around.sink_depth < margin {
        return Some((along, margin - height - around.sink_depth));
    }
    let mut t = 0.0;
    while t < 1.0 {
        let (along, height) = terrain.lowest(from.0 + moved.0 * t, from.1 + moved.1 * t);
        let spare = height + around.sink_depth;
        if spare < margin / 2.0 {
            return Some((along, margin - spare));
        }
        t += spare / rate;
    }
    None
}
