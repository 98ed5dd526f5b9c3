//! A slope under a robot: the friction that it needs under statics, and joints that let it roll.

use super::contact::ContactPoint;
use super::dynamics::{free_joint, slide_failure};
use super::sample::Sample;
use super::tolerances::Tolerances;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, DynamicsModel, ExemptionKind, Ground, Status};
use crate::units::{Dimension, quantity, rounded};

/// The monitor of a robot on a slope during a rollout. It does nothing on level ground.
pub(super) struct Monitor<'a> {
    tolerances: &'a Tolerances,
    /// The slope: the tangent of its angle; `None` before a sample on one.
    rise: Option<f64>,
    /// The number of samples on the slope.
    samples: usize,
    /// The least friction of a loaded contact.
    least: f64,
    /// True if a slide failed.
    failed: bool,
    /// True if an exemption excused a slide.
    excused: bool,
    /// A joint without a motor that may let the robot roll.
    free: Option<String>,
}

impl<'a> Monitor<'a> {
    /// Returns a monitor before the first sample.
    pub(super) fn new(tolerances: &'a Tolerances) -> Monitor<'a> {
        Monitor {
            tolerances,
            rise: None,
            samples: 0,
            least: f64::INFINITY,
            failed: false,
            excused: false,
            free: None,
        }
    }

    /// Takes a sample, in order of time. Under statics every loaded contact must hold its share of the weight along the
    /// slope: its coefficient of friction must not be less than the tangent of the angle.
    pub(super) fn observe(&mut self, sample: &Sample, ledger: &mut Ledger) {
        if !sample.world.is_sloped() || sample.world.ground != Ground::Settle {
            return;
        }
        let rise = sample.world.rise();
        self.rise = Some(rise);
        self.samples += 1;
        let loaded = |t: &&ContactPoint| t.load > self.tolerances.load_min;
        let bearing = || sample.stance.contact_points.iter().filter(loaded).map(|t| t.link);
        if self.free.is_none() && sample.moved {
            self.free = free_joint(sample.model, &bearing().collect());
        }
        let least = bearing()
            .map(|link| sample.world.friction * sample.model.bodies[link].friction)
            .fold(f64::INFINITY, f64::min);
        self.least = self.least.min(least);
        if sample.world.dynamics != DynamicsModel::Statics || least >= rise || self.failed {
            return;
        }
        let of = |kind: &ExemptionKind| *kind == ExemptionKind::Traction;
        if ledger.excuses(CheckKind::Traction, sample.time, of) {
            self.excused = true;
        } else {
            self.failed = true;
            ledger.fail(slide_failure(sample.time, rise, least));
        }
    }

    /// Returns the joint without a motor that may let the robot roll down the slope, by name; `None` if there is none.
    pub(super) fn free(&self) -> Option<&str> {
        self.free.as_deref()
    }

    /// Records the friction that the slope needs, and under statics (`full` is false) the status of the check of traction.
    pub(super) fn finish(&self, full: bool, ledger: &mut Ledger) {
        let Some(rise) = self.rise else { return };
        ledger.note(format!(
            "the ground slopes by {}: to stand needs a friction of {}, and the least of what bears the robot is {}",
            quantity(libm::atan(rise), Dimension::ANGLE),
            rounded(rise, 3),
            rounded(self.least, 3)
        ));
        if full {
            return;
        }
        ledger.check(CheckKind::Traction, rolls(self.free(), Status::Sampled(self.samples)));
        if self.excused {
            ledger.note("the way down the slope is not followed".to_owned());
        }
    }
}

/// Returns the status of a check on a slope: not checked where a joint without a motor lets the robot roll, else `status`.
pub(super) fn rolls(free: Option<&str>, status: Status) -> Status {
    match free {
        Some(joint) => {
            Status::NotChecked(format!("{joint} has no motor, and the robot may roll down the slope on it"))
        }
        None => status,
    }
}
