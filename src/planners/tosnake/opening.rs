//! Opening a tangle: joints turn straight one after the other, as far as they are free to; where none
//! is, the robot is shaken so that it spreads.

use super::robot::GAMMA;
use super::state::State;
use super::sweep::APART;
use super::tree::JointRef;
use super::turn;
use crate::planners::random::SplitMix64;
use std::f64::consts::FRAC_PI_4;

/// Balls of single turns stay a little farther apart than those of sweeps, so that these may begin there.
const TURN_APART: f64 = APART + 2e-4;

/// A tilt this small is none, rad.
const STRAIGHT: f64 = 1e-12;

/// Turns tilts to zero until none is free to; gives how many are left.
pub fn straighten(state: &mut State, rng: &mut SplitMix64) -> usize {
    loop {
        let joints = bent(state);
        if joints.is_empty() {
            return 0;
        }
        let before = joints.len();
        together(state, &joints);
        let mut joints = bent(state);
        rng.shuffle(&mut joints);
        for joint in joints {
            let q = state.robot.joints[joint.module][joint.joint];
            if free(state, joint, -q) && bears(state, joint, 0.0) {
                state.turn(joint.module, joint.joint, 0.0);
            }
        }
        let left = bent(state).len();
        if left == 0 || left == before {
            return left;
        }
    }
}

/// Turns tilts to zero at once, or those of either half of the list.
fn together(state: &mut State, joints: &[JointRef]) {
    if joints.len() < TOGETHER_MIN {
        return;
    }
    let mut straight = state.robot.joints.clone();
    joints.iter().for_each(|joint| straight[joint.module][joint.joint] = 0.0);
    let mut work = 0;
    let is_free = state.scene().is_free(&state.robot.joints, &straight, &mut work);
    state.work += work;
    if is_free {
        state.go(&straight);
        return;
    }
    let (first, second) = joints.split_at(joints.len() / 2);
    together(state, first);
    together(state, second);
}

/// Fewer joints than this turn one after the other.
const TOGETHER_MIN: usize = 2;

fn bent(state: &State) -> Vec<JointRef> {
    let tilted = |joint: &JointRef| {
        joint.joint != GAMMA && state.robot.joints[joint.module][joint.joint].abs() > STRAIGHT
    };
    state.tree.all_joints().into_iter().filter(tilted).collect()
}

/// Whether a joint is free to turn by an angle, all of it.
fn free(state: &mut State, joint: JointRef, angle: f64) -> bool {
    crate::interrupt::checkpoint();
    state.work += 1;
    turn::free(&state.tree, joint, &state.poses, angle, TURN_APART) == angle
}

/// Whether all joints hold what hangs on them while one of them turns.
fn bears(state: &mut State, joint: JointRef, to: f64) -> bool {
    if state.weight.is_none() {
        return true;
    }
    let mut joints = state.robot.joints.clone();
    joints[joint.module][joint.joint] = to;
    let mut work = 0;
    let bears = state.scene().is_free(&state.robot.joints, &joints, &mut work);
    state.work += work;
    bears
}

/// Random turns that spread the robot, or do not draw it together much. Gives how many were made.
pub fn shake(state: &mut State, rng: &mut SplitMix64, turns: usize, slack: f64) -> usize {
    let joints = state.tree.all_joints();
    let mut made = 0;
    for _ in 0..turns {
        let joint = joints[rng.below(joints.len())];
        let q = state.robot.joints[joint.module][joint.joint];
        let target = if joint.joint == GAMMA {
            q + FRAC_PI_4 * (rng.below(7) as f64 - 3.0)
        } else {
            FRAC_PI_4 * (rng.below(5) as f64 - 2.0)
        };
        if target == q || !free(state, joint, target - q) || !bears(state, joint, target) {
            continue;
        }
        let before = state.spread();
        let mut joints = state.robot.joints.clone();
        joints[joint.module][joint.joint] = target;
        let mut poses = Vec::new();
        state.work += 1;
        state.tree.poses(&joints, &mut poses);
        if super::state::spread(&poses) >= before * (1.0 - slack * (1.0 + rng.next_signed()) / 2.0) {
            state.turn(joint.module, joint.joint, target);
            made += 1;
        }
    }
    made
}
