//! The input of a rollout: a plan, or one of its robots, with worlds, settings and tolerances.

use super::entry::Entry;
use super::sampling;
use super::tolerances::Tolerances;
use crate::plan::{Exemption, Plan, Settings, Tracks, WorldFrom, is_full};
use crate::robot::dynamics::Wrench;

/// A plan to roll out, with settings and tolerances. The plan must be valid.
#[derive(Clone, Copy)]
pub struct Rollout<'a> {
    /// The body of the plan: the robot, its state at the start, and the trajectories of its joints.
    pub tracks: &'a Tracks,
    /// The worlds that the plan assumes, in order of time.
    pub worlds: &'a [WorldFrom],
    /// The exemptions of the plan.
    pub exemptions: &'a [Exemption],
    /// The plan's settings of verification.
    pub settings: &'a Settings,
    /// The tolerances of the judge.
    pub tolerances: &'a Tolerances,
    /// A joint, by the number in its `JointId`, that is held from a time on (s), to find the command to blame; `None`:
    /// all joints move.
    pub held: Option<(usize, f64)>,
    /// The beginning of a robot in the middle of the plan, by docking or undocking; `None`: it begins with the plan.
    pub begin: Option<&'a Entry>,
    /// The end of the whole plan, s: later than that of `tracks` for a robot that comes apart before.
    pub end: f64,
    /// The robot in words, for messages.
    pub subject: &'a str,
    /// True if the height at which the robot is placed counts where there is no ground: it stands so to others.
    pub as_placed: bool,
    /// True if the base moves as momentum has it where there is no ground: one of several robots or parts, or among
    /// obstacles, under full dynamics. The base of a robot alone stays in place, and what moves is seen from it.
    pub floats: bool,
}

impl<'a> Rollout<'a> {
    /// Returns the rollout of a whole plan, whose body is `tracks`: all its joints move.
    pub fn of(plan: &'a Plan, tracks: &'a Tracks, tolerances: &'a Tolerances) -> Rollout<'a> {
        let surrounded = is_surrounded(tracks);
        Rollout {
            tracks,
            worlds: &plan.worlds,
            exemptions: &plan.exemptions,
            settings: &plan.settings,
            tolerances,
            held: None,
            begin: None,
            end: tracks.duration,
            subject: "the robot",
            as_placed: surrounded,
            floats: surrounded && is_full(&plan.worlds),
        }
    }

    /// Returns the time at which the robot begins, s.
    pub(super) fn from(&self) -> f64 {
        self.begin.map_or(0.0, |entry| entry.time)
    }

    /// Returns the momentum with which the robot begins, as in [`Entry`].
    pub(super) fn momentum(&self) -> Wrench {
        self.begin.map_or_else(Wrench::default, |entry| entry.momentum)
    }

    /// Returns the instants (s) that are samples whatever the settings are; see [`sampling::instants`].
    pub(super) fn instants(&self) -> Vec<f64> {
        sampling::instants(self.tracks, self.from(), self.worlds, self.exemptions)
    }

    /// Returns true if the plan is judged under full dynamics: in one of its worlds, and then in all.
    pub(super) fn is_full(&self) -> bool {
        is_full(self.worlds)
    }
}

/// Returns true if a plan is of several robots, of one among obstacles, or of one that several have become by docking: where
/// they are placed then counts.
pub(super) fn is_surrounded(tracks: &Tracks) -> bool {
    let start = &tracks.start;
    !start.clusters.is_empty() || !start.misalignments.is_empty() || !tracks.obstacles.is_empty()
}
