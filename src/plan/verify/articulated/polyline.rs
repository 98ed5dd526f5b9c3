//! Positions of joints at instants, with straight lines between them, as a motion for conservative advancement.

use super::motion_bounds::{Interval, JointMotion};

/// The positions of all joints at instants in order of time, linear in time between them; before the first instant
/// and after the last the joints are at rest.
#[derive(Clone, Debug, Default)]
pub(super) struct Polyline {
    times: Vec<f64>,
    /// The positions, rad or m: those of all joints at the first instant, then at the second, and so on.
    positions: Vec<f64>,
    joints: usize,
}

impl Polyline {
    /// Appends an instant at `time` (s) with the positions of all joints (rad or m), by the number in their
    /// [`crate::robot::JointId`]. If the last instant is not before that time, it is replaced.
    pub(super) fn push(&mut self, time: f64, positions: &[f64]) {
        if self.times.last().is_some_and(|last| *last >= time) {
            self.times.pop();
            self.positions.truncate(self.times.len() * self.joints);
        }
        self.joints = positions.len();
        self.times.push(time);
        self.positions.extend_from_slice(positions);
    }

    /// Returns the times of the instants, s, ascending.
    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the instants in order of time, each as (time in s, positions of all joints in rad or m).
    pub(super) fn instants(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.times.iter().copied().zip(self.positions.chunks_exact(self.joints.max(1)))
    }

    /// Returns the number of joints; 0 before the first instant.
    pub(super) fn joint_count(&self) -> usize {
        self.joints
    }

    /// Returns the interval `from..to` (s), which is never smooth: rates jump at instants.
    pub(super) fn interval(&self, from: f64, to: f64) -> Interval {
        Interval { from, to, middle: (from + to) / 2.0, half: (to - from) / 2.0, smooth: false }
    }

    /// Returns position and rate of a joint in the middle of an interval, with a bound on the rate's deviation;
    /// `joint`: the number in its [`JointId`](crate::robot::JointId). Panics if there are no instants.
    pub(super) fn over(&self, joint: usize, interval: &Interval) -> JointMotion {
        let next = self.times.partition_point(|time| *time <= interval.middle);
        let rate = self.rate(joint, next);
        let at = match next.checked_sub(1) {
            None => self.position(joint, 0),
            Some(before) => self.position(joint, before) + rate * (interval.middle - self.times[before]),
        };
        let first = self.times.partition_point(|time| *time <= interval.from);
        let last = self.times.partition_point(|time| *time < interval.to);
        let deviation =
            (first..=last).map(|piece| (self.rate(joint, piece) - rate).abs()).fold(0.0, f64::max);
        JointMotion { at, rate, deviation }
    }

    fn position(&self, joint: usize, instant: usize) -> f64 {
        self.positions[instant * self.joints + joint]
    }

    /// Returns the rate of a joint, rad/s or m/s, in the piece that ends at the instant of this index; 0 before the
    /// first and after the last.
    fn rate(&self, joint: usize, next: usize) -> f64 {
        if next == 0 || next >= self.times.len() {
            return 0.0;
        }
        let change = self.position(joint, next) - self.position(joint, next - 1);
        change / (self.times[next] - self.times[next - 1])
    }
}
