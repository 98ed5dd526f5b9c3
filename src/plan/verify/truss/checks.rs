//! The checks of one step in closed form (lengths of struts and their rates, flat ground), those of distances
//! between struts, and the summary of a plan.

use super::judgement::{Judgement, Step};
use super::support::StabilityMonitor;
use super::{lengths, strut_distance, support};
use crate::geometry::Vec3;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, Plan, Status, World, Worst};
use crate::units::{Dimension, quantity};

impl Judgement<'_> {
    /// Judges a plan of a single keyframe, whose nodes are at `x` in the world (m), as a step in which nothing moves;
    /// does nothing for other plans.
    pub(super) fn at_rest(
        &self,
        x: &[Vec3],
        world: World,
        standing: &mut StabilityMonitor,
        ledger: &mut Ledger,
    ) {
        let step = Step {
            from: x.to_vec(),
            to: x.to_vec(),
            interpolation: Interpolation::Linear,
            start: 0.0,
            duration: 1.0,
        };
        if self.paths.keyframes.len() == 1 {
            self.lengths(&step, ledger);
            self.distances(&step, ledger);
            self.obstacles(&step, ledger);
            self.shape(&step, ledger);
        }
        if world.has_floor() && self.paths.keyframes.len() == 1 {
            self.ground(&step, ledger);
            if world.gravity > 0.0 {
                standing.step(&step, ledger);
            }
        }
    }

    /// Checks the length of every strut and its rate on a step against the strut's range and speed, in closed form,
    /// and keeps the least speed margin. A rigid roll changes neither.
    pub(super) fn lengths(&self, step: &Step, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear {
            return;
        }
        for (strut, &(a, b)) in self.paths.struts.iter().enumerate() {
            let found = lengths::along(step, a, b);
            if let Some((length, time)) = found.outside(self.strut.length, self.tolerances.length) {
                let (low, high) = self.strut.length;
                let [length_, low_, high_] = [length, low, high].map(|x| quantity(x, Dimension::LENGTH));
                let message = format!(
                    "the strut {} would be {length_} long; a {} reaches from {low_} to {high_}",
                    self.strut_name(strut),
                    self.strut.name
                );
                let failure =
                    self.failure(CheckKind::JointRange, time, vec![self.strut_name(strut)], message);
                ledger.fail(Failure {
                    value: length,
                    limit: if length < low { low } else { high },
                    ..failure
                });
            }
            let margin = 1.0 - found.rate / self.strut.speed;
            keep_least(&mut ledger.verdict.speed_margin, margin, step.start, || vec![self.strut_name(strut)]);
            if found.too_fast(self.strut.speed, self.tolerances.rate) {
                let [rate, limit] = [found.rate, self.strut.speed].map(|x| quantity(x, Dimension::SPEED));
                let message =
                    format!("the strut {} changes by {rate}; its limit is {limit}", self.strut_name(strut));
                let failure =
                    self.failure(CheckKind::Speed, step.start, vec![self.strut_name(strut)], message);
                ledger.fail(Failure { value: found.rate, limit: self.strut.speed, ..failure });
            }
        }
    }

    /// Checks that struts without a common node keep their clearance from each other on a step, and keeps the least
    /// distance found. A rigid roll does not change it.
    pub(super) fn distances(&self, step: &Step, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear {
            return;
        }
        let limits = (self.strut.clearance, self.tolerances.strut_distance);
        for near in strut_distance::nearest(self.paths, step, limits, &self.samples) {
            let names = || vec![self.strut_name(near.struts.0), self.strut_name(near.struts.1)];
            let time = step.start + step.duration * near.part;
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
            let name = self.paths.node_names[node].clone();
            let depth = quantity(-height, Dimension::LENGTH);
            let message = format!("the node {name} goes {depth} into the ground");
            let failure =
                self.failure(CheckKind::Ground, step.start + part * step.duration, vec![name], message);
            ledger.fail(Failure { value: -height, ..failure });
        }
    }

    /// Records the displacement of the centre of mass (m), the rolls, the greatest slip of a node (m) and the status
    /// of every check; `places`: for each keyframe the world positions of the nodes, m.
    pub(super) fn summary(
        &self,
        places: &[Vec<Vec3>],
        standing: &StabilityMonitor,
        plan: &Plan,
        ledger: &mut Ledger,
    ) {
        let (first, last) = (&places[0], &places[places.len() - 1]);
        let travel = self.centre(last) - self.centre(first);
        ledger.verdict.travel = [travel.x, travel.y, travel.z];
        ledger.verdict.samples = places.len();
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
        ledger.check(CheckKind::Acceleration, Status::NoLimit);
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
