//! The motion of the base of a robot that floats: nothing acts on it from outside, so that it keeps its linear and its
//! angular momentum whatever its joints do.

use super::model::Model;
use super::rollout_input::Rollout;
use super::stance::Stance;
use super::tolerances::Tolerances;
use crate::geometry::{Mat3, Pose, Vec3};
use crate::plan::{Ground, Settings, World};
use crate::robot::dynamics::{Dynamics, Twist, Wrench};
use nalgebra::UnitQuaternion;

/// The rounds by which the pose in the middle of a step is found.
const ROUNDS: usize = 3;

/// A robot that floats with a momentum, seen from a frame that falls with it where there is gravity.
pub(super) struct Floating {
    /// The momentum (N·s), and the angular momentum about the centre of mass (N·m·s), in the world.
    momentum: Wrench,
    dynamics: Dynamics,
}

impl Floating {
    /// Returns the motion of the robot of a rollout in a world, with a momentum, as in [`Entry`](super::entry::Entry);
    /// `None` where its base does not float.
    pub(super) fn of(rollout: &Rollout, world: &World, momentum: Wrench) -> Option<Floating> {
        let floats = rollout.floats && world.ground == Ground::Off;
        floats.then(|| Floating { momentum, dynamics: Dynamics::new(&rollout.tracks.robot) })
    }

    /// Returns the least number of samples over a time (s) in which the robot drifts: as many as keep them no farther apart
    /// than those of the settings, and as keep it from turning by more than `turn_sample` between two. 0 for a robot without
    /// momentum.
    pub(super) fn divisions(
        &self,
        model: &Model,
        stance: &Stance,
        span: f64,
        settings: &Settings,
        tolerances: &Tolerances,
    ) -> usize {
        if self.momentum == Wrench::default() {
            return 0;
        }
        let poses: Vec<Pose> = (0..model.bodies.len()).map(|link| stance.link_pose(link)).collect();
        let still = vec![0.0; model.kinematics.joint_count()];
        let turn = twist(model, &self.dynamics, &self.momentum, (&poses, &still)).angular.norm() * span;
        let by_time = libm::ceil(span / settings.sample - tolerances.sample_count);
        let by_turn = libm::ceil(turn / tolerances.turn_sample - tolerances.sample_count);
        by_time.max(by_turn).max(1.0) as usize
    }

    /// Returns the world pose of the base's body (`X_WB`, m) after a step that lasts `span` (s) from the pose `X_WB`. The joints
    /// are at these positions (rad or m) at its beginning, its middle and its end. The method is that of the midpoint; the
    /// centre of mass goes as it must.
    pub(super) fn moved(&self, model: &Model, X_WB: Pose, joints: [&[f64]; 3], span: f64) -> Pose {
        let [from, middle, to] = joints;
        let mut poses = vec![Pose::identity(); model.bodies.len()];
        let mut place = |joints: &[f64], base: &Pose| {
            model.kinematics.link_poses(joints, base, &mut poses);
            poses.clone()
        };
        let begun = centre(model, &place(from, &X_WB));
        let rates: Vec<f64> = from.iter().zip(to).map(|(a, b)| (b - a) / span).collect();
        let advanced = |twist: &Twist, span: f64| {
            let turn = UnitQuaternion::from_scaled_axis(twist.angular * span);
            let p = X_WB.translation.vector + twist.linear * span;
            Pose::from_parts(p.into(), turn * X_WB.rotation)
        };
        let mut found = Twist::default();
        for _ in 0..ROUNDS {
            let poses = place(middle, &advanced(&found, span / 2.0));
            found = twist(model, &self.dynamics, &self.momentum, (&poses, &rates));
        }
        let mut after = advanced(&found, span);
        let wanted = begun + self.momentum.force * (span / model.mass);
        after.translation.vector += wanted - centre(model, &place(to, &after));
        after
    }
}

/// Returns the twist of the base's own frame in the world with which a robot has a momentum, as in [`Floating`]; it does not
/// turn about a line of masses. `poses` and `rates`: the world poses of all links, and the velocities of the joints.
pub(super) fn twist(
    model: &Model,
    dynamics: &Dynamics,
    momentum: &Wrench,
    (poses, rates): (&[Pose], &[f64]),
) -> Twist {
    if model.mass <= 0.0 {
        return Twist::default();
    }
    let c = centre(model, poses);
    let arm = poses[model.base_link()].translation.vector - c;
    let of = |base: &Twist, rates: &[f64]| dynamics.momentum(&model.kinematics, poses, base, rates, &c);
    let by_joints = of(&Twist::default(), rates);
    let still = vec![0.0; rates.len()];
    let mut inertia = Mat3::zeros();
    for axis in 0..3 {
        let angular = Vec3::ith(axis, 1.0);
        let turning = of(&Twist { linear: angular.cross(&arm), angular }, &still);
        inertia.set_column(axis, &turning.moment);
    }
    inertia += Mat3::identity() * (inertia.trace() * Tolerances::default().inertia_ridge);
    let lacking = momentum.moment - by_joints.moment;
    let angular = inertia.cholesky().map_or_else(Vec3::zeros, |inertia| inertia.solve(&lacking));
    let linear = (momentum.force - by_joints.force) / model.mass + angular.cross(&arm);
    Twist { linear, angular }
}

/// Returns the centre of mass in the world, m. `poses`: the world poses of all links.
pub(super) fn centre(model: &Model, poses: &[Pose]) -> Vec3 {
    let moment = |link: &usize| {
        let body = &model.bodies[*link];
        poses[*link].transform_point(&body.com.into()).coords * body.mass
    };
    model.attached.iter().map(moment).sum::<Vec3>() / model.mass
}
