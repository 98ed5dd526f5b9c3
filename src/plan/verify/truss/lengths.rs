//! Lengths of struts whose ends move on straight lines: their squares are parabolas, so the extremes of lengths and
//! rates are known in closed form.

use super::judgement::Step;
use crate::geometry::Vec3;

/// The extremes of the length of one strut on a step, and of its rate.
pub(super) struct Lengths {
    /// The least length during the step, m, and the part of the step that is over then, 0 to 1.
    pub least: (f64, f64),
    /// The greatest length during the step, m, and the part of the step that is over then, 0 to 1.
    pub most: (f64, f64),
    /// A bound on the absolute rate of the length, m/s; attained where the rate of progress is constant.
    pub rate: f64,
    /// A bound on the absolute acceleration of the length, m/s².
    pub acceleration: f64,
    /// The rates of the length at the start and at the end of the step, m/s.
    pub rates: [f64; 2],
}

impl Lengths {
    /// Returns (length in m, part of the step) of the extreme length that is outside the range `low` to `high` (m) by more
    /// than `tolerance` (m): the least if that is too short, else the greatest; `None` if both are within.
    pub(super) fn outside(&self, (low, high): (f64, f64), tolerance: f64) -> Option<(f64, f64)> {
        let short = (self.least.0 < low - tolerance).then_some(self.least);
        short.or_else(|| (self.most.0 > high + tolerance).then_some(self.most))
    }

    /// Returns true if the greatest rate of the length exceeds `limit` (m/s) by more than the fraction `tolerance` of
    /// it.
    pub(super) fn too_fast(&self, limit: f64, tolerance: f64) -> bool {
        self.rate > limit * (1.0 + tolerance)
    }
}

/// Returns the extremes on a step for the strut between the nodes of the indices `a` and `b`, which move on straight
/// lines.
pub(super) fn along(step: &Step, a: usize, b: usize) -> Lengths {
    let (from, to) = (step.from[a] - step.from[b], step.to[a] - step.to[b]);
    let change = to - from;
    let (least, u) = least(from, to);
    let progress = step.progress();
    let (start, end) = (from.norm(), to.norm());
    let most = if start >= end { (start, 0.0) } else { (end, 1.0) };
    // A length along a straight line is convex, so its rate is greatest at an end. At a length of
    // nothing the rate is the whole speed.
    let rate = |d: &Vec3, length: f64| {
        if length > 0.0 { (change.dot(d) / length).abs() } else { change.norm() }
    };
    let rates = [rate(&from, start), rate(&to, end)];
    let fastest = rates[0].max(rates[1]);
    // The second derivative of a length by progress is h² c² / L³ with the distance h of the line from zero.
    let bend = if least > 0.0 {
        from.cross(&change).norm_squared() / (least * least * least)
    } else {
        f64::INFINITY
    };
    let bend = if fastest > 0.0 || bend.is_finite() { bend } else { 0.0 };
    let peak = progress.peak();
    let [up, down] = progress.accelerations();
    let slope = |d: &Vec3, length: f64| if length > 0.0 { change.dot(d) / length } else { 0.0 };
    Lengths {
        least: (least, u),
        most,
        rate: fastest * peak,
        acceleration: fastest * up.max(down) + bend * peak * peak,
        rates: [slope(&from, start) * progress.rate(0.0), slope(&to, end) * progress.rate(step.duration)],
    }
}

/// Returns (length, fraction): the least length of a vector that changes linearly from `from` to `to` (m), and the
/// fraction of the change, 0 to 1, at which it has that length.
pub(super) fn least(from: Vec3, to: Vec3) -> (f64, f64) {
    // |from + u change|² is least where its slope is zero.
    let change = to - from;
    let slope = change.norm_squared();
    let u = if slope > 0.0 { (-from.dot(&change) / slope).clamp(0.0, 1.0) } else { 0.0 };
    ((from + change * u).norm(), u)
}
