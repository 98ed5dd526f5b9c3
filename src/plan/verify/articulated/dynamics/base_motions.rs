//! The instants at which loads along a rollout are determined, and the motion of the base at them.

use super::super::model::Model;
use super::super::rollout_input::Rollout;
use super::bursts::Bursts;
use super::equilibrium::{self, Warm};
use super::posed::{Posed, Situation, Support, turned};
use super::recorder::{Recorded, with_instants};
use super::slide::Slide;
use crate::geometry::Vec3;
use crate::robot::dynamics::{Dynamics, Twist};

/// The instants at which loads are determined, with what poses the robot at them.
pub(super) struct Instants<'a> {
    pub rollout: &'a Rollout<'a>,
    /// The attitudes at the instants, in order of time.
    pub recorded: Vec<Recorded>,
    /// The length of the window of each instant, over which velocities, accelerations and loads are means, s.
    pub windows: Vec<f64>,
    dynamics: Dynamics,
    /// The robot with each set of bonds that held, by [`Recorded::bonds`].
    pub models: Vec<Model<'a>>,
}

impl<'a> Instants<'a> {
    /// Returns the recorded instants, and those within short motions. `models`: the robot with each set of bonds that held.
    pub(super) fn new(
        rollout: &'a Rollout<'a>,
        recorded: Vec<Recorded>,
        bursts: &Bursts,
        models: Vec<Model<'a>>,
    ) -> Instants<'a> {
        let recorded = with_instants(recorded, &bursts.instants());
        let windows = recorded.iter().map(|instant| bursts.window(instant.time)).collect();
        Instants { rollout, recorded, windows, dynamics: Dynamics::new(&rollout.tracks.robot), models }
    }

    /// Returns the robot at the instant of an index, with the means over the window of the instant.
    pub(super) fn posed(&self, index: usize) -> Posed<'_> {
        let recorded = &self.recorded[index];
        let model = &self.models[recorded.bonds];
        let at = (recorded.time, self.windows[index]);
        Posed::new(model, &self.dynamics, self.rollout, at, (&recorded.R, recorded.yaw))
    }

    /// Returns true if the instant of an index is the first, or the one at which other bonds hold than before.
    pub(super) fn begins(&self, index: usize) -> bool {
        index == 0 || self.recorded[index - 1].bonds != self.recorded[index].bonds
    }
}

/// The velocities of the base's frame at the instants, in the level axes of the start, found one after the other: each search begins
/// from the one before.
#[derive(Default)]
pub(super) struct BaseVelocities {
    /// The velocities found so far, m/s and rad/s.
    found: Vec<Twist>,
    warm: Warm,
    /// The instants so far at which the robot slides down a slope, in order of time.
    pub slides: Vec<Slide>,
}

impl BaseVelocities {
    /// Finds the velocities of the next instants, at most so many. On the ground each is the one at which friction is in balance without
    /// inertia, without ground the one at which the robot has no momentum, and 0 for a base that keeps its place.
    pub(super) fn follow(&mut self, instants: &Instants, most: usize) {
        let from = self.found.len();
        for index in from..instants.recorded.len().min(from.saturating_add(most)) {
            crate::interrupt::checkpoint();
            let instant = &instants.recorded[index];
            if instants.begins(index) {
                self.warm = Warm::default();
            }
            let posed = instants.posed(index);
            let twist = match Support::of(&instant.world) {
                Support::Stays | Support::Held => None,
                Support::Floats => posed.drifting(&instants.rollout.momentum()),
                Support::Settles => {
                    let situation = Situation::at_rest(&posed, &instant.world);
                    let found = equilibrium::solve(&situation, None, &mut self.warm);
                    self.slides.extend(found.as_ref().and_then(|f| Slide::of(instant.time, &situation, f)));
                    found.map(|found| posed.of_base(&found.twist))
                }
            };
            self.found.push(turned(&twist.unwrap_or_default(), instant.yaw));
        }
    }

    /// Returns velocity (m/s, rad/s) and acceleration (m/s², rad/s²) of the base's frame at the instant of an index, in the level axes
    /// of the instant; the acceleration is the difference quotient of the velocity over the window. `None` while the velocities
    /// that it takes are not found.
    pub(super) fn motion(&self, instants: &Instants, index: usize) -> Option<(Twist, Twist)> {
        let instant = instants.recorded.get(index)?;
        let window = instants.windows[index];
        let half = window / 2.0;
        let (before, after) =
            (self.at(instants, instant.time - half)?, self.at(instants, instant.time + half)?);
        let acceleration = Twist {
            linear: (after.linear - before.linear) / window,
            angular: (after.angular - before.angular) / window,
        };
        let velocity = self.found.get(index)?;
        Some((turned(velocity, -instant.yaw), turned(&acceleration, -instant.yaw)))
    }

    /// Returns the velocity of the base at a time (s), interpolated between those of the instants; zero before the first of
    /// them, unless it is a part that comes off another in motion, and from the last of them on. `None` where they are not found yet.
    fn at(&self, instants: &Instants, time: f64) -> Option<Twist> {
        let recorded = &instants.recorded;
        let next = recorded.partition_point(|r| r.time <= time);
        if next == 0 || next == recorded.len() {
            let begins =
                next == 0 && instants.rollout.begin.is_some_and(|entry| entry.twist != Twist::default());
            return if begins { self.found.first().copied() } else { Some(Twist::default()) };
        }
        let (a, b) = (&recorded[next - 1], &recorded[next]);
        let part = (time - a.time) / (b.time - a.time);
        let mix = |x: &Vec3, y: &Vec3| x * (1.0 - part) + y * part;
        let (from, to) = (self.found.get(next - 1)?, self.found.get(next)?);
        Some(Twist { linear: mix(&from.linear, &to.linear), angular: mix(&from.angular, &to.angular) })
    }
}
