//! The path of a robot's base over a rollout, between its samples.

use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::robot::dynamics::Twist;

/// The path of a cluster's base over its rollout.
#[derive(Clone, Debug, Default)]
pub(super) struct BasePath {
    /// The world pose of the base module's body (`X_WB`, m) at each sample, as (time in s, pose), in order of time.
    pub poses: Vec<(f64, Pose)>,
}

impl BasePath {
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
