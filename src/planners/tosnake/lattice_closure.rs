//! Inverse kinematics of short loops by exhaustive search: with joints at quarter turns, two or three modules
//! have few postures, and all of them are enumerated. Some loops close only at the ends of the joints'
//! ranges, where descent does not get.

use super::merging::Pair;
use super::robot::{GAMMA, RED, across, mate};
use super::segment::Segment;
use super::state::{Joints, State};
use super::tolerances::TOLERANCES;
use crate::geometry::RigidTransform;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The greatest number of modules of a loop whose postures are enumerated: every module has 36 postures of quarter
/// turns, so three have 46,656.
pub(super) const LENGTH_MAX: usize = 3;

/// Postures of a module at quarter turns: three of either tilt and four of gamma.
const POSTURES: usize = 36;

/// Returns the joint positions (rad, by module), multiples of a quarter turn in the loop, that bring a pair's docks
/// together by a free straight motion in joint space; of several those with the least joint travel; `None` if there are
/// none. `work` counts forward kinematics.
pub(super) fn closed_posture(state: &State, pair: &Pair, work: &mut u64) -> Option<Joints> {
    let tree = &state.tree;
    let path = tree.path(tree.index[pair.a.shoe()], tree.index[pair.b.shoe()]);
    let here = &state.robot.joints;
    let mut enumeration = Enumeration {
        segments: Segment::along(tree, &state.poses, &path.indices),
        goal: mate(RED, 0, RED),
        joints: here.clone(),
        closed: Vec::new(),
    };
    enumeration.enumerate(0, RigidTransform::identity(), work);
    let travel = |to: &Joints| -> f64 {
        to.iter().zip(here).map(|(to, from)| (0..3).map(|k| (to[k] - from[k]).abs()).sum::<f64>()).sum()
    };
    let mut closed = enumeration.closed;
    closed.sort_by(|a, b| travel(a).total_cmp(&travel(b)));
    let scene = state.scene();
    closed.into_iter().find(|to| scene.is_free(here, to, work))
}

/// The enumeration of the postures of a loop.
struct Enumeration {
    segments: Vec<Segment>,
    /// The pose that the last shoe is to have in the frame of the first.
    goal: RigidTransform,
    joints: Joints,
    /// The postures found.
    closed: Vec<Joints>,
}

impl Enumeration {
    /// Enumerates the postures of the segments from `next` on, where those before end at `pose`. The depth is
    /// bounded by [`LENGTH_MAX`].
    fn enumerate(&mut self, next: usize, pose: RigidTransform, work: &mut u64) {
        crate::interrupt::checkpoint();
        let Some(segment) = self.segments.get(next).copied() else {
            let turn = (pose.rotation - self.goal.rotation).amax();
            if turn.max((pose.translation - self.goal.translation).amax()) < TOLERANCES.equal_transforms {
                self.closed.push(self.joints.clone());
            }
            return;
        };
        let Segment::Module { module, near, far } = segment else {
            return self.enumerate(next + 1, pose.then(&segment.pose(&self.joints)), work);
        };
        *work += 1;
        let before = self.joints[module];
        for (first, second, turn) in (0..POSTURES).map(|i| (i / 12, i / 4 % 3, i % 4)) {
            let q = &mut self.joints[module];
            q[near] = FRAC_PI_2 * (first as f64 - 1.0);
            q[far] = FRAC_PI_2 * (second as f64 - 1.0);
            // Of equal angles the one nearest to where gamma is.
            let gamma = FRAC_PI_2 * turn as f64;
            q[GAMMA] = gamma + TAU * libm::round((before[GAMMA] - gamma) / TAU);
            let over = across(q[near], q[far], q[GAMMA]);
            self.enumerate(next + 1, pose.then(&over), work);
        }
        self.joints[module] = before;
    }
}
