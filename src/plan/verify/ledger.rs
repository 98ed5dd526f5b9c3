//! The record that the checks of all families write to: failures, excuses, notes, worst values.

use crate::plan::tolerances::TOLERANCES;
use crate::plan::verdict::WORST_VALUES;
use crate::plan::{Check, CheckKind, Exemption, ExemptionKind, Failure, Status, Verdict, Worst};
use crate::units::{Dimension, quantity};
use std::collections::BTreeMap;

/// The greatest number of failures that are reported one by one; further ones are counted.
const FAILURES_MAX: usize = 100;

/// The checks after whose failure a robot no longer moves as planned.
const ENDINGS: [CheckKind; 6] = [
    CheckKind::Collision,
    CheckKind::Docking,
    CheckKind::Connectedness,
    CheckKind::Closure,
    CheckKind::Ground,
    CheckKind::Stability,
];

/// The record of failures, excuses, notes and worst values to which all checks of a plan write, and of which the
/// verdict is made.
#[derive(Clone)]
pub(super) struct Ledger<'a> {
    /// The exemptions of the plan.
    exemptions: &'a [Exemption],
    /// The end of the plan, which is never excused, s.
    end: f64,
    /// For each exemption, true if a check needed it.
    used: Vec<bool>,
    /// Kinds of which an excuse was needed.
    excused: Vec<CheckKind>,
    /// Failures beyond [`FAILURES_MAX`].
    unreported: usize,
    /// The verdict as far as the checks have been made.
    pub verdict: Verdict,
}

