//! Static stability: tip-overs, and the margin of the centre of mass in the support polygon.

use super::contact;
use super::sample::Sample;
use super::tolerances::Tolerances;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::verify::support_polygon::{self, Margin};
use crate::plan::{CheckKind, ExemptionKind, Failure, Ground, Settings, Stability, Status};
use crate::units::{Dimension, quantity};

/// The monitor of static stability during a rollout: of losses of support, and of the least margin.
pub(super) struct Monitor<'a> {
    settings: &'a Settings,
    tolerances: &'a Tolerances,
    /// The present loss of support; `None` while the robot stands.
    loss: Option<SupportLoss>,
    /// The number of samples with a ground and weight.
    samples: usize,
    /// True if every step so far was proved to be free of tip-overs.
    proved: bool,
    /// True if the last sample stood so well inside its support that a step from it may be proved.
    standing: bool,
    /// True if any part of the plan has a ground and weight.
    ground: bool,
    /// True if any part of the plan has a ground without gravity.
    weightless: bool,
    /// True if the base is held by a fixture in any part of the plan.
    fixed_base: bool,
}

/// An interval of time in which the robot lacks support.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SupportLoss {
    /// The time at which the interval without support begins, s.
    pub since: f64,
    /// The time at which the interval without support ends, s.
    pub until: f64,
    /// The fall of the centre of mass, m, if the robot tips over; `None` if it does not.
    pub drop: Option<f64>,
    /// The least stability margin, m; `None` if the contacts span no area, and for a tip-over.
    pub margin: Option<f64>,
    /// The parts at the edge of the support polygon in words, for a message; empty if there is none.
    pub edge: String,
    /// The path names of the modules at the edge of the support polygon.
    pub modules: Vec<String>,
}

