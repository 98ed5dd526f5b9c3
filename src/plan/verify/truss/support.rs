//! Static stability of a truss: the centre of mass stays above the support polygon of the nodes on the ground;
//! and rolls over an edge of that polygon, once the centre of mass is above the edge.

use super::judgement::{Judgement, Step};
use crate::geometry::{Vec3, pose::turned};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::verify::support_polygon::{self, Point};
use crate::plan::{CheckKind, Failure, Interpolation};
use crate::units::{Dimension, quantity};

/// The monitor of the static stability of a truss from step to step, which also sums the slip of its nodes.
pub(super) struct StabilityMonitor {
    /// The height above the ground up to which a node counts as on it, m.
    contact: f64,
    /// Distance that each node of the plan slid over the ground, m.
    slid: Vec<f64>,
    /// The steepest slope that a foot stood on, without unit.
    steepest: f64,
    /// The rolls of the truss so far, each as (time in s, event in words), in order of time.
    pub events: Vec<(f64, String)>,
}

impl Judgement<'_> {
    /// Returns the centre of mass with the nodes at `x` in the world, m: half of each strut's mass is at each of its
    /// ends.
    pub(super) fn centre(&self, x: &[Vec3]) -> Vec3 {
        let struts: Vec3 = self.struts.iter().map(|&(a, b)| (x[a] + x[b]) / 2.0).sum();
        let node = self.strut.node_mass.unwrap_or(0.0);
        // A node weighs as much as those that ride along with it, too.
        let nodes: Vec3 = x.iter().zip(&self.carried).map(|(p, count)| p * *count).sum();
        let whole = self.strut.mass * self.struts.len() as f64 + node * self.paths.node_names.len() as f64;
        (struts * self.strut.mass + nodes * node) / whole
    }
}

