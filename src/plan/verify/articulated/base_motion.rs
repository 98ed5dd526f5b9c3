//! Displacement of the base, slip of loaded links, and penetrating contact with the ground where the base is
//! fixed.

use super::contact::ContactPoint;
use super::sample::Sample;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::geometry::pose::turn_about_vertical;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure, Ground, Settings, Status, Worst};
use crate::units::{Dimension, quantity};

/// The monitor of the base during a rollout: it sums the turn of the base and the slip of links, and looks for
/// contact that penetrates the ground where the base is fixed to it.
pub(super) struct Monitor<'a> {
    tolerances: &'a Tolerances,
    /// The world pose of the base at the first sample, m; `None` before it.
    start: Option<Pose>,
    /// The world pose of the base at the last sample that moved, m.
    last: Pose,
    /// The turn of the base about the vertical since the first sample, whole turns counted, rad.
    yaw: f64,
    /// The slip of each link, by its number, summed over the samples at which it carries a share of the weight, m.
    slips: Vec<f64>,
    /// The part of it that nothing excuses, m.
    counted: Vec<f64>,
    /// The greatest slip that is stated, m.
    slip_max: Option<f64>,
    /// The times (s) at which links, by their numbers, come to slip by more.
    exceeded: Vec<(f64, usize)>,
    /// The number of samples.
    samples: usize,
    /// The deepest penetration so far of the present interval: (depth, m; time, s; name of the module; begin of the
    /// interval, s).
    deepest: Option<(f64, f64, String, f64)>,
    /// The grounds of the plan, each once.
    grounds: Vec<Ground>,
}