impl<'a> Monitor<'a> {
    /// Returns a monitor before the first sample.
    pub(super) fn new(settings: &'a Settings, tolerances: &'a Tolerances) -> Monitor<'a> {
        Monitor {
            settings,
            tolerances,
            loss: None,
            samples: 0,
            proved: true,
            standing: false,
            ground: false,
            weightless: false,
            fixed_base: false,
        }
    }

    /// Takes a sample, in order of time. Returns a loss of support that ends at it, if it lasted longer than the
    /// settings allow (`unstable_for`); `None` otherwise. Keeps the least margin in the verdict.
    pub(super) fn observe(&mut self, sample: &Sample, ledger: &mut Ledger) -> Option<SupportLoss> {
        self.fixed_base |= sample.world.ground == Ground::Held;
        self.weightless |= sample.world.has_floor() && sample.world.gravity == 0.0;
        if matches!(sample.world.ground, Ground::Off | Ground::Held) || sample.world.gravity == 0.0 {
            self.standing = false;
            return self.ended(sample.time);
        }
        self.ground = true;
        self.samples += 1;
        self.note_events(sample, ledger);
        let support = self.support(sample);
        if let Some(distance) = judged_margin(sample, support.as_ref()) {
            let edge = || support.as_ref().map_or_else(Vec::new, |s| edge_names(sample, &s.1));
            keep_least(&mut ledger.verdict.margin, distance, sample.time, edge);
        }
        self.prove(sample);
        let excuse = |kind: &ExemptionKind| *kind == ExemptionKind::Unstable;
        let stands = support.as_ref().is_some_and(|s| s.0.distance >= -self.tolerances.margin);
        if let Some(tip) = sample.tip.filter(|tip| !tip.excused) {
            let (edge, modules) = (edge_words(sample, &tip.edge), edge_names(sample, &tip.edge));
            let (since, drop) = (tip.time, Some(tip.fall));
            let loss = SupportLoss { since, until: since, drop, margin: None, edge, modules };
            if tip.in_air {
                return Some(loss);
            }
            self.loss = Some(loss);
        }
        if sample.tip.is_some_and(|tip| tip.excused) {
            ledger.excuses(CheckKind::Stability, sample.tip.map_or(0.0, |t| t.time), excuse);
        }
        if sample.stance.held || (!stands && !ledger.excuses(CheckKind::Stability, sample.time, excuse)) {
            self.lacks(sample, support);
            return None;
        }
        self.ended(sample.time)
    }

    /// Returns the stability margin of a sample by the rule of the settings, m: negative outside the support, 0 in a
    /// support without area. `None` where there is nothing to stand on or no weight, and while the base is held
    /// because support is missing.
    pub(super) fn margin(&self, sample: &Sample) -> Option<f64> {
        let off = matches!(sample.world.ground, Ground::Off | Ground::Held) || sample.world.gravity == 0.0;
        if off { None } else { judged_margin(sample, self.support(sample).as_ref()) }
    }

    /// Returns true if support was missing at the last sample observed.
    pub(super) fn lacking(&self) -> bool {
        self.loss.is_some()
    }

    /// Returns the loss of support that lasts to the end of the plan, at `t` (s), however short it is; `None` if
    /// there is none.
    pub(super) fn end(&mut self, t: f64) -> Option<SupportLoss> {
        self.loss.take().map(|loss| SupportLoss { until: t, ..loss })
    }

    /// Records the status of the check of stability, unless it has failed or was excused. Proved: no step could tip
    /// the robot over. Sampled: stability was judged at the samples, whose number it gives, and not between them. Not
    /// checked: the robot never had weight on a ground, as there is no ground, gravity is off, or the base is held
    /// fast.
    pub(super) fn finish(&self, ledger: &mut Ledger) {
        let why = match (self.fixed_base, self.weightless) {
            (true, _) => "what is held fast does not fall",
            (false, true) => "there is no gravity",
            (false, false) => "there is no ground",
        };
        let none = || Status::NotChecked(why.to_owned());
        let status = match (self.ground, self.proved) {
            (false, _) => none(),
            (true, true) => Status::Proved,
            (true, false) => Status::Sampled(self.samples),
        };
        ledger.check(CheckKind::Stability, status);
    }

    /// Begins an interval without support at a sample, or continues it.
    fn lacks(&mut self, sample: &Sample, support: Option<(Margin, [usize; 2])>) {
        let links = support.as_ref().map_or(&[][..], |s| &s.1);
        let (edge, modules) = (edge_words(sample, links), edge_names(sample, links));
        let margin = support.as_ref().map(|s| s.0.distance);
        let loss = self.loss.get_or_insert(SupportLoss {
            since: sample.time,
            until: sample.time,
            drop: None,
            margin,
            edge,
            modules,
        });
        loss.until = sample.time;
        loss.margin = match (loss.margin, margin) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }

    /// Ends an interval without support at `t` (s); returns it if it was too long, `None` otherwise.
    fn ended(&mut self, t: f64) -> Option<SupportLoss> {
        let loss = self.loss.take()?;
        (t - loss.since > self.settings.unstable_for).then_some(SupportLoss { until: t, ..loss })
    }

    /// Returns the margin in the support by the rule of the settings, and the links at its edge; `None` if the
    /// support has no area.
    fn support(&self, sample: &Sample) -> Option<(Margin, [usize; 2])> {
        match self.settings.stability {
            Stability::Footprint => {
                let contact_points = &sample.stance.contact_points;
                let foot = sample.stance.foot();
                let margin = contact::margin(contact_points, foot, |t| contact::counts(sample.model, t))?;
                let links = [contact_points[margin.edge.0].link, contact_points[margin.edge.1].link];
                Some((margin, links))
            }
            Stability::Centres => centres(sample, self.tolerances),
        }
    }

    /// Proves the step between two samples: no tip is possible where the centre of mass is further inside its
    /// support than any motion of the step can bring it.
    fn prove(&mut self, sample: &Sample) {
        let stance = sample.stance;
        let safe = self.settings.stability == Stability::Footprint
            && stance.margin_exact(self.tolerances).is_some_and(|m| {
                m.distance > 2.0 * sample.motion * (1.0 + stance.height / m.width.max(f64::MIN_POSITIVE))
            });
        let standing = safe && !stance.held;
        let first = sample.before == sample.time;
        if sample.moved && sample.world.ground == Ground::Settle {
            self.proved &= standing && (self.standing || first);
        } else if sample.moved {
            self.proved &= first;
        }
        self.standing = standing;
    }

    /// Notes settling and tip-overs in the verdict.
    fn note_events(&self, sample: &Sample, ledger: &mut Ledger) {
        let settles = |angle: &f64| *angle > 0.0 && sample.fall > self.tolerances.fall_floor;
        if let Some(angle) = sample.settling.filter(settles) {
            let angle = quantity(angle, Dimension::ANGLE);
            ledger.note(match sample.time == 0.0 {
                true => format!("the start settles by {angle}"),
                false => {
                    format!("at {} it settles by {angle}", quantity(sample.time, Dimension::TIME))
                }
            });
        }
        if let Some(tip) = sample.tip {
            let edge = edge_words(sample, &tip.edge);
            let drop = quantity(tip.fall, Dimension::LENGTH);
            ledger.verdict.events.push((
                tip.time,
                match tip.in_air {
                    true => format!("falls to the ground, {drop}"),
                    false => format!("tips over {edge}, drops {drop}"),
                },
            ));
        }
    }
}

