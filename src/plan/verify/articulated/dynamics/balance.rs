//! The balance of a robot in motion: the ground's forces must suffice, near the attitude in which the robot is placed.

use super::tolerances::PARAMETERS;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure};
use crate::units::rounded;

/// The balance of a robot from instant to instant.
#[derive(Default)]
pub(super) struct Balance {
    /// The first and the last time (s) at which the base is not balanced and nothing excuses it, and its greatest mean
    /// imbalance as a part of the weight; `None` if there is none.
    unbalanced: Option<(f64, f64, f64)>,
    /// True if the base is not balanced near a step of velocity, which is not a failure.
    pub(super) stepped: bool,
    /// The time since which the robot leans before the ground balances it, s; `None` while it does not.
    leans_since: Option<f64>,
    /// True if it once leaned so for longer than `lean_time`: motion in time tells how far.
    pub(super) leans: bool,
}

impl Balance {
    /// Follows the robot to an instant (s). `lean`: the angle by which it leans until the ground balances it, as
    /// [`Loads`](super::loads::Loads) has it, rad; `None` where its loads are not known.
    pub(super) fn follow(&mut self, time: f64, lean: Option<f64>) {
        if lean.is_none_or(|lean| lean <= PARAMETERS.timed_lean) {
            self.leans_since = None;
            return;
        }
        self.leans |= time - *self.leans_since.get_or_insert(time) >= PARAMETERS.lean_time;
    }

    /// Compares the mean imbalance over a window about a time (s) with its limit. `near_step`: a joint changes its speed at
    /// once there.
    pub(super) fn compare(&mut self, time: f64, imbalance: f64, near_step: bool, ledger: &mut Ledger) {
        let unbalanced = imbalance > PARAMETERS.imbalance_max;
        // A robot that tips over an edge is not balanced in between.
        let allowed = |kind: &ExemptionKind| matches!(kind, ExemptionKind::Balance | ExemptionKind::Unstable);
        if unbalanced && near_step {
            self.stepped = true;
        } else if unbalanced && !ledger.excuses(CheckKind::Balance, time, allowed) {
            let (since, _, worst) = self.unbalanced.unwrap_or((time, time, 0.0));
            self.unbalanced = Some((since, time, imbalance.max(worst)));
        }
    }

    /// Returns the failure of a robot that no forces of the ground hold; `None` if some do.
    pub(super) fn failure(&self) -> Option<Failure> {
        let (since, until, worst) = self.unbalanced?;
        let part = rounded(worst, 3);
        Some(Failure {
            kind: CheckKind::Balance,
            time: since,
            until: Some(until),
            at: vec![],
            message: format!(
                "no forces of the ground hold the robot in motion: {part} of its weight is not balanced, so it tips"
            ),
            value: worst,
            limit: PARAMETERS.imbalance_max,
            blame: vec![],
            blames_start: false,
        })
    }
}
