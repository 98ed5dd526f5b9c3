//! What a truss stands on, and how it falls: on the nodes on the ground while these stay there, over an
//! edge of them once the centre of mass is above it.

use super::judge::{Judged, Leg};
use crate::geometry::{Vec3, pose::turned};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::verify::support_polygon::{self, Point};
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths};
use crate::units::{Dimension, quantity};

/// Nodes lower than this part of a strut's mean length carry weight: trusses give way.
const CONTACT: f64 = 1e-4;
/// The centre of mass may be this much outside of the support at a sample, and twice as much between two,
/// m: rounding, and so that few samples are enough.
const TOL_MARGIN: f64 = 1e-5;
/// How exactly a rigid turn has to lead where the plan says, m.
const TOL_ROLL: f64 = 1e-6;
const SAMPLES_MAX: usize = 100_000;
/// A narrower support is a line, m.
const WIDTH_MIN: f64 = 1e-6;

pub struct Standing<'a> {
    judged: &'a Judged<'a>,
    contact: f64,
    /// How far each node slid over the ground, m.
    slid: Vec<f64>,
    /// The steepest ground that a foot stood on: height by way.
    steepest: f64,
    pub events: Vec<(f64, String)>,
}

/// The centre of mass: half of each strut at each of its ends.
pub fn centre(paths: &NodePaths, x: &[Vec3]) -> Vec3 {
    let sum: Vec3 = paths.struts.iter().map(|&(a, b)| (x[a] + x[b]) / 2.0).sum();
    sum / paths.struts.len().max(1) as f64
}

/// The least height of a node on a leg, and at which part of it.
pub fn lowest(leg: &Leg, node: usize) -> (f64, f64) {
    let (from, to) = (leg.from[node], leg.to[node]);
    let ends = if from.z <= to.z { (from.z, 0.0) } else { (to.z, 1.0) };
    let Interpolation::RigidRoll { edge, angle } = leg.interpolation else { return ends };
    // On its circle a node is lowest half a turn from where it is highest.
    let origin = leg.from[edge.0];
    let axis = (leg.from[edge.1] - origin).normalize();
    let arm = from - origin;
    let across = arm - axis * axis.dot(&arm);
    let (level, ahead) = (across.z, axis.cross(&arm).z);
    let highest = libm::atan2(ahead, level);
    let half = std::f64::consts::PI;
    let bottom = [highest - half, highest + half]
        .into_iter()
        .find(|t| 0.0 < t * angle.signum() && t.abs() < angle.abs());
    match bottom {
        Some(t) => (from.z - level - libm::hypot(level, ahead), t / angle),
        None => ends,
    }
}