/// Returns the distance of the centre of mass inside its support, m: 0 in a polygon without area, `None` while the
/// base is held.
fn judged_margin(sample: &Sample, support: Option<&(Margin, [usize; 2])>) -> Option<f64> {
    (!sample.stance.held).then(|| support.map_or(0.0, |s| s.0.distance))
}

impl SupportLoss {
    /// Returns the failure of the check of stability that this loss is, without blame. `subject`: the robot in words.
    pub(super) fn failure(&self, subject: &str) -> Failure {
        let time = |t| quantity(t, Dimension::TIME);
        let edge = if self.edge.is_empty() { String::new() } else { format!(" over {}", self.edge) };
        let (message, value) = match (self.drop, self.margin) {
            (Some(drop), _) => {
                let words = quantity(drop, Dimension::LENGTH);
                (format!("{subject} falls{edge} at {}, by {words}", time(self.since)), -drop)
            }
            (None, Some(margin)) => {
                let out = quantity(-margin, Dimension::LENGTH);
                let from = time(self.since);
                (format!("the centre of mass is {out} outside the support{edge} from {from}"), margin)
            }
            (None, None) => {
                let from = time(self.since);
                (format!("what supports the robot spans no area from {from}"), 0.0)
            }
        };
        Failure {
            kind: CheckKind::Stability,
            time: self.since,
            until: Some(self.until),
            at: self.modules.clone(),
            message,
            value,
            limit: 0.0,
            blame: vec![],
            blames_start: false,
        }
    }
}

/// Returns the path names of the modules of the links at an edge; one if they are the same.
fn edge_names(sample: &Sample, links: &[usize]) -> Vec<String> {
    let mut names: Vec<String> = links.iter().map(|&l| sample.model.module_name(l).to_owned()).collect();
    names.dedup();
    names
}

/// Returns an edge in words: by the modules at its ends, or by its parts if they are one module.
fn edge_words(sample: &Sample, links: &[usize]) -> String {
    let names = edge_names(sample, links);
    let [module] = names.as_slice() else { return names.join(" and ") };
    let part = |&link: &usize| {
        let body = &sample.model.bodies[link];
        let index = link - sample.model.kinematics.link(body.module, 0);
        sample.model.robot.module_type(body.module).links[index].name.clone()
    };
    format!("{module} ({})", links.iter().map(part).collect::<Vec<_>>().join(" and "))
}

/// Returns the margin by the paper's rule: of the mean of the modules' centres (it takes them for equally heavy) in
/// the hull of the lowest centres; `None` if they span no area, as for a straight chain and a single module.
fn centres(sample: &Sample, tolerances: &Tolerances) -> Option<(Margin, [usize; 2])> {
    let kinematics = &sample.model.kinematics;
    let bodies: Vec<usize> = kinematics.tree.order.iter().map(|&(m, _)| kinematics.link(m, 0)).collect();
    let places: Vec<_> =
        bodies.iter().map(|&link| sample.stance.pose_on_ground(link).translation.vector).collect();
    let lowest = places.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let low: Vec<usize> = (0..places.len()).filter(|&i| places[i].z - lowest < tolerances.centres).collect();
    let points: Vec<_> = low.iter().map(|&i| [places[i].x, places[i].y]).collect();
    let count = places.len() as f64;
    let mut mean = places.iter().fold([0.0, 0.0], |sum, p| [sum[0] + p.x / count, sum[1] + p.y / count]);
    if sample.world.is_sloped() {
        let height = places.iter().map(|p| p.z / count).sum::<f64>();
        let lean = sample.world.lean(0.0);
        mean = [mean[0] + lean[0] * height, mean[1] + lean[1] * height];
    }
    let margin = support_polygon::margin(&points, mean)?;
    let links = [bodies[low[margin.edge.0]], bodies[low[margin.edge.1]]];
    Some((margin, links))
}
