//! The path of a robot's base over a rollout, between its samples.

use super::sample::Sample;
use super::tolerances::Tolerances;
use crate::geometry::{Pose, Vec3};
use crate::robot::dynamics::Twist;

/// The path of a cluster's base over its rollout.
#[derive(Clone, Debug, Default)]
pub(super) struct BasePath {
    /// The world pose of the base module's body (`X_WB`, m) at each sample, as (time in s, pose), in order of time.
    pub poses: Vec<(f64, Pose)>,
    /// The parts of its way on which it goes astray if contacts slip, in order of time; for those who judge.
    pub astray: Vec<Astray>,
}

/// A part of the way of a robot over the ground, from one sample to the next, on which it goes astray if contacts slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Astray {
    /// The centre of mass in the world at its end, m.
    pub centre: Vec3,
    /// The turn by which the heading is off after it, for each unit of slip, rad.
    pub heading: f64,
    /// The distance by which the centre of mass is, without what follows from the heading, m.
    pub place: f64,
}

impl BasePath {
    /// Returns the path of a base that is at one pose (`X_WB`, m), at a time (s).
    pub(super) fn resting(time: f64, pose: Pose) -> BasePath {
        BasePath { poses: vec![(time, pose)], astray: vec![] }
    }

    /// Takes a sample, in order of time.
    pub(super) fn observe(&mut self, sample: &Sample) {
        self.poses.push((sample.time, sample.stance.base_pose(sample.model)));
        let span = sample.time - sample.before;
        let (heading, place) = (sample.spread.heading * span, sample.spread.place * span);
        if heading + place > 0.0 {
            let centre = sample.stance.world_point(&Vec3::zeros());
            self.astray.push(Astray { centre, heading, place });
        }
    }

    /// Returns (distance in m, angle in rad) by which a point that the robot carries, at `port` (m, in the world) at the end of
    /// the way, is off at most, for each unit of slip. An error of the heading swings all that is ahead.
    pub(super) fn astray_at(&self, port: &Vec3) -> (f64, f64) {
        let off = self.astray.iter().map(|part| {
            let ahead = (port - part.centre).xy().norm();
            (part.place + part.heading * ahead, part.heading)
        });
        off.fold((0.0, 0.0), |(distance, angle), (d, a)| (distance + d, angle + a))
    }

    /// Returns the pose at a time (s), on a straight line and one turn between the samples around it. Panics without
    /// samples.
    pub(super) fn at(&self, time: f64, tolerances: &Tolerances) -> Pose {
        let after = self.poses.partition_point(|(at, _)| *at < time).min(self.poses.len() - 1);
        let (end, last) = &self.poses[after];
        let Some((begin, first)) = after.checked_sub(1).map(|before| &self.poses[before]) else {
            return *last;
        };
        let part = ((time - begin) / (end - begin)).min(1.0);
        first.try_lerp_slerp(last, part, tolerances.nearest).unwrap_or(*last)
    }

    /// Returns the mean speed of the base between the samples before `index` and of `index`, which must not be the first, m/s;
    /// turning counts with one metre for a radian.
    pub(super) fn mean_speed(&self, index: usize) -> f64 {
        let ((before, from), (time, to)) = (&self.poses[index - 1], &self.poses[index]);
        let moved =
            (to.translation.vector - from.translation.vector).norm() + from.rotation.angle_to(&to.rotation);
        if time > before { moved / (time - before) } else { 0.0 }
    }

    /// Returns the mean twist of the base's frame from the last sample but one to the last, m/s and rad/s in the world; zero
    /// with fewer than two samples.
    pub(super) fn end_twist(&self) -> Twist {
        let [.., (before, from), (time, to)] = self.poses.as_slice() else { return Twist::default() };
        let span = time - before;
        if span <= 0.0 {
            return Twist::default();
        }
        Twist {
            linear: (to.translation.vector - from.translation.vector) / span,
            angular: (to.rotation * from.rotation.inverse()).scaled_axis() / span,
        }
    }
}