/// Returns (height, fraction): the least height of a node on a step, m, and the fraction of the step, 0 to 1, at which
/// it has it; in closed form, over flat ground. `node`: its index.
pub(super) fn lowest(step: &Step, node: usize) -> (f64, f64) {
    let (from, to) = (step.from[node], step.to[node]);
    let ends = if from.z <= to.z { (from.z, 0.0) } else { (to.z, 1.0) };
    let Interpolation::RigidRoll { edge, angle } = step.interpolation else { return ends };
    // On its circle a node is lowest half a turn from its highest point.
    let origin = step.from[edge.0];
    let axis = (step.from[edge.1] - origin).normalize();
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

impl StabilityMonitor {
    /// Returns a monitor before the first step.
    pub(super) fn new(judgement: &Judgement) -> StabilityMonitor {
        let paths = judgement.paths;
        let first = &paths.keyframes[0].nodes;
        let length = |&(a, b): &(usize, usize)| (Vec3::from(first[a]) - Vec3::from(first[b])).norm();
        let mean = paths.struts.iter().map(length).sum::<f64>() / paths.struts.len().max(1) as f64;
        StabilityMonitor {
            contact: judgement.tolerances.contact * mean,
            slid: vec![0.0; first.len()],
            steepest: 0.0,
            events: Vec::new(),
        }
    }

    /// Returns (distance, node): the greatest distance that a node slid over the ground so far, m, and the index of
    /// that node; 0 and the first node if none slid.
    pub(super) fn slid(&self) -> (f64, usize) {
        let most = |best: (f64, usize), (node, slid): (usize, &f64)| {
            if *slid > best.0 { (*slid, node) } else { best }
        };
        self.slid.iter().enumerate().fold((0.0, 0), most)
    }

    /// Returns the distance that all nodes together slid over the ground so far, m.
    pub(super) fn slid_in_all(&self) -> f64 {
        self.slid.iter().sum()
    }

    /// Returns in words that sliding is not judged, and the friction that the steepest slope under a foot takes.
    pub(super) fn sliding(&self) -> String {
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

    /// Returns true if a point in the world (m) is no higher above the ground than the contact tolerance.
    pub(super) fn touches(&self, judgement: &Judgement, p: Vec3) -> bool {
        judgement.paths.surroundings.above(p) <= self.contact
    }

    /// Returns true if a node is on the ground during the whole step.
    pub(super) fn stays_down(&self, judgement: &Judgement, step: &Step, node: usize) -> bool {
        let (from, to) = (step.from[node], step.to[node]);
        let mut stays = self.touches(judgement, from) && self.touches(judgement, to);
        if let Some(terrain) = judgement.paths.surroundings.terrain.as_ref().filter(|_| stays && from != to) {
            terrain.profile(from, to, |_, height| stays &= height <= self.contact);
        }
        stays
    }

    /// Judges static stability during a step, and records failures and the least margin: for straight paths that the
    /// centre of mass stays above the support polygon, for a rigid roll that its edge is one that it can roll over.
    pub(super) fn step(&mut self, judgement: &Judgement, step: &Step, ledger: &mut Ledger) {
        match step.interpolation {
            Interpolation::Linear => self.straight(judgement, step, ledger),
            Interpolation::RigidRoll { edge, angle } => self.roll(judgement, step, (edge, angle), ledger),
        }
    }

    /// Checks that the centre of mass stays above the support polygon of the nodes that are on the ground during
    /// the whole step, by conservative advancement.
    fn straight(&mut self, judgement: &Judgement, step: &Step, ledger: &mut Ledger) {
        let feet: Vec<usize> =
            (0..step.from.len()).filter(|&n| self.stays_down(judgement, step, n)).collect();
        // Slip and slope of the feet.
        for &node in &feet {
            if let Some(terrain) = &judgement.paths.surroundings.terrain {
                let [x, y] = terrain.slope(step.from[node].x, step.from[node].y);
                self.steepest = self.steepest.max(libm::hypot(x, y));
            }
            let slid = step.to[node] - step.from[node];
            self.slid[judgement.nodes[node]] += libm::hypot(slid.x, slid.y);
        }
        // Speed of the centre of mass relative to the fastest foot, per step.
        let centre_way = judgement.centre(&step.to) - judgement.centre(&step.from);
        let fastest =
            feet.iter().map(|&n| (step.to[n] - step.from[n] - centre_way).norm()).fold(0.0, f64::max);
        let mut part = 0.0;
        // The last sample, until stability is proved to the end of the step.
        let mut lost = Some((f64::NAN, step.start));
        // Advancement: a margin lasts at least as long as that speed takes to use it up.
        judgement.samples.advance(|| {
            let inside = margin(judgement, step, &feet, part);
            let time = step.time(part);
            let names = || feet.iter().map(|&n| judgement.node_name(n)).collect();
            keep_least(&mut ledger.verdict.margin, inside, time, names);
            lost = Some((inside, time));
            if inside < -judgement.tolerances.support_margin {
                return Some(());
            }
            if part >= 1.0 {
                lost = None;
                return Some(());
            }
            let advance = if fastest > 0.0 {
                (inside + 2.0 * judgement.tolerances.support_margin) / fastest
            } else {
                1.0
            };
            part = (part + advance).min(1.0);
            None
        });
        // The failure, if stability was not proved to the end.
        if let Some((inside, time)) = lost {
            let message = if inside >= -judgement.tolerances.support_margin {
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
            let names = feet.iter().map(|&n| judgement.node_name(n)).collect();
            let failure = judgement.failure(CheckKind::Stability, time, names, message);
            ledger.fail(Failure { value: inside.max(-f64::MAX), ..failure });
        }
    }

    /// Checks a roll over an edge of the support polygon: both ends of the edge are on the ground, all other feet
    /// behind it, the centre of mass above it or beyond, and the rotation leads to the plan's node positions.
    fn roll(
        &mut self,
        judgement: &Judgement,
        step: &Step,
        (edge, angle): ((usize, usize), f64),
        ledger: &mut Ledger,
    ) {
        let (origin, end) = (step.from[edge.0], step.from[edge.1]);
        let along = end - origin;
        let name = format!("{} -- {}", judgement.node_name(edge.0), judgement.node_name(edge.1));
        let refuse = |message: String, ledger: &mut Ledger| {
            ledger.fail(judgement.failure(CheckKind::Stability, step.start, vec![name.clone()], message));
        };
        // The rotation must lead to the node positions of the plan.
        let turn = turned(along, angle);
        let off =
            step.from.iter().zip(&step.to).map(|(p, q)| (origin + turn.rotation * (p - origin) - q).norm());
        let off = off.fold(0.0, f64::max);
        if off > judgement.tolerances.roll {
            refuse(
                format!("the roll over {name} leads {} elsewhere", quantity(off, Dimension::LENGTH)),
                ledger,
            );
        }
        // The edge must be on the ground.
        if !self.touches(judgement, origin) || !self.touches(judgement, end) {
            return refuse(format!("it rolls over {name}, which is not on the ground"), ledger);
        }
        // Signed distance beyond the edge: a positive angle lowers what is right of the edge.
        let beyond = |p: Vec3| {
            let side = (p.x - origin.x) * along.y - (p.y - origin.y) * along.x;
            side * angle.signum() / libm::hypot(along.x, along.y)
        };
        let feet = (0..step.from.len()).filter(|&n| self.touches(judgement, step.from[n]));
        if let Some(foot) =
            feet.into_iter().find(|&n| beyond(step.from[n]) > judgement.tolerances.support_margin)
        {
            let foot = judgement.node_name(foot);
            return refuse(format!("it rolls over {name}, and stands on {foot} beyond"), ledger);
        }
        // The centre of mass must be above the edge or beyond it.
        let centre = beyond(judgement.centre(&step.from));
        if centre < -judgement.tolerances.support_margin {
            let away = quantity(-centre, Dimension::LENGTH);
            return refuse(format!("it rolls over {name}, and its centre of mass is {away} behind"), ledger);
        }
        self.events
            .push((step.start, format!("rolls over {name} by {}", quantity(angle.abs(), Dimension::ANGLE))));
    }
}

/// Returns the static stability margin at a fraction of the step: the distance of the centre of mass inside the
/// support polygon of the feet, m; negative infinity if they span no area.
fn margin(judgement: &Judgement, step: &Step, feet: &[usize], part: f64) -> f64 {
    let at = |node: usize| step.from[node] + (step.to[node] - step.from[node]) * part;
    let middle = judgement.centre(&step.from) * (1.0 - part) + judgement.centre(&step.to) * part;
    let points: Vec<Point> = feet.iter().map(|&node| [at(node).x, at(node).y]).collect();
    let margin = support_polygon::margin(&points, [middle.x, middle.y]);
    // On two feet, or on a row of them, nothing stands.
    margin
        .filter(|m| m.width > judgement.tolerances.support_width)
        .map_or(f64::NEG_INFINITY, |margin| margin.distance)
}
