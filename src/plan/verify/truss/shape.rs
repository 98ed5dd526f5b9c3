//! The limits of a truss beside those of its struts: angles between struts that share a node, and sums of lengths.
//!
//! Angles (by conservative advancement) and sums (by bisection) are proved between the keyframes.

use super::judgement::{Judgement, Step};
use super::lengths;
use crate::geometry::Vec3;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, LengthSum};
use crate::units::{Dimension, quantity};

impl Judgement<'_> {
    /// Checks, against the limits of the plan, the angles between struts at their nodes and the sums of lengths on a
    /// step; a rigid roll changes none of them.
    pub(super) fn shape(&self, step: &Step, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear {
            return;
        }
        for corner in &self.corners {
            self.angle(step, corner, ledger);
        }
        for sum in &self.paths.limits.sums {
            self.sum(step, sum, ledger);
        }
    }

    /// Checks the angle between two struts at their common node, by conservative advancement.
    fn angle(&self, step: &Step, corner: &Corner, ledger: &mut Ledger) {
        let &Corner { node, ends: (p, q), struts: (i, j) } = corner;
        let limit = self.paths.limits.angle;
        let arm = |x: &[Vec3], end: usize| x[end] - x[node];
        let at = |end: usize, part: f64| arm(&step.from, end) * (1.0 - part) + arm(&step.to, end) * part;
        // A direction turns at most at the speed of its end over the least length.
        let turns = |end: usize| {
            let way = (arm(&step.to, end) - arm(&step.from, end)).norm();
            way / lengths::along(step, end, node).least.0.max(f64::MIN_POSITIVE)
        };
        // Advancement: the angle changes no faster than both directions turn.
        let speed = turns(p) + turns(q);
        let (mut part, mut least) = (0.0, (angle_between(at(p, 1.0), at(q, 1.0)), 1.0));
        let decided = self.samples.advance(|| {
            let found = angle_between(at(p, part), at(q, part));
            if found < least.0 {
                least = (found, part);
            }
            let spare = found - limit + self.tolerances.angle;
            let proved = spare >= 0.0 && (part >= 1.0 || spare >= speed * (1.0 - part));
            if proved || spare < 0.0 {
                return Some(proved);
            }
            part = (part + spare / speed).min(1.0);
            None
        });
        let time = step.time(least.1);
        let names = || vec![self.strut_name(i), self.strut_name(j)];
        keep_least(&mut ledger.verdict.angle, least.0, time, names);
        if decided == Some(true) {
            return;
        }
        let [found, wanted] = [least.0, limit].map(|x| quantity(x, Dimension::ANGLE));
        let (i, j) = (self.strut_name(i), self.strut_name(j));
        let message = if least.0 < limit {
            format!("the struts {i} and {j} come to an angle of {found}; the plan keeps {wanted}")
        } else {
            format!(
                "the angle between the struts {i} and {j} stays so near to {wanted} that it is not proved"
            )
        };
        let failure = self.failure(CheckKind::JointRange, time, names(), message);
        ledger.fail(Failure { value: least.0, limit, ..failure });
    }

    /// Checks a sum of lengths: on an interval it lies between the sums of the extremes of each length. Intervals
    /// are bisected until that proves the limits.
    fn sum(&self, step: &Step, sum: &LengthSum, ledger: &mut Ledger) {
        let lengths = |part: f64| -> f64 {
            let at = |node: usize| step.from[node] * (1.0 - part) + step.to[node] * part;
            let ends = sum.struts.iter().map(|&strut| self.struts[strut]);
            ends.map(|(a, b)| (at(a) - at(b)).norm()).sum()
        };
        let tolerance = self.tolerances.length_sum;
        let (low, high) = sum.range;
        let mut parts = vec![(0.0, 1.0)];
        let decided = self.samples.advance(|| {
            let Some((from, to)) = parts.pop() else { return Some(None) };
            let ends = [(lengths(from), from), (lengths(to), to)];
            let bad = ends.iter().find(|(length, _)| *length < low - tolerance || *length > high + tolerance);
            if bad.is_some() {
                return Some(bad.copied());
            }
            let least = |&strut: &usize| {
                let (a, b) = self.struts[strut];
                let across = |part: f64| {
                    let at = |node: usize| step.from[node] * (1.0 - part) + step.to[node] * part;
                    at(a) - at(b)
                };
                lengths::least(across(from), across(to)).0
            };
            // Lengths are convex, so their sum is greatest at an end.
            if sum.struts.iter().map(least).sum::<f64>() < low - tolerance {
                let middle = (from + to) / 2.0;
                parts.extend([(from, middle), (middle, to)]);
            }
            None
        });
        match decided {
            Some(None) => {}
            Some(Some(bad)) => self.sum_fails(step, sum, bad, ledger),
            None => self.sum_fails(step, sum, (lengths(0.5), 0.5), ledger),
        }
    }

    /// Records that a sum of lengths leaves its range.
    fn sum_fails(&self, step: &Step, sum: &LengthSum, (length, part): (f64, f64), ledger: &mut Ledger) {
        let names: Vec<String> = sum.struts.iter().map(|&strut| self.strut_name(strut)).collect();
        let [found, low, high] = [length, sum.range.0, sum.range.1].map(|x| quantity(x, Dimension::LENGTH));
        let what = match &names[..] {
            [one] => format!("the strut {one} would be {found} long"),
            _ => format!("the lengths of {} would add up to {found}", names.join(", ")),
        };
        let within = (sum.range.0..=sum.range.1).contains(&length);
        let message = if within {
            let names = names.join(", ");
            format!(
                "the lengths of {names} add up to so near to {low} that it is not proved that they keep it"
            )
        } else {
            format!("{what}; the plan keeps {low} to {high}")
        };
        let failure = self.failure(CheckKind::JointRange, step.time(part), names, message);
        let limit = if length < sum.range.0 { sum.range.0 } else { sum.range.1 };
        ledger.fail(Failure { value: length, limit, ..failure });
    }
}

/// A pair of struts that share a node.
pub(super) struct Corner {
    /// The index of the shared node.
    node: usize,
    /// The other node of each of the two struts.
    ends: (usize, usize),
    /// The indices of the two struts in the plan.
    struts: (usize, usize),
}

impl Corner {
    /// Returns the angle between the two struts with the nodes at `x` (m), rad, 0 to π.
    pub(super) fn angle(&self, x: &[Vec3]) -> f64 {
        let (p, q) = self.ends;
        angle_between(x[p] - x[self.node], x[q] - x[self.node])
    }
}

/// Returns all pairs of struts that share one of some nodes, ascending by the index of the node.
pub(super) fn corners(nodes: usize, struts: &[(usize, usize)]) -> Vec<Corner> {
    let mut at_node: Vec<Vec<(usize, usize)>> = vec![Vec::new(); nodes];
    for (strut, &(a, b)) in struts.iter().enumerate() {
        at_node[a].push((strut, b));
        at_node[b].push((strut, a));
    }
    let mut found = Vec::new();
    for (node, around) in at_node.iter().enumerate() {
        for (at, &(i, p)) in around.iter().enumerate() {
            found.extend(around[at + 1..].iter().map(|&(j, q)| Corner {
                node,
                ends: (p, q),
                struts: (i, j),
            }));
        }
    }
    found
}

/// Returns the angle between two vectors, rad, 0 to π, from the norms of the sum and the difference of unit vectors:
/// accurate for small angles, too (Kahan).
fn angle_between(u: Vec3, v: Vec3) -> f64 {
    let (u, v) = (u.normalize(), v.normalize());
    2.0 * libm::atan2((u - v).norm(), (u + v).norm())
}
