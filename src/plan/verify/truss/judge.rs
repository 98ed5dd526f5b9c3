//! Plans of trusses: nodes that go straight on between keyframes, or roll over an edge as one rigid body.
//!
//! Between two keyframes everything is known in closed form, or bounded: lengths of struts and their rates
//! ([`lengths`](super::lengths)), distances between struts
//! ([`distance`](super::distance)), what it stands on
//! ([`standing`](super::standing)). Struts are lines without thickness that keep their
//! clearance; their mass is half at each end.

use super::standing::Standing;
use super::{around, distance, lengths, shape, standing};
use crate::geometry::{HeightField, Vec3};
use crate::interrupt;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths, Plan, Status, Verdict, World, Worst};
use crate::robot::Strut;
use crate::units::{Dimension, quantity};

/// Nodes may be this far below the ground: a rounding of the plan's numbers, m.
const TOL_GROUND: f64 = 1e-9;

/// The way from one keyframe to the next.
pub struct Leg {
    pub from: Vec<Vec3>,
    pub to: Vec<Vec3>,
    pub interpolation: Interpolation,
    /// Seconds.
    pub begins: f64,
    pub lasts: f64,
}

pub struct Judged<'a> {
    pub paths: &'a NodePaths,
    /// Where struts share a node, if the plan keeps an angle.
    pub corners: Vec<shape::Corner>,
    pub strut: &'a Strut,
    pub obstacles: Vec<around::Obstacle>,
    /// The greatest slope of uneven ground.
    pub steepest: f64,
}

pub fn judge(plan: &Plan, paths: &NodePaths) -> Verdict {
    let mut ledger = Ledger::new(&plan.exemptions, paths.duration());
    let corners = if paths.limits.angle > 0.0 { shape::corners(paths) } else { Vec::new() };
    let strut = &plan.library.struts[paths.strut];
    let steepest = paths.surroundings.terrain.as_ref().map_or(0.0, HeightField::steepest);
    let mut judged = Judged { paths, corners, strut, obstacles: Vec::new(), steepest };
    match around::obstacles(paths) {
        Ok(obstacles) => judged.obstacles = obstacles,
        Err(why) => ledger.fail(judged.failure(CheckKind::Form, 0.0, vec![], format!("an obstacle: {why}"))),
    }
    let places: Vec<Vec<Vec3>> = paths
        .keyframes
        .iter()
        .map(|keyframe| keyframe.nodes.iter().map(|p| Vec3::from(*p)).collect())
        .collect();
    let world_at = |t: f64| {
        let last = plan.worlds.partition_point(|w| w.from <= t).max(1) - 1;
        plan.worlds[last].world
    };
    let mut standing = Standing::new(&judged);
    judged.enclosed(&places[0], &mut ledger);
    judged.at_rest(&places[0], world_at(0.0), &mut standing, &mut ledger);
    for (i, keyframe) in paths.keyframes.iter().enumerate().skip(1) {
        interrupt::progress_checkpoint(|| format!("step {i} of {}", paths.keyframes.len() - 1));
        let begins = paths.keyframes[i - 1].time;
        let leg = Leg {
            from: places[i - 1].clone(),
            to: places[i].clone(),
            interpolation: keyframe.interpolation,
            begins,
            lasts: keyframe.time - begins,
        };
        let world = world_at(begins);
        judged.lengths(&leg, &mut ledger);
        judged.distances(&leg, &mut ledger);
        judged.obstacles(&leg, &mut ledger);
        judged.shape(&leg, &mut ledger);
        if world.has_floor() {
            judged.ground(&leg, &mut ledger);
            if world.gravity > 0.0 {
                standing.leg(&leg, &mut ledger);
            }
        }
        if let Interpolation::RigidRoll { .. } = keyframe.interpolation
            && (world.gravity == 0.0 || !world.has_floor())
        {
            let message = "without gravity and a ground nothing makes it roll".to_string();
            ledger.fail(judged.failure(CheckKind::Ground, begins, vec![], message));
        }
    }
    for (keyframe, x) in
        paths.keyframes.iter().zip(&places).filter(|(keyframe, _)| !keyframe.margins.is_none())
    {
        if let Some(failure) = judged.margins(&keyframe.margins, x, keyframe.time, &standing) {
            ledger.fail(failure);
        }
    }
    judged.summary(&places, &standing, plan, &mut ledger);
    ledger.finish()
}

