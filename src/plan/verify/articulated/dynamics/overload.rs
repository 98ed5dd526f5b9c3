//! A load over its limit in motion, and the message of its failure.

use super::super::load_limits::Overload;
use super::super::statics::Load;
use crate::plan::Failure;
use crate::units::{number, quantity};

/// A load whose mean over a window of time exceeds its limit less the reserve, from its first time to its last.
pub(super) struct MeanOverload {
    /// The load, with its times and the greatest mean.
    pub overload: Overload,
    /// The index of the load in its structure's [`loads`](super::super::statics::Structure::loads).
    pub load: usize,
    /// The index of the instant in the middle of the window in which its mean is greatest.
    pub instant: usize,
    /// True if less than the stated limit is left at the speed of the joint.
    pub falls: bool,
}

impl MeanOverload {
    /// Returns an overload that begins at `time` (s) with the mean `value` where `limit` is left at speed (N or N·m). `index`:
    /// that of the load in its structure's `loads`; `instant`: the index of the instant at that time.
    pub(super) fn new(
        load: &Load,
        index: usize,
        (value, limit): (f64, f64),
        time: f64,
        instant: usize,
    ) -> MeanOverload {
        let falls = limit < load.limit;
        MeanOverload {
            overload: Overload { limit, ..Overload::new(load, value, time) },
            load: index,
            instant,
            falls,
        }
    }

    /// Extends the overload to a later time (s), at which the mean is `value` (N or N·m); `instant`: the index of the
    /// instant at that time.
    pub(super) fn grow(&mut self, value: f64, time: f64, instant: usize) {
        if self.overload.grow(value, time) {
            self.instant = instant;
        }
    }

    /// Returns the failure. `shares`: the load at rest without friction, then with it, N or N·m, from which the message
    /// says how much slower the motion would hold; `None` where they are not known. `reserve`: the part of the limit
    /// that must be left, 0 to 1.
    pub(super) fn failure(&self, shares: Option<(f64, f64)>, reserve: f64) -> Failure {
        let Overload { kind, value, limit, .. } = self.overload;
        let words = |v: f64| quantity(v, kind.dimension());
        let allowed = (1.0 - reserve) * limit;
        let mut failure = self.overload.failure();
        if self.falls {
            failure.message += " at its speed";
        }
        if reserve > 0.0 {
            let percent = number(100.0 * reserve);
            failure.message += &format!(", {} with a reserve of {percent} %", words(allowed));
        }
        if let Some((weight, standing)) = shares {
            failure.message +=
                &format!("; {} at rest, {} of it without friction", words(standing), words(weight));
            if standing < allowed && value > allowed {
                // The inertial part falls with the square of the time that the motion takes.
                let slower = libm::sqrt((value - standing) / (allowed - standing));
                failure.message +=
                    &format!("; it would hold about {} times slower", number((slower * 10.0).ceil() / 10.0));
            }
        }
        failure
    }
}