impl<'a> Ledger<'a> {
    /// Returns an empty record for a plan with these exemptions, named by their indices, that ends at `end` (s).
    pub(super) fn new(exemptions: &'a [Exemption], end: f64) -> Ledger<'a> {
        let verdict = Verdict { duration: end, ..Verdict::default() };
        Ledger {
            exemptions,
            end,
            used: vec![false; exemptions.len()],
            excused: vec![],
            unreported: 0,
            verdict,
        }
    }

    /// Returns true if an exemption for whose kind `of` returns true covers the time `t` (s), and so excuses a
    /// failure of the check `kind` there; marks all such exemptions as needed. The end of the plan is never excused.
    pub(super) fn excuses(&mut self, kind: CheckKind, t: f64, of: impl Fn(&ExemptionKind) -> bool) -> bool {
        let mut excused = false;
        for (i, exemption) in self.exemptions.iter().enumerate() {
            if t < self.end && exemption.covers(t) && of(&exemption.kind) {
                (self.used[i], excused) = (true, true);
            }
        }
        if excused {
            self.note_excuse(kind);
        }
        excused
    }

    /// Returns true if a check so far needed an exemption for whose kind `of` returns true.
    pub(super) fn needed(&self, of: impl Fn(&ExemptionKind) -> bool) -> bool {
        self.exemptions.iter().zip(&self.used).any(|(exemption, used)| *used && of(&exemption.kind))
    }

    /// Marks an exemption, by its index in the plan's list, as needed by a check. Panics if there is none of that
    /// index.
    pub(super) fn use_exemption(&mut self, index: usize, kind: CheckKind) {
        self.used[index] = true;
        self.note_excuse(kind);
    }

    /// Notes that a check needed an excuse; if its status is known already, and not failed, it becomes exempt.
    fn note_excuse(&mut self, kind: CheckKind) {
        let known = self.verdict.checks.iter_mut();
        known
            .filter(|check| check.kind == kind && check.status != Status::Failed)
            .for_each(|check| check.status = Status::Exempt);
        if !self.excused.contains(&kind) {
            self.excused.push(kind);
        }
    }

    /// Records a failure; from the [`FAILURES_MAX`]-th on it is counted only.
    pub(super) fn fail(&mut self, failure: Failure) {
        if self.verdict.failures.len() < FAILURES_MAX {
            self.verdict.failures.push(failure);
        } else {
            self.unreported += 1;
        }
    }

    /// Records a failure of a check whose status is known already, which becomes failed.
    pub(super) fn fail_checked(&mut self, failure: Failure) {
        let of_kind = self.verdict.checks.iter_mut().filter(|check| check.kind == failure.kind);
        of_kind.for_each(|check| check.status = Status::Failed);
        self.fail(failure);
    }

    /// Records a note for the verdict, unless it is recorded already.
    pub(super) fn note(&mut self, note: String) {
        if !self.verdict.notes.contains(&note) {
            self.verdict.notes.push(note);
        }
    }

    /// Returns the failures recorded so far, in the order in which they were recorded, to add blame to them.
    pub(super) fn failures_mut(&mut self) -> &mut [Failure] {
        &mut self.verdict.failures
    }

    /// Records the status of a check: failed if there is a failure of its kind so far, exempt if one was excused, else
    /// `otherwise`.
    pub(super) fn check(&mut self, kind: CheckKind, otherwise: Status) {
        let failed = self.verdict.failures.iter().any(|f| f.kind == kind);
        let status = match (failed, self.excused.contains(&kind)) {
            (true, _) => Status::Failed,
            (false, true) => Status::Exempt,
            (false, false) => otherwise,
        };
        self.verdict.checks.push(Check { kind, status });
    }

    /// Adds the records of parts of the robot that were judged by themselves, with the exemptions of the same plan: all
    /// their failures, notes and events, the worst of their worst values, the sums of their samples and energy, and for
    /// each check the weakest status. Travel and heading stay as they are.
    pub(super) fn merge(&mut self, parts: Vec<Ledger>) {
        let mut checks: BTreeMap<CheckKind, Status> = BTreeMap::new();
        for part in parts {
            let verdict = part.verdict;
            for kind in WORST_VALUES {
                let own = (kind.of_mut)(&mut self.verdict);
                let Some(theirs) = (kind.of)(&verdict) else { continue };
                let worse = |a: f64, b: f64| if kind.greatest { a > b } else { a < b };
                if own.as_ref().is_none_or(|own| worse(theirs.value, own.value)) {
                    *own = Some(theirs.clone());
                }
            }
            for check in verdict.checks {
                let status = match checks.remove(&check.kind) {
                    Some(known) => weaker(known, check.status),
                    None => check.status,
                };
                checks.insert(check.kind, status);
            }
            verdict.failures.into_iter().for_each(|failure| self.fail(failure));
            verdict.notes.into_iter().for_each(|note| self.note(note));
            part.excused.into_iter().for_each(|kind| self.note_excuse(kind));
            self.used.iter_mut().zip(part.used).for_each(|(used, also)| *used |= also);
            self.unreported += part.unreported;
            let sum = &mut self.verdict;
            sum.samples += verdict.samples;
            sum.energy += verdict.energy;
            sum.events.extend(verdict.events);
        }
        self.verdict.checks.extend(checks.into_iter().map(|(kind, status)| Check { kind, status }));
    }

    /// Returns the time (s) from which the robot no longer moves as planned, with the check that fails there; `None` if it
    /// does to the end.
    pub(super) fn ended(&self) -> Option<(f64, CheckKind)> {
        let endings = self.verdict.failures.iter().filter(|failure| ENDINGS.contains(&failure.kind));
        let first = endings.min_by(|a, b| a.time.total_cmp(&b.time));
        first.map(|failure| (failure.time, failure.kind))
    }

    /// Drops failures of loads and travel that follow from others: those of a robot that before has collided, tipped
    /// over, fallen apart, missed a docking, torn a loop open or gone into the ground. The statuses of their checks
    /// then say from when on they were not checked.
    pub(super) fn drop_consequences(&mut self) {
        let Some((ended, cause)) = self.ended() else { return };
        let failures = &mut self.verdict.failures;
        let tips = failures.iter().any(|failure| failure.kind == CheckKind::Stability);
        let mut dropped = Vec::new();
        failures.retain(|failure| {
            let moot = match failure.kind {
                CheckKind::Torque | CheckKind::BondLoad | CheckKind::Deflection => failure.time >= ended,
                CheckKind::Balance => failure.time >= ended || tips,
                CheckKind::Traction => !failure.is_slide() || failure.time >= ended,
                _ => false,
            };
            if moot {
                dropped.push(failure.kind);
            }
            !moot
        });
        for check in &mut self.verdict.checks {
            let failed = failures.iter().any(|failure| failure.kind == check.kind);
            if dropped.contains(&check.kind) && !failed {
                check.status = Status::NotChecked(format!(
                    "from {} on {} fails",
                    quantity(ended, Dimension::TIME),
                    cause.name()
                ));
            }
        }
    }

    /// Sets values that are nothing but rounding to zero.
    fn without_rounding(&mut self) {
        let verdict = &mut self.verdict;
        let round = |value: &mut f64| {
            if value.abs() < TOLERANCES.reported_zero {
                *value = 0.0;
            }
        };
        for kind in WORST_VALUES {
            if let Some(worst) = (kind.of_mut)(verdict) {
                round(&mut worst.value);
            }
        }
        verdict.travel.iter_mut().chain([&mut verdict.heading]).for_each(round);
    }

    /// Returns the verdict: failures, events and checks in order, the indices of the exemptions that no check needed,
    /// and a note that counts the failures that are not listed.
    pub(super) fn finish(mut self) -> Verdict {
        self.verdict.failures.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.kind.cmp(&b.kind)));
        self.verdict.unneeded_exemptions = (0..self.used.len()).filter(|&i| !self.used[i]).collect();
        self.verdict.events.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.verdict.checks.sort_by_key(|check| check.kind);
        self.without_rounding();
        if self.unreported > 0 {
            self.note(format!("{} more failures are not listed", self.unreported));
        }
        self.verdict
    }
}

/// Returns the weaker of two statuses of one check, of two parts of a robot; the samples of both, if both have some.
fn weaker(a: Status, b: Status) -> Status {
    let strength = |status: &Status| match status {
        Status::Failed => 0,
        Status::Exempt => 1,
        Status::NotChecked(_) => 2,
        Status::Sampled(_) => 3,
        Status::WithinTolerance => 4,
        Status::Proved => 5,
        Status::NoLimit => 6,
    };
    match (a, b) {
        (Status::Sampled(a), Status::Sampled(b)) => Status::Sampled(a + b),
        (a, b) if strength(&b) < strength(&a) => b,
        (a, _) => a,
    }
}

/// Replaces the worst value so far by a new one if that is less, or if there is none yet. `time`: that of the new
/// value, s; `at`: a function that returns the names of the parts that it is about.
pub(super) fn keep_least(worst: &mut Option<Worst>, value: f64, time: f64, at: impl FnOnce() -> Vec<String>) {
    if worst.as_ref().is_none_or(|w| value < w.value) {
        *worst = Some(Worst { value, time, at: at() });
    }
}
