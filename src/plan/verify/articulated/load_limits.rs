//! Loads of joints, motors and bonds against their limits: overloads, margins, exemptions, and the work of the motors.

use super::statics::{Load, LoadKind, Structure};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, ExemptionKind, Failure};
use crate::units::{Dimension, quantity};

/// A load that is over its limit at some samples, with its greatest value.
#[derive(Clone, Debug)]
pub(super) struct Overload {
    /// The name of the overloaded load, as [`Load::name`] gives it.
    pub name: String,
    /// The kind of the load: a joint's, a motor's or a bond's.
    pub kind: LoadKind,
    /// The time of the first sample over the limit, s.
    pub since: f64,
    /// The time of the last sample over the limit, s.
    pub until: f64,
    /// The greatest load so far, N·m or N.
    pub value: f64,
    /// The limit of the load, N·m or N.
    pub limit: f64,
}

impl LoadKind {
    /// Returns the check that judges loads of this kind: torque for joints and motors, bond load for bonds.
    pub(super) fn check(self) -> CheckKind {
        match self {
            LoadKind::Joint { .. } => CheckKind::Torque,
            LoadKind::Pull | LoadKind::Moment => CheckKind::BondLoad,
        }
    }

    /// Returns the physical dimension of loads of this kind: torque (N·m) or force (N).
    pub(super) fn dimension(self) -> Dimension {
        match self {
            LoadKind::Joint { turns: true, .. } | LoadKind::Moment => Dimension::TORQUE,
            LoadKind::Joint { turns: false, .. } | LoadKind::Pull => Dimension::FORCE,
        }
    }
}

impl Structure {
    /// Returns true if the robot has a load with a limit that this check judges, [`CheckKind::Torque`] or
    /// [`CheckKind::BondLoad`].
    pub(super) fn has_limits(&self, check: CheckKind) -> bool {
        self.loads.iter().any(|load| load.kind.check() == check)
    }
}

impl Overload {
    /// Returns the overload of a load that first exceeds its limit at a time (s), with the value `value` (N·m or N).
    pub(super) fn new(load: &Load, value: f64, time: f64) -> Overload {
        Overload {
            name: load.name.clone(),
            kind: load.kind,
            since: time,
            until: time,
            value,
            limit: load.limit,
        }
    }

    /// Returns true if this is the overload of a load: if names and kinds agree.
    pub(super) fn is_of(&self, load: &Load) -> bool {
        self.name == load.name && self.kind == load.kind
    }

    /// Extends the overload to a later time (s) at which the load is `value` (N·m or N). Returns true if that is the
    /// greatest so far.
    pub(super) fn grow(&mut self, value: f64, time: f64) -> bool {
        self.until = time;
        let greater = value > self.value;
        if greater {
            self.value = value;
        }
        greater
    }

    /// Returns the failure of the check of torques or bond loads that this overload is, without blame.
    pub(super) fn failure(&self) -> Failure {
        let what = match self.kind {
            LoadKind::Joint { .. } => "would have to hold",
            LoadKind::Pull => "is pulled apart with",
            LoadKind::Moment => "is bent with",
        };
        let words = |v| quantity(v, self.kind.dimension());
        Failure {
            kind: self.kind.check(),
            time: self.since,
            until: Some(self.until),
            at: vec![self.name.clone()],
            message: format!(
                "{} {what} up to {}; it holds {}",
                self.name,
                words(self.value),
                words(self.limit)
            ),
            value: self.value,
            limit: self.limit,
            blame: vec![],
            blames_start: false,
        }
    }
}

/// Takes the margin of a load, 1 less its ratio to its limit, at a time (s) into the verdict, if it is the least so
/// far of joints and motors, or of bonds.
pub(super) fn keep_margin(load: &Load, ratio: f64, time: f64, ledger: &mut Ledger) {
    let least = match load.kind {
        LoadKind::Joint { .. } => &mut ledger.verdict.torque_margin,
        LoadKind::Pull | LoadKind::Moment => &mut ledger.verdict.bond_margin,
    };
    keep_least(least, 1.0 - ratio, time, || vec![load.name.clone()]);
}

/// Returns true if an exemption of the plan excuses the overload of a load at a time (s), and marks that exemption as
/// needed. Overloads of bonds are never excused.
pub(super) fn is_excused(load: &Load, time: f64, ledger: &mut Ledger) -> bool {
    let LoadKind::Joint { joint, .. } = load.kind else { return false };
    let of = |kind: &ExemptionKind| match kind {
        ExemptionKind::Overload(only) => only.is_none_or(|j| j as usize == joint),
        _ => false,
    };
    ledger.excuses(CheckKind::Torque, time, of)
}

/// Adds a note to the verdict if one of the structures has motors whose efforts do not follow from those of their
/// joints, and so are not checked.
pub(super) fn note_open_motors<'s>(mut structures: impl Iterator<Item = &'s Structure>, ledger: &mut Ledger) {
    if structures.any(|structure| structure.motors_open) {
        ledger.note("torques of motors that are not as many as their joints were not checked".to_owned());
    }
}

/// The positive mechanical work that the motors of a robot do along a plan; negative work is not regained.
#[derive(Clone, Debug, Default)]
pub(super) struct MotorWork {
    /// The positions (rad or m) and efforts (N·m or N) of all joints when they were last taken in.
    before: Option<(Vec<f64>, Vec<f64>)>,
    energy: f64,
}

impl MotorWork {
    /// Adds the work since the call before, as mean effort times displacement of each joint where that is positive.
    /// `joints`: the positions (rad or m) of all joints now; `efforts`: the efforts (N·m or N) of their motors now.
    pub(super) fn add(&mut self, joints: Vec<f64>, efforts: Vec<f64>) {
        if let Some((joints_before, efforts_before)) = &self.before {
            for (joint, effort) in efforts.iter().enumerate() {
                let mean = (effort + efforts_before[joint]) / 2.0;
                self.energy += (mean * (joints[joint] - joints_before[joint])).max(0.0);
            }
        }
        self.before = Some((joints, efforts));
    }

    /// Returns the work added so far, J.
    pub(super) fn energy(&self) -> f64 {
        self.energy
    }
}
