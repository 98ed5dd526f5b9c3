//! A load over its limit, and its words.

use super::super::statics::{Load, LoadKind};
use super::tolerances::PARAMETERS;
use crate::plan::{CheckKind, Failure};
use crate::units::{Dimension, number, quantity};

/// A load whose mean over a window of time is over what it may be.
pub(super) struct Overload {
    /// The name of the load.
    pub name: String,
    /// Its kind.
    pub kind: LoadKind,
    /// Its index in the structure.
    pub load: usize,
    /// The index of the instant in the middle of the window in which its mean is greatest.
    pub instant: usize,
    since: f64,
    until: f64,
    value: f64,
    limit: f64,
}

impl Overload {
    /// Returns an overload of `value` (N or N·m) that begins at `time` (s), the time of the instant of this index.
    pub(super) fn new(load: &Load, index: usize, value: f64, time: f64, instant: usize) -> Overload {
        Overload {
            name: load.name.clone(),
            kind: load.kind,
            load: index,
            instant,
            since: time,
            until: time,
            value,
            limit: load.limit,
        }
    }

    /// Takes in the load at another time (s).
    pub(super) fn grow(&mut self, value: f64, time: f64, instant: usize) {
        self.until = time;
        if value > self.value {
            (self.value, self.instant) = (value, instant);
        }
    }

    /// Returns the failure. `shares`: the load at rest without friction and with it, N or N·m; `None` where they are
    /// not known.
    pub(super) fn failure(&self, shares: Option<(f64, f64)>) -> Failure {
        let (kind, dimension, what) = match self.kind {
            LoadKind::Joint { turns: true, .. } => {
                (CheckKind::Torque, Dimension::TORQUE, "would have to hold")
            }
            LoadKind::Joint { turns: false, .. } => {
                (CheckKind::Torque, Dimension::FORCE, "would have to hold")
            }
            LoadKind::Pull => (CheckKind::BondLoad, Dimension::FORCE, "is pulled apart with"),
            LoadKind::Moment => (CheckKind::BondLoad, Dimension::TORQUE, "is bent with"),
        };
        let words = |v: f64| quantity(v, dimension);
        let allowed = (1.0 - PARAMETERS.reserve) * self.limit;
        let mut message = format!(
            "{} {what} up to {}; it holds {}, {} with a reserve of {} %",
            self.name,
            words(self.value),
            words(self.limit),
            words(allowed),
            number(100.0 * PARAMETERS.reserve)
        );
        if let Some((weight, standing)) = shares {
            message += &format!("; {} at rest, {} of it without friction", words(standing), words(weight));
            if standing < allowed && self.value > allowed {
                // The inertial part falls with the square of the time that the motion takes.
                let slower = libm::sqrt((self.value - standing) / (allowed - standing));
                message +=
                    &format!("; it would hold about {} times slower", number((slower * 10.0).ceil() / 10.0));
            }
        }
        Failure {
            kind,
            time: self.since,
            until: Some(self.until),
            at: vec![self.name.clone()],
            message,
            value: self.value,
            limit: self.limit,
            blame: vec![],
            blames_start: false,
        }
    }
}
