//! What a truss passes on the way of a step, while every node goes straight on: solids and the ground. A
//! certificate, as of what is [`between`](super::between) its struts.

use super::bound::{Bound, DIP, POINTS};
use super::structure::{ROUNDING, Structure};
use crate::geometry::Vec3;

/// Distances to obstacles that fall short by more than half a cushion between x and y, with by how much, m.
pub fn obstacles(truss: &Structure, x: &[Vec3], y: &[Vec3], cushion: f64) -> Vec<(Bound, f64)> {
    let mut found = Vec::new();
    for strut in 0..truss.struts.len() {
        let (from, to) = (truss.segment(x, strut), truss.segment(y, strut));
        let way = (to.0 - from.0, to.1 - from.1);
        let reach = truss.clearance + cushion + way.0.norm().max(way.1.norm());
        for part in (0..truss.around.parts.len()).filter(|&part| truss.around.may_meet(from, part, reach)) {
            if let Some(lack) = meets(truss, from, way, part, cushion) {
                found.extend([0, 1].map(|end| (Bound::Clear(strut, part, end), lack)));
            }
        }
    }
    found
}

/// A part stays behind the plane through its nearest point, and each end of a strut comes evenly nearer to
/// that plane: until one is too near, the strut is not.
fn meets(truss: &Structure, from: (Vec3, Vec3), way: (Vec3, Vec3), part: usize, cushion: f64) -> Option<f64> {
    let fastest = way.0.norm().max(way.1.norm());
    let at = |t: f64| {
        let ends = (from.0 + way.0 * t, from.1 + way.1 * t);
        (ends, truss.around.nearness(ends, part, truss.clearance + cushion + fastest * (1.0 - t)))
    };
    let (_, last) = at(1.0);
    if last.distance < truss.clearance {
        return Some(truss.clearance - last.distance);
    }
    let mut t = 0.0;
    loop {
        let (ends, nearest) = at(t);
        if nearest.distance < truss.clearance - cushion / 2.0 {
            return Some(truss.clearance - nearest.distance);
        }
        let ahead = [ends.0, ends.1].map(|end| end.dot(&nearest.normal));
        let farthest = ahead[0].max(ahead[1]);
        let lasts = [(ahead[0], way.0), (ahead[1], way.1)].map(|(at, way)| {
            let spare = nearest.distance + farthest - at - truss.clearance + cushion;
            spare / way.dot(&nearest.normal).max(f64::MIN_POSITIVE)
        });
        t += lasts[0].min(lasts[1]);
        if t >= 1.0 {
            return None;
        }
    }
}

/// Nodes and struts that get below uneven ground between x and y, with how deep, m.
pub fn ground(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<(Bound, f64)> {
    let Some(terrain) = &truss.around.terrain else { return Vec::new() };
    let nodes = (0..truss.nodes).filter_map(|node| {
        let (_, height) = terrain.lowest(x[node], y[node]);
        (height < -ROUNDING * truss.unit).then_some((Bound::Above(node), -height))
    });
    let struts = (0..truss.struts.len()).filter_map(|strut| {
        let (part, depth) = dip(truss, truss.segment(x, strut), truss.segment(y, strut))?;
        let point = (libm::round(part * POINTS as f64) as usize).clamp(1, POINTS - 1);
        Some((Bound::Over(strut, point), depth))
    });
    nodes.chain(struts).collect()
}

/// Where along a strut it dips too far into the ground, and by how much, m.
fn dip(truss: &Structure, from: (Vec3, Vec3), to: (Vec3, Vec3)) -> Option<(f64, f64)> {
    let terrain = truss.around.terrain.as_ref()?;
    let left = DIP * truss.unit;
    let falls = |way: Vec3| -way.z + truss.around.steepest * libm::hypot(way.x, way.y);
    let way = (to.0 - from.0, to.1 - from.1);
    let rate = falls(way.0).max(falls(way.1)).max(f64::MIN_POSITIVE);
    let lowest_end = [from.0.z, from.1.z, to.0.z, to.1.z].into_iter().fold(f64::INFINITY, f64::min);
    if lowest_end + truss.around.sink > truss.around.highest {
        return None;
    }
    let (part, height) = terrain.lowest(to.0, to.1);
    if height + truss.around.sink < left {
        return Some((part, left - height - truss.around.sink));
    }
    let mut t = 0.0;
    while t < 1.0 {
        let (part, height) = terrain.lowest(from.0 + way.0 * t, from.1 + way.1 * t);
        let spare = height + truss.around.sink;
        if spare < left / 2.0 {
            return Some((part, left - spare));
        }
        t += spare / rate;
    }
    None
}
