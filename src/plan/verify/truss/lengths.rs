//! Lengths of struts whose ends go straight on: their squares are parabolas, so the extremes of lengths
//! and rates are known in closed form.

use super::judge::Leg;

/// Rounding of lengths, m.
const TOL_LENGTH: f64 = 1e-9;
/// Rounding of rates, relative.
const TOL_RATE: f64 = 1e-9;

pub struct Lengths {
    /// The least and the greatest length with their times, m and s.
    pub least: (f64, f64),
    pub most: (f64, f64),
    /// The greatest rate, m/s.
    pub rate: f64,
}

impl Lengths {
    /// A length outside of a range, with its time.
    pub fn outside(&self, (low, high): (f64, f64)) -> Option<(f64, f64)> {
        let short = (self.least.0 < low - TOL_LENGTH).then_some(self.least);
        short.or_else(|| (self.most.0 > high + TOL_LENGTH).then_some(self.most))
    }

    pub fn too_fast(&self, limit: f64) -> bool {
        self.rate > limit * (1.0 + TOL_RATE)
    }
}

/// Of the strut between nodes a and b.
pub fn along(leg: &Leg, a: usize, b: usize) -> Lengths {
    let (from, to) = (leg.from[a] - leg.from[b], leg.to[a] - leg.to[b]);
    let change = to - from;
    // |from + u change|² is least where its slope is zero.
    let slope = change.norm_squared();
    let u = if slope > 0.0 { (-from.dot(&change) / slope).clamp(0.0, 1.0) } else { 0.0 };
    let time = |u: f64| leg.begins + u * leg.lasts;
    let (start, end) = (from.norm(), to.norm());
    let most = if start >= end { (start, time(0.0)) } else { (end, time(1.0)) };
    // A length along a straight line is convex, so its rate is greatest at an end. At a length of
    // nothing the rate is the whole speed.
    let rate = |d: &crate::geometry::Vec3, length: f64| {
        if length > 0.0 { (change.dot(d) / length).abs() } else { change.norm() }
    };
    let rate = rate(&from, start).max(rate(&to, end)) / leg.lasts;
    Lengths { least: ((from + change * u).norm(), time(u)), most, rate }
}