impl<'a> Monitor<'a> {
    /// Returns a monitor before the first sample. `settings`: those of the plan, which may state a greatest slip.
    pub(super) fn new(settings: &Settings, tolerances: &'a Tolerances) -> Monitor<'a> {
        let identity = Pose::identity();
        Monitor {
            tolerances,
            start: None,
            last: identity,
            yaw: 0.0,
            slips: vec![],
            counted: vec![],
            slip_max: settings.slip_max,
            exceeded: vec![],
            samples: 0,
            deepest: None,
            grounds: vec![],
        }
    }

    /// Takes a sample, in order of time: follows the base, and sums the slip of links that carry weight. A robot with
    /// a fixed base that has penetrated the ground gets its failure as the penetration ends; slip beyond what is stated
    /// fails in [`finish`](Self::finish).
    pub(super) fn observe(&mut self, sample: &Sample, ledger: &mut Ledger) {
        self.samples += 1;
        if !self.grounds.contains(&sample.world.ground) {
            self.grounds.push(sample.world.ground);
        }
        if sample.moved {
            self.travel(sample);
            self.slip(sample, ledger);
        }
        if sample.world.ground == Ground::Fixed {
            self.penetration(sample, ledger);
        }
    }

    /// Follows the pose of the base, and its turn about the vertical.
    fn travel(&mut self, sample: &Sample) {
        let pose = sample.stance.base_pose(sample.model);
        if self.start.is_none() {
            (self.start, self.last) = (Some(pose), pose);
        }
        // The turn since the sample before, about the vertical.
        self.yaw += turn_about_vertical(&(pose.rotation * self.last.rotation.inverse()));
        self.last = pose;
    }

    /// Adds to the slip of the links that carry at least the part `slip_load` of the weight. Excused slip counts for
    /// the greatest slip, and not against the stated one.
    fn slip(&mut self, sample: &Sample, ledger: &mut Ledger) {
        self.slips.resize(sample.model.bodies.len(), 0.0);
        self.counted.resize(sample.model.bodies.len(), 0.0);
        let loaded = || sample.slips.iter().filter(|(_, _, load)| *load >= self.tolerances.slip_load);
        let mut slides = false;
        for &(link, slip, _) in loaded() {
            self.slips[link] += slip;
            slides |= self.slips[link] > self.tolerances.slip;
        }
        // Without a limit slip fails nothing: an exemption is needed as soon as there is some.
        let of = |kind: &ExemptionKind| *kind == ExemptionKind::Slip;
        if slides && ledger.excuses(CheckKind::Slip, sample.time, of) {
            return;
        }
        for &(link, slip, _) in loaded() {
            let before = self.counted[link];
            self.counted[link] += slip;
            let crosses = |most: f64| before <= most && self.counted[link] > most;
            if self.slip_max.is_some_and(crosses) {
                self.exceeded.push((sample.time, link));
            }
        }
    }

    /// Begins, continues or ends an interval of penetrating contact.
    fn penetration(&mut self, sample: &Sample, ledger: &mut Ledger) {
        match penetrating_contact(sample) {
            Some(contact_point) => {
                let since = self.deepest.as_ref().map_or(sample.time, |s| s.3);
                if self.deepest.as_ref().is_none_or(|s| -contact_point.gap > s.0) {
                    let name = sample.model.module_name(contact_point.link).to_owned();
                    self.deepest = Some((-contact_point.gap, sample.time, name, since));
                }
            }
            None => self.end_penetration(sample.time, ledger),
        }
    }

    /// Ends the present interval of penetrating contact at `t` (s), if there is one, with a failure.
    fn end_penetration(&mut self, t: f64, ledger: &mut Ledger) {
        let Some((depth, _, name, since)) = self.deepest.take() else { return };
        let words = quantity(depth, Dimension::LENGTH);
        ledger.fail(Failure {
            kind: CheckKind::Ground,
            time: since,
            until: Some(t),
            message: format!("{name} goes into the ground, {words} deep"),
            at: vec![name],
            value: depth,
            limit: 0.0,
            blame: vec![],
            blames_start: false,
        });
    }

    /// Records the displacement (m) and turn (rad) of the base, the greatest slip (m), the failures of links that
    /// slip by more than is stated, and the status of the checks of ground and slip. `names` returns the name of a
    /// link, given by its number among all links.
    pub(super) fn finish(&mut self, names: impl Fn(usize) -> String, ledger: &mut Ledger) {
        let end = ledger.verdict.duration;
        self.end_penetration(end, ledger);
        if let Some(start) = self.start {
            let travel = self.last.translation.vector - start.translation.vector;
            ledger.verdict.travel = [travel.x, travel.y, travel.z];
            ledger.verdict.heading = self.yaw;
        }
        let worst =
            (0..self.slips.len()).reduce(|w, link| if self.slips[link] > self.slips[w] { link } else { w });
        ledger.verdict.slip = worst.filter(|_| self.grounds.contains(&Ground::Settle)).map(|link| Worst {
            value: self.slips[link],
            time: end,
            at: vec![names(link)],
        });
        let settles = self.grounds.contains(&Ground::Settle);
        let fixed = self.grounds.contains(&Ground::Fixed);
        ledger.check(
            CheckKind::Ground,
            match (settles, fixed) {
                (_, true) => Status::Sampled(self.samples),
                (true, false) => Status::Proved,
                (false, false) => Status::NotChecked("there is no ground".to_owned()),
            },
        );
        for &(time, link) in &self.exceeded {
            ledger.fail(slip_failure(time, names(link), self.counted[link], self.slip_max.unwrap_or(0.0)));
        }
        ledger.check(
            CheckKind::Slip,
            match settles {
                true if self.slip_max.is_some() => Status::Sampled(self.samples),
                true => Status::NoLimit,
                false => Status::NotChecked("the base is not carried by the ground".to_owned()),
            },
        );
    }
}

/// Returns the failure of a link, by name, that slips by `slip` in all, more than `most` (m) from `time` (s) on.
fn slip_failure(time: f64, name: String, slip: f64, most: f64) -> Failure {
    let [slipped, allowed] = [slip, most].map(|length| quantity(length, Dimension::LENGTH));
    Failure {
        kind: CheckKind::Slip,
        time,
        until: None,
        message: format!("{name} slips {slipped} over the ground in all, and may slip {allowed}"),
        at: vec![name],
        value: slip,
        limit: most,
        blame: vec![],
        blames_start: false,
    }
}

/// Returns the deepest contact point of a sample, if it is deeper in the ground than its module's `touch`; `None` if
/// it is not, and without contact points.
pub(super) fn penetrating_contact<'s>(sample: &Sample<'s>) -> Option<&'s ContactPoint> {
    let deepest = sample.stance.contact_points.iter().reduce(|d, t| if t.gap < d.gap { t } else { d });
    deepest.filter(|t| {
        let module = sample.model.bodies[t.link].module;
        -t.gap > sample.model.robot.module_type(module).touch
    })
}