impl<'a> Standing<'a> {
    pub fn new(judged: &'a Judged<'a>) -> Standing<'a> {
        let paths = judged.paths;
        let first = &paths.keyframes[0].nodes;
        let length = |&(a, b): &(usize, usize)| (Vec3::from(first[a]) - Vec3::from(first[b])).norm();
        let mean = paths.struts.iter().map(length).sum::<f64>() / paths.struts.len().max(1) as f64;
        Standing {
            judged,
            contact: CONTACT * mean,
            slid: vec![0.0; first.len()],
            steepest: 0.0,
            events: Vec::new(),
        }
    }

    /// The farthest that a node slid, m, and which.
    pub fn slid(&self) -> (f64, usize) {
        let most = |best: (f64, usize), (node, slid): (usize, &f64)| {
            if *slid > best.0 { (*slid, node) } else { best }
        };
        self.slid.iter().enumerate().fold((0.0, 0), most)
    }

    /// What is not judged of sliding.
    pub fn sliding(&self) -> String {
        let words = "nodes may slide on the ground";
        if self.steepest == 0.0 {
            return words.to_owned();
        }
        let slope = quantity(libm::atan(self.steepest), Dimension::ANGLE);
        format!(
            "{words}; feet stand on slopes of up to {slope}, which takes friction of {:.2}",
            self.steepest
        )
    }

    /// Whether a place is on the ground.
    pub fn touches(&self, p: Vec3) -> bool {
        self.judged.paths.surroundings.above(p) <= self.contact
    }

    /// Whether a node touches the ground all the way of a leg.
    fn stays_down(&self, leg: &Leg, node: usize) -> bool {
        let (from, to) = (leg.from[node], leg.to[node]);
        let mut stays = self.touches(from) && self.touches(to);
        if let Some(terrain) = self.judged.paths.surroundings.terrain.as_ref().filter(|_| stays && from != to)
        {
            terrain.profile(from, to, |_, height| stays &= height <= self.contact);
        }
        stays
    }

    pub fn leg(&mut self, leg: &Leg, ledger: &mut Ledger) {
        match leg.interpolation {
            Interpolation::Linear => self.straight(leg, ledger),
            Interpolation::RigidRoll { edge, angle } => self.roll(leg, edge, angle, ledger),
        }
    }

    /// It stands on the nodes that are on the ground all the interpolation: on flat ground, at both ends.
    fn straight(&mut self, leg: &Leg, ledger: &mut Ledger) {
        let feet: Vec<usize> = (0..leg.from.len()).filter(|&n| self.stays_down(leg, n)).collect();
        for &node in &feet {
            if let Some(terrain) = &self.judged.paths.surroundings.terrain {
                let [x, y] = terrain.slope(leg.from[node].x, leg.from[node].y);
                self.steepest = self.steepest.max(libm::hypot(x, y));
            }
            let slid = leg.to[node] - leg.from[node];
            self.slid[node] += libm::hypot(slid.x, slid.y);
        }
        let paths = self.judged.paths;
        let centre_way = centre(paths, &leg.to) - centre(paths, &leg.from);
        let fastest = feet.iter().map(|&n| (leg.to[n] - leg.from[n] - centre_way).norm()).fold(0.0, f64::max);
        let mut part = 0.0;
        // Where it was last seen to stand, until it is proved to stand to the end.
        let mut lost = Some((f64::NAN, leg.begins));
        for _ in 0..SAMPLES_MAX {
            let inside = self.margin(leg, &feet, part);
            let time = leg.begins + part * leg.lasts;
            let names = || feet.iter().map(|&n| paths.node_names[n].clone()).collect();
            keep_least(&mut ledger.verdict.margin, inside, time, names);
            lost = Some((inside, time));
            if inside < -TOL_MARGIN {
                break;
            }
            if part >= 1.0 {
                lost = None;
                break;
            }
            let step = if fastest > 0.0 { (inside + 2.0 * TOL_MARGIN) / fastest } else { 1.0 };
            part = (part + step).min(1.0);
        }
        if let Some((inside, time)) = lost {
            let message = if inside >= -TOL_MARGIN {
                "the centre of mass is so near to the rim of the support that it is not proved to stand"
                    .to_string()
            } else if inside.is_finite() {
                format!(
                    "the centre of mass is {} outside of the support",
                    quantity(-inside, Dimension::LENGTH)
                )
            } else {
                "it does not stand on three nodes".to_string()
            };
            let names = feet.iter().map(|&n| paths.node_names[n].clone()).collect();
            let failure = self.judged.failure(CheckKind::Stability, time, names, message);
            ledger.fail(Failure { value: inside.max(-f64::MAX), ..failure });
        }
    }

    /// How far the centre of mass is inside the hull of the feet, m.
    fn margin(&self, leg: &Leg, feet: &[usize], part: f64) -> f64 {
        let at = |node: usize| leg.from[node] + (leg.to[node] - leg.from[node]) * part;
        let paths = self.judged.paths;
        let middle = centre(paths, &leg.from) * (1.0 - part) + centre(paths, &leg.to) * part;
        let points: Vec<Point> = feet.iter().map(|&node| [at(node).x, at(node).y]).collect();
        let margin = support_polygon::margin(&points, [middle.x, middle.y]);
        // On two feet, or on a row of them, nothing stands.
        margin.filter(|m| m.width > WIDTH_MIN).map_or(f64::NEG_INFINITY, |margin| margin.distance)
    }

    /// It falls over an edge of its support: both ends on the ground, all other feet behind it, the
    /// centre of mass above it or beyond; and the turn leads where the plan says.
    fn roll(&mut self, leg: &Leg, edge: (usize, usize), angle: f64, ledger: &mut Ledger) {
        let paths = self.judged.paths;
        let (origin, end) = (leg.from[edge.0], leg.from[edge.1]);
        let along = end - origin;
        let name = format!("{} -- {}", paths.node_names[edge.0], paths.node_names[edge.1]);
        let refuse = |message: String, ledger: &mut Ledger| {
            ledger.fail(self.judged.failure(CheckKind::Stability, leg.begins, vec![name.clone()], message));
        };
        let turn = turned(along, angle);
        let off =
            leg.from.iter().zip(&leg.to).map(|(p, q)| (origin + turn.rotation * (p - origin) - q).norm());
        let off = off.fold(0.0, f64::max);
        if off > TOL_ROLL {
            refuse(
                format!("the roll over {name} leads {} elsewhere", quantity(off, Dimension::LENGTH)),
                ledger,
            );
        }
        if !self.touches(origin) || !self.touches(end) {
            return refuse(format!("it rolls over {name}, which is not on the ground"), ledger);
        }
        // Turned by a positive angle, what is right of the edge goes down.
        let beyond = |p: Vec3| {
            let side = (p.x - origin.x) * along.y - (p.y - origin.y) * along.x;
            side * angle.signum() / libm::hypot(along.x, along.y)
        };
        let feet = (0..leg.from.len()).filter(|&n| self.touches(leg.from[n]));
        if let Some(foot) = feet.into_iter().find(|&n| beyond(leg.from[n]) > TOL_MARGIN) {
            let foot = &paths.node_names[foot];
            return refuse(format!("it rolls over {name}, and stands on {foot} beyond"), ledger);
        }
        let centre = beyond(centre(paths, &leg.from));
        if centre < -TOL_MARGIN {
            let away = quantity(-centre, Dimension::LENGTH);
            return refuse(format!("it rolls over {name}, and its centre of mass is {away} behind"), ledger);
        }
        self.events
            .push((leg.begins, format!("rolls over {name} by {}", quantity(angle.abs(), Dimension::ANGLE))));
    }
}
