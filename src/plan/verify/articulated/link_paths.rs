//! The poses of all links in the world over the time of a plan, quick to ask for many times.
#![allow(non_snake_case)]

use super::{ClusterPaths, history};
use crate::geometry::Pose;
use crate::plan::{Plan, Tracks};
use crate::robot::Kinematics;
use nalgebra::UnitQuaternion;

/// The poses of all links of an articulated robot in the world over the time of its plan, as the judge found the way of
/// the base.
pub struct LinkPaths<'a> {
    tracks: &'a Tracks,
    /// The kinematics from each change of bonds on, by its time, s.
    kinematics: Vec<(f64, Kinematics)>,
    /// The world pose of the base module's body at moments, by their times, s.
    base: Vec<(f64, Pose)>,
    /// The paths of the parts of a robot that comes apart.
    clusters: Option<ClusterPaths<'a>>,
}

impl<'a> LinkPaths<'a> {
    /// Returns the poses of a plan; `None` for plans of other families. The base of a plan that is not valid keeps its
    /// pose.
    pub fn of(plan: &'a Plan) -> Option<LinkPaths<'a>> {
        let tracks = plan.body.tracks()?;
        let clusters = ClusterPaths::of(plan, tracks.duration);
        let moments = if clusters.is_some() { Vec::new() } else { history(plan, tracks.duration) };
        let mut times: Vec<f64> = tracks.events.iter().map(|event| event.time).collect();
        times.push(0.0);
        times.sort_by(f64::total_cmp);
        times.dedup();
        let compiled =
            |time: f64| (time, Kinematics::new(&tracks.robot, &tracks.bonds(time), tracks.robot.base));
        Some(LinkPaths {
            tracks,
            kinematics: times.into_iter().map(compiled).collect(),
            base: moments.into_iter().map(|moment| (moment.time, moment.base)).collect(),
            clusters,
        })
    }

    /// Returns the world pose of each link (`X_WL`, m) at a time (s), by the numbers of the links ([`Kinematics::link`]);
    /// at the instant of a change of bonds, those just after it.
    pub fn at(&self, time: f64) -> Vec<Pose> {
        let index = self.kinematics.partition_point(|(from, _)| *from <= time).saturating_sub(1);
        let kinematics = &self.kinematics[index].1;
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        match &self.clusters {
            Some(paths) => paths.place(time, &mut poses),
            None => {
                let state = self.tracks.state(time);
                kinematics.link_poses(&state.joints, &self.base_at(time), &mut poses);
            }
        }
        poses
    }

    /// Returns the world pose of the base module's body at a time (s), between two moments on the straight way and the
    /// shortest turn.
    fn base_at(&self, time: f64) -> Pose {
        let next = self.base.partition_point(|(at, _)| *at <= time);
        match (next.checked_sub(1).map(|last| self.base[last]), self.base.get(next)) {
            (Some((before, X)), Some((after, Y))) => {
                let part = (time - before) / (after - before);
                let p = X.translation.vector.lerp(&Y.translation.vector, part);
                // The mean of quaternions on the same side, of unit length again: moments are near to each other.
                let (q, r) = (X.rotation.into_inner(), Y.rotation.into_inner());
                let near = if q.dot(&r) < 0.0 { -r } else { r };
                Pose::from_parts(p.into(), UnitQuaternion::new_normalize(q.lerp(&near, part)))
            }
            (Some((_, X)), None) => X,
            (None, Some((_, Y))) => *Y,
            (None, None) => self.tracks.start.base,
        }
    }
}
