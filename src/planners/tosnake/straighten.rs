//! Straightening: tilts (alpha and beta) turn to zero one after the other, as far as they are free to; where
//! none is, random turns perturb the robot so that it spreads.

use super::joint_sweep;
use super::robot::GAMMA;
use super::state::{State, spread};
use super::tolerances::TOLERANCES;
use super::tree::JointRef;
use crate::optimize::random::SplitMix64;
use std::f64::consts::FRAC_PI_4;

/// The least number of joints that are turned at once.
const TOGETHER_MIN: usize = 2;

/// Turns tilts to zero, together and one by one in random order, until none can turn without collision; returns the
/// number of tilts that are not zero then. Under gravity no joint exceeds [`State::load_share`] on the way. `state`:
/// the robot, which is moved; `rng`: the generator of random orders.
pub fn straighten(state: &mut State, rng: &mut SplitMix64) -> usize {
    loop {
        let joints = tilted(state);
        if joints.is_empty() {
            return 0;
        }
        let before = joints.len();
        // Many at once where that is free.
        straighten_together(state, &joints);
        // Then each alone, in random order.
        let mut joints = tilted(state);
        rng.shuffle(&mut joints);
        for joint in joints {
            let q = state.robot.joints[joint.module][joint.joint];
            if is_free(state, joint, -q) && holds_loads(state, joint, 0.0) {
                state.turn(joint.module, joint.joint, 0.0);
            }
        }
        let left = tilted(state).len();
        if left == 0 || left == before {
            return left;
        }
    }
}

/// Turns tilts to zero at once, or, where that is not free, those of either half of the list.
fn straighten_together(state: &mut State, joints: &[JointRef]) {
    if joints.len() < TOGETHER_MIN {
        return;
    }
    let mut straight = state.robot.joints.clone();
    joints.iter().for_each(|joint| straight[joint.module][joint.joint] = 0.0);
    let mut work = 0;
    let is_free = state.scene().is_free(&state.robot.joints, &straight, &mut work);
    state.work += work;
    if is_free {
        state.move_to(&straight);
        return;
    }
    let (first, second) = joints.split_at(joints.len() / 2);
    straighten_together(state, first);
    straighten_together(state, second);
}

/// Returns the tilts that are not zero.
fn tilted(state: &State) -> Vec<JointRef> {
    let tilted = |joint: &JointRef| {
        joint.joint != GAMMA && state.robot.joints[joint.module][joint.joint].abs() > TOLERANCES.tilt
    };
    state.tree.all_joints().into_iter().filter(tilted).collect()
}

/// Returns true if a joint is free to turn by all of an angle (rad).
fn is_free(state: &mut State, joint: JointRef, angle: f64) -> bool {
    crate::interrupt::checkpoint();
    state.work += 1;
    joint_sweep::free_angle(&state.tree, joint, &state.poses, angle, TOLERANCES.turn_min_distance) == angle
}

/// Returns true if no joint is overloaded, and the robot does not fall over, while one of them turns to a position
/// (rad).
fn holds_loads(state: &mut State, joint: JointRef, to: f64) -> bool {
    if state.gravity.is_none() && state.stance.is_none() {
        return true;
    }
    let mut joints = state.robot.joints.clone();
    joints[joint.module][joint.joint] = to;
    let mut work = 0;
    let holds = state.scene().is_free(&state.robot.joints, &joints, &mut work);
    state.work += work;
    holds
}

/// Perturbs the robot by random turns of single joints: tilts to multiples of 45°, gamma by multiples of 45°.
/// `turns`: the number of turns tried. A turn is made if it is free of collisions, takes no joint beyond
/// [`State::load_share`], and reduces the spread by at most a random fraction of it between 0 and `slack`. Returns
/// the number of turns made. `state`: the robot, which is moved; `rng`: the generator of random turns.
pub fn perturb(state: &mut State, rng: &mut SplitMix64, turns: usize, slack: f64) -> usize {
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
        if target == q || !is_free(state, joint, target - q) || !holds_loads(state, joint, target) {
            continue;
        }
        let before = state.spread();
        let mut joints = state.robot.joints.clone();
        joints[joint.module][joint.joint] = target;
        let mut poses = Vec::new();
        state.work += 1;
        state.tree.poses(&joints, &mut poses);
        if spread(&poses) >= before * (1.0 - slack * (1.0 + rng.next_signed()) / 2.0) {
            state.turn(joint.module, joint.joint, target);
            made += 1;
        }
    }
    made
}
