//! The checks of one step in closed form (lengths of struts and their rates, flat ground), those of distances
//! between struts, and the summary of a plan.

use super::judgement::{Judgement, Step};
use super::lengths::Lengths;
use super::support::StabilityMonitor;
use super::{lengths, strut_distance, support};
use crate::geometry::Vec3;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, ExemptionKind, Failure, Interpolation, Plan, Status, Worst};
use crate::units::{Dimension, quantity};

/// Returns true if an exemption of the plan excuses accelerations at a time, s.
fn excused(time: f64, ledger: &mut Ledger) -> bool {
    ledger.excuses(CheckKind::Acceleration, time, |kind| *kind == ExemptionKind::Acceleration)
}

impl Judgement<'_> {
    /// Checks the length of every strut, its rate and its acceleration on a step against the strut's range, speed and limit
    /// on acceleration, in closed form, and keeps the least speed margin. A rigid roll changes none. Returns the rates of the
    /// struts at the start and at the end, m/s; empty for a roll.
    pub(super) fn lengths(&self, step: &Step, ledger: &mut Ledger) -> [Vec<f64>; 2] {
        let mut rates = [Vec::new(), Vec::new()];
        if step.interpolation != Interpolation::Linear {
            return rates;
        }
        for (strut, &(a, b)) in self.struts.iter().enumerate() {
            let found = lengths::along(step, a, b);
            rates.iter_mut().zip(found.rates).for_each(|(rates, rate)| rates.push(rate));
            if let Some((length, part)) = found.outside(self.strut.length, self.tolerances.length) {
                let (low, high) = self.strut.length;
                let [length_, low_, high_] = [length, low, high].map(|x| quantity(x, Dimension::LENGTH));
                let message = format!(
                    "the strut {} would be {length_} long; a {} reaches from {low_} to {high_}",
                    self.strut_name(strut),
                    self.strut.name
                );
                let at = vec![self.strut_name(strut)];
                let failure = self.failure(CheckKind::JointRange, step.time(part), at, message);
                ledger.fail(Failure {
                    value: length,
                    limit: if length < low { low } else { high },
                    ..failure
                });
            }
            self.rates(strut, &found, step, ledger);
        }
        rates
    }

    /// Checks the bound on a strut's rate on a step against its speed, and that on its acceleration against its limit if it
    /// has one.
    fn rates(&self, strut: usize, found: &Lengths, step: &Step, ledger: &mut Ledger) {
        let margin = 1.0 - found.rate / self.strut.speed;
        keep_least(&mut ledger.verdict.speed_margin, margin, step.start, || vec![self.strut_name(strut)]);
        let failure = |kind: CheckKind, message: String, (value, limit): (f64, f64)| {
            let failure = self.failure(kind, step.start, vec![self.strut_name(strut)], message);
            Failure { value, limit, ..failure }
        };
        if found.too_fast(self.strut.speed, self.tolerances.rate) {
            let [rate, limit] = [found.rate, self.strut.speed].map(|x| quantity(x, Dimension::SPEED));
            let message =
                format!("the strut {} changes by {rate}; its limit is {limit}", self.strut_name(strut));
            ledger.fail(failure(CheckKind::Speed, message, (found.rate, self.strut.speed)));
        }
        let Some(limit) = self.strut.acceleration else { return };
        if found.acceleration > limit * (1.0 + self.tolerances.rate) && !excused(step.start, ledger) {
            let [value, most] = [found.acceleration, limit].map(|x| quantity(x, Dimension::ACCELERATION));
            let message =
                format!("the strut {} accelerates by {value}; its limit is {most}", self.strut_name(strut));
            ledger.fail(failure(CheckKind::Acceleration, message, (found.acceleration, limit)));
        }
    }

    /// Checks that the rate of no strut changes at once between two steps, where its acceleration is limited. `before`,
    /// `after`: those of the struts (m/s) at the end of the one and at the start of the next; none before the first and after
    /// the last, where the truss is at rest, and in rolls.
    pub(super) fn jumps(&self, (before, after): (&[f64], &[f64]), time: f64, ledger: &mut Ledger) {
        let Some(limit) = self.strut.acceleration else { return };
        let rate = |rates: &[f64], strut: usize| rates.get(strut).copied().unwrap_or(0.0);
        let changes =
            (0..self.struts.len()).map(|strut| ((rate(after, strut) - rate(before, strut)).abs(), strut));
        let Some((change, strut)) = changes.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        // A change belongs to the motion before it as to that after it.
        let is_excused = |ledger: &mut Ledger| excused(time, ledger) || excused(time.next_down(), ledger);
        if change > self.tolerances.jump && !is_excused(ledger) {
            let (name, change) = (self.strut_name(strut), quantity(change, Dimension::SPEED));
            let most = quantity(limit, Dimension::ACCELERATION);
            let message =
                format!("the strut {name} changes its speed at once, by {change}; it can do {most}");
            let failure = self.failure(CheckKind::Acceleration, time, vec![name], message);
            ledger.fail(Failure { value: f64::MAX, limit, ..failure });
        }
    }

    /// Checks that struts without a common node keep their clearance from each other on a step, and keeps the least
    /// distance found. A rigid roll does not change it. Struts of nodes that are about to merge, or have just split, keep it
    /// outside of the reach of the joint ([`joint`](Self::joint)).
    pub(super) fn distances(&self, step: &Step, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear {
            return;
        }
        let limits = (self.strut.clearance, self.tolerances.strut_distance);
        for near in strut_distance::nearest(self, step, limits, true) {
            let names = || vec![self.strut_name(near.struts.0), self.strut_name(near.struts.1)];
            let time = step.time(near.part);
            keep_least(&mut ledger.verdict.clearance, near.distance, time, names);
            if near.holds {
                continue;
            }
            let [distance, wanted] =
                [near.distance, self.strut.clearance].map(|x| quantity(x, Dimension::LENGTH));
            let (a, b) = (self.strut_name(near.struts.0), self.strut_name(near.struts.1));
            let name = &self.strut.name;
            let message = if near.distance < self.strut.clearance {
                format!("the struts {a} and {b} come within {distance}; a {name} keeps {wanted}")
            } else {
                format!(
                    "the struts {a} and {b} stay so near to {wanted} that it is not proved that they keep it"
                )
            };
            let failure = self.failure(CheckKind::Collision, time, names(), message);
            ledger.fail(Failure { value: near.distance, limit: self.strut.clearance, ..failure });
        }
    }

    /// Checks that no node goes into flat ground at height 0 on a step, or, where the ground is uneven, no node and
    /// no strut ([`uneven`](Self::uneven)).
    pub(super) fn ground(&self, step: &Step, ledger: &mut Ledger) {
        if let Some(terrain) = &self.paths.surroundings.terrain {
            return self.uneven(step, terrain, ledger);
        }
        let lowest = (0..step.from.len()).map(|node| (support::lowest(step, node), node));
        let Some(((height, part), node)) = lowest.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) else { return };
        if height < -self.tolerances.flat_ground {
            let name = self.node_name(node);
            let depth = quantity(-height, Dimension::LENGTH);
            let message = format!("the node {name} goes {depth} into the ground");
            let failure = self.failure(CheckKind::Ground, step.time(part), vec![name], message);
            ledger.fail(Failure { value: -height, ..failure });
        }
    }

    /// Records the displacement of the centre of mass (m), the rolls, the greatest slip of a node (m) and the status
    /// of every check. `travel`: the displacement of the centre of mass, m; `keyframes`: the number of keyframes.
    pub(super) fn summary(
        &self,
        (travel, keyframes): (Vec3, usize),
        standing: &StabilityMonitor,
        plan: &Plan,
        ledger: &mut Ledger,
    ) {
        ledger.verdict.travel = [travel.x, travel.y, travel.z];
        ledger.verdict.samples = keyframes;
        for (time, words) in &standing.events {
            ledger.verdict.events.push((*time, words.clone()));
        }
        let on_ground = plan.worlds.iter().any(|w| w.world.floor_bears());
        let stands = |status: Status| {
            if on_ground { status } else { Status::NotChecked("nothing pulls it down".into()) }
        };
        for kind in [CheckKind::Form, CheckKind::Collision, CheckKind::JointRange, CheckKind::Speed] {
            ledger.check(kind, Status::Proved);
        }
        ledger.check(CheckKind::Ground, stands(Status::Proved));
        ledger.check(CheckKind::Stability, stands(Status::Proved));
        let accelerates = self.strut.acceleration.map_or(Status::NoLimit, |_| Status::Proved);
        ledger.check(CheckKind::Acceleration, accelerates);
        if on_ground {
            let (slid, node) = standing.slid();
            ledger.verdict.slip = Some(Worst {
                value: slid,
                time: plan.body.duration(),
                at: vec![self.paths.node_names[node].clone()],
            });
            self.slip(standing, plan.body.duration(), ledger);
        }
    }

    /// Checks the distance that all nodes together slide over the ground, m, against the plan's limit.
    fn slip(&self, standing: &StabilityMonitor, time: f64, ledger: &mut Ledger) {
        let (slid, limit) = (standing.slid_in_all(), self.paths.limits.slip);
        if limit == 0.0 {
            return ledger.check(CheckKind::Slip, Status::NotChecked(standing.sliding()));
        }
        if slid > limit + self.tolerances.slip {
            let [found, wanted] = [slid, limit].map(|way| quantity(way, Dimension::LENGTH));
            let message =
                format!("its nodes slide {found} over the ground, all together; the plan keeps {wanted}");
            let at = vec![self.paths.node_names[standing.slid().1].clone()];
            let failure = self.failure(CheckKind::Slip, time, at, message);
            ledger.fail(Failure { value: slid, limit, ..failure });
        }
        ledger.check(CheckKind::Slip, Status::Proved);
    }
}