impl Judged<'_> {
    pub fn strut_name(&self, strut: usize) -> String {
        let (a, b) = self.paths.struts[strut];
        format!("{} -- {}", self.paths.node_names[a], self.paths.node_names[b])
    }

    pub fn failure(&self, kind: CheckKind, time: f64, at: Vec<String>, message: String) -> Failure {
        let cause =
            self.paths.keyframes.iter().find(|keyframe| keyframe.time > time).map(|keyframe| keyframe.cause);
        Failure { kind, time, at, blame: cause.into_iter().collect(), ..Failure::form(message) }
    }

    /// What a plan of one keyframe says, and the start of every other.
    fn at_rest(&self, x: &[Vec3], world: World, standing: &mut Standing, ledger: &mut Ledger) {
        let leg = Leg {
            from: x.to_vec(),
            to: x.to_vec(),
            interpolation: Interpolation::Linear,
            begins: 0.0,
            lasts: 1.0,
        };
        if self.paths.keyframes.len() == 1 {
            self.lengths(&leg, ledger);
            self.distances(&leg, ledger);
            self.obstacles(&leg, ledger);
            self.shape(&leg, ledger);
        }
        if world.has_floor() && self.paths.keyframes.len() == 1 {
            self.ground(&leg, ledger);
            if world.gravity > 0.0 {
                standing.leg(&leg, ledger);
            }
        }
    }

    fn lengths(&self, leg: &Leg, ledger: &mut Ledger) {
        if leg.interpolation != Interpolation::Linear {
            return;
        }
        for (strut, &(a, b)) in self.paths.struts.iter().enumerate() {
            let found = lengths::along(leg, a, b);
            if let Some((length, time)) = found.outside(self.strut.length) {
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
            keep_least(&mut ledger.verdict.speed_margin, margin, leg.begins, || vec![self.strut_name(strut)]);
            if found.too_fast(self.strut.speed) {
                let [rate, limit] = [found.rate, self.strut.speed].map(|x| quantity(x, Dimension::SPEED));
                let message =
                    format!("the strut {} changes by {rate}; its limit is {limit}", self.strut_name(strut));
                let failure =
                    self.failure(CheckKind::Speed, leg.begins, vec![self.strut_name(strut)], message);
                ledger.fail(Failure { value: found.rate, limit: self.strut.speed, ..failure });
            }
        }
    }

    /// Rigid motion changes no distance.
    fn distances(&self, leg: &Leg, ledger: &mut Ledger) {
        if leg.interpolation != Interpolation::Linear {
            return;
        }
        for near in distance::nearest(self.paths, leg, self.strut.clearance) {
            let names = || vec![self.strut_name(near.struts.0), self.strut_name(near.struts.1)];
            let time = leg.begins + leg.lasts * near.part;
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

    fn ground(&self, leg: &Leg, ledger: &mut Ledger) {
        if let Some(terrain) = &self.paths.surroundings.terrain {
            return self.uneven(leg, terrain, ledger);
        }
        let lowest = (0..leg.from.len()).map(|node| (standing::lowest(leg, node), node));
        let Some(((height, part), node)) = lowest.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) else { return };
        if height < -TOL_GROUND {
            let name = self.paths.node_names[node].clone();
            let depth = quantity(-height, Dimension::LENGTH);
            let message = format!("the node {name} goes {depth} into the ground");
            let failure = self.failure(CheckKind::Ground, leg.begins + part * leg.lasts, vec![name], message);
            ledger.fail(Failure { value: -height, ..failure });
        }
    }

    fn summary(&self, places: &[Vec<Vec3>], standing: &Standing, plan: &Plan, ledger: &mut Ledger) {
        let (first, last) = (&places[0], &places[places.len() - 1]);
        let travel = standing::centre(self.paths, last) - standing::centre(self.paths, first);
        ledger.verdict.travel = [travel.x, travel.y, travel.z];
        ledger.verdict.samples = places.len();
        for (time, words) in &standing.events {
            ledger.verdict.events.push((*time, words.clone()));
        }
        let on_ground = plan.worlds.iter().any(|w| w.world.gravity > 0.0 && w.world.has_floor());
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
            ledger.check(CheckKind::Slip, Status::NotChecked(standing.sliding()));
            let why = "the forces in the struts are not found";
            ledger.check(CheckKind::BondLoad, Status::NotChecked(why.into()));
        }
    }
}
