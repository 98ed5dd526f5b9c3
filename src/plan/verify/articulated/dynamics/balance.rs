//! The balance of a robot in motion: the ground's forces must suffice, near the attitude in which the robot is placed.

use super::tolerances::PARAMETERS;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure};
use crate::units::{Dimension, quantity, rounded};

/// The imbalance of a robot over a rollout: motions in time tell what follows from it.
pub(in super::super) struct Imbalance {
    /// True if loads make the base lean far before the ground balances it.
    pub(super) leans: bool,
    /// The instants at which no forces of the ground hold the robot; `None` if some do at all.
    pub(super) unbalanced: Option<Unbalanced>,
}

/// The instants at which no forces of the ground hold a robot.
pub(super) struct Unbalanced {
    /// The first and the last time, s.
    times: [f64; 2],
    /// The greatest mean imbalance, as a part of the weight.
    worst: f64,
    /// The longest time at a stretch, from the instant before it to that after it, s; infinite if it lasts to the end of the plan.
    pub(super) longest: f64,
}

/// The balance of a robot from instant to instant.
#[derive(Default)]
pub(super) struct Balance {
    /// The first and the last time (s) at which the base is not balanced and nothing excuses it, and its greatest mean
    /// imbalance as a part of the weight; `None` if there is none.
    unbalanced: Option<(f64, f64, f64)>,
    /// The last time at which the base was balanced, s.
    balanced_at: f64,
    /// True if it has not been balanced since.
    open: bool,
    /// The longest time from such an instant to the next one with others in between, s.
    longest: f64,
    /// True if the base is not balanced near a step of velocity, which is not a failure.
    pub(super) stepped: bool,
    /// The time since which the robot leans before the ground balances it, s; `None` while it does not.
    leans_since: Option<f64>,
    /// True if it once leaned so for longer than `lean_time`: motion in time tells how far.
    leans: bool,
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
        if unbalanced || self.open {
            self.longest = self.longest.max(time - self.balanced_at);
        }
        self.open = unbalanced;
        if !unbalanced {
            self.balanced_at = time;
        }
    }

    /// Returns what was found over a rollout.
    pub(super) fn into_imbalance(self) -> Imbalance {
        let longest = if self.open { f64::INFINITY } else { self.longest };
        let unbalanced =
            self.unbalanced.map(|(since, until, worst)| Unbalanced { times: [since, until], worst, longest });
        Imbalance { leans: self.leans, unbalanced }
    }
}

impl Unbalanced {
    /// Returns the failure of a robot that tips.
    pub(super) fn failure(&self) -> Failure {
        let part = rounded(self.worst, 3);
        Failure {
            kind: CheckKind::Balance,
            time: self.times[0],
            until: Some(self.times[1]),
            at: vec![],
            message: format!(
                "no forces of the ground hold the robot in motion: {part} of its weight is not balanced, so it tips"
            ),
            value: self.worst,
            limit: PARAMETERS.imbalance_max,
            blame: vec![],
            blames_start: false,
        }
    }

    /// Returns the note on a robot that stays upright all the same.
    pub(super) fn note(&self) -> String {
        let [time, longest] = [self.times[0], self.longest].map(|time| quantity(time, Dimension::TIME));
        let part = rounded(self.worst, 3);
        format!(
            "no forces of the ground balance {part} of the weight from {time} on, for at most {longest} at a stretch: in motions in \
             time it stays upright; loads then are those of a base that is held"
        )
    }
}
