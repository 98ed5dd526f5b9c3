//! Blame for failures: the actions whose joint, held still from its start, removes the failure (a
//! counterfactual rollout).
//!
//! The plan is rolled out again up to the failure with the joint held, so that the answer takes everything into
//! account: the contacts of the robot, its tip-overs, and the loads that it then has.

use super::base_motion::penetrating_contact;
use super::docking;
use super::rollout::{Checkpoint, roll_out};
use super::rollout_input::Rollout;
use super::sample::Sample;
use super::stability;
use super::torque;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, Failure, Tracks};
use crate::robot::{JointId, JointOwner};

/// The greatest number of actions that are blamed for one failure.
pub(super) const BLAMED_MAX: usize = 3;
/// The greatest number of actions that are held still, one after the other, for one failure.
const TRIED_MAX: usize = 24;

/// The number of failures for which the blame is sought; the rest name the actions that move at that time.
const FAILURES_MAX: usize = 12;

/// The number of segments of each joint that are examined, the latest first.
const SEGMENTS_EACH: usize = 2;

/// An action of the plan that may be to blame for a failure.
pub(super) struct Candidate {
    /// The joint that the action moves, by the number in its [`JointId`].
    pub joint: usize,
    /// The time at which the segment of the action begins, s from the start of the plan.
    pub start: f64,
    /// The cause of the segment: the command in the source.
    pub cause: CauseId,
    /// True if it moves at the time of the failure.
    pub moving: bool,
}

/// Fills in the actions to blame for each failure that names none. An action is to blame if the failure is gone once
/// its joint is held still from its beginning on (a counterfactual rollout); at most [`BLAMED_MAX`] are named. If
/// there is none, those that move at the time of the failure are, else the lines that set the robot up at the start.
/// Rollouts are repeated for the first [`FAILURES_MAX`] failures only, and not for ranges, collisions, and loads
/// under full dynamics; faults of the form and slides down a slope, to which the ground is to blame, get none.
/// `checkpoints`: states of the rollout, in order of time, from which it is repeated.
pub(super) fn blame(rollout: &Rollout, checkpoints: &[Checkpoint], failures: &mut [Failure]) {
    let mut sought = 0;
    for failure in failures.iter_mut().filter(|f| f.blame.is_empty() && !f.blames_start) {
        let suspects = suspects(rollout.tracks, failure.time);
        if failure.kind == CheckKind::Form || failure.is_slide() {
            continue;
        }
        // Loads in motion depend on all that moves.
        let dynamic = [CheckKind::Torque, CheckKind::BondLoad, CheckKind::Balance, CheckKind::Traction];
        let together = rollout.is_full() && dynamic.contains(&failure.kind);
        sought += 1;
        let alone = !together && sought <= FAILURES_MAX;
        if alone && ![CheckKind::JointRange, CheckKind::Collision].contains(&failure.kind) {
            for suspect in suspects.iter().take(TRIED_MAX) {
                let named = failure.blame.contains(&suspect.cause);
                if !named && removes(rollout, checkpoints, suspect, failure) {
                    failure.blame.push(suspect.cause);
                }
                if failure.blame.len() == BLAMED_MAX {
                    break;
                }
            }
        }
        if failure.blame.is_empty() && failure.time > rollout.from() {
            // No one alone: those who move then do it together.
            let moving = suspects.iter().filter(|s| s.moving).map(|s| s.cause);
            failure.blame = distinct(moving);
        }
        if let Some(entry) = rollout.begin.filter(|_| failure.blame.is_empty()) {
            failure.blame = distinct(entry.causes.iter().copied());
        }
        if failure.blame.is_empty() {
            failure.blames_start = true;
            failure.blame = of_start(rollout.tracks, failure);
        }
    }
}

/// Returns the actions that begin before a time (s): of each joint the last two, latest first, those of equal
/// beginning by joint.
pub(super) fn suspects(tracks: &Tracks, t: f64) -> Vec<Candidate> {
    let mut found = Vec::new();
    for track in &tracks.tracks {
        let begun = track.segments.partition_point(|s| s.start < t);
        for segment in track.segments[..begun].iter().rev().take(SEGMENTS_EACH) {
            found.push(Candidate {
                joint: track.joint.0 as usize,
                start: segment.start,
                cause: segment.cause,
                moving: segment.end >= t,
            });
        }
    }
    found.sort_by(|a, b| b.start.total_cmp(&a.start).then(a.joint.cmp(&b.joint)));
    found
}

/// Returns true if the failure is gone when the candidate's joint is held from the start of its segment on.
fn removes(rollout: &Rollout, checkpoints: &[Checkpoint], suspect: &Candidate, failure: &Failure) -> bool {
    // Motion from before the robot came off another stays as it was.
    let held = Rollout { held: Some((suspect.joint, suspect.start.max(rollout.from()))), ..*rollout };
    let from = checkpoints.iter().rev().find(|w| w.time <= suspect.start);
    let until = rollout.tracks.duration.min(failure.time + rollout.settings.sample);
    let mut standing = stability::Monitor::new(rollout.settings, rollout.tolerances);
    let mut ledger = Ledger::new(rollout.exemptions, rollout.end);
    let mut failed = false;
    roll_out(held, from, rollout.tracks.duration, &mut |sample, _| {
        if sample.time > until {
            return false;
        }
        let late = sample.time >= failure.time;
        failed |= match failure.kind {
            CheckKind::Stability => {
                standing.observe(sample, &mut ledger).is_some() || (late && standing.lacking())
            }
            _ => late && still(sample, failure, rollout, &mut ledger),
        };
        // A later sample says nothing about a load that was too great for a moment.
        !failed && (failure.kind == CheckKind::Stability || !late)
    });
    !failed
}

/// Returns true if the check that failed fails in this sample, too.
fn still(sample: &Sample, failure: &Failure, rollout: &Rollout, ledger: &mut Ledger) -> bool {
    match failure.kind {
        CheckKind::Torque | CheckKind::BondLoad => {
            torque::overloaded(sample, &failure.at[0], rollout.tolerances, ledger)
        }
        CheckKind::Closure => docking::is_open(sample, &failure.at[0], rollout.tolerances),
        CheckKind::Ground => penetrating_contact(sample).is_some(),
        _ => true,
    }
}

/// Returns the `set` lines of the modules concerned, or all; or else the `connect` lines.
fn of_start(tracks: &Tracks, failure: &Failure) -> Vec<CauseId> {
    let owners: Vec<JointOwner> = tracks.robot.joints().collect();
    let concerned = |joint: JointId| match owners[joint.0 as usize] {
        JointOwner::Module { module, .. } => {
            let name = &tracks.robot.modules[module].name;
            failure.at.iter().any(|at| at.strip_prefix(name.as_str()).is_some_and(|r| !r.starts_with('[')))
        }
        JointOwner::Bond(_) => false,
    };
    let near = tracks.start_causes.iter().filter(|(joint, _)| concerned(*joint)).map(|c| c.1);
    let all = tracks.start_causes.iter().map(|c| c.1);
    let bonds = tracks.bond_causes.iter().map(|c| c.1);
    [distinct(near), distinct(all), distinct(bonds)].into_iter().find(|c| !c.is_empty()).unwrap_or_default()
}

/// Returns the first [`BLAMED_MAX`] different causes, in order.
pub(super) fn distinct(causes: impl Iterator<Item = CauseId>) -> Vec<CauseId> {
    let mut found = Vec::new();
    for cause in causes {
        if !found.contains(&cause) && found.len() < BLAMED_MAX {
            found.push(cause);
        }
    }
    found
}
