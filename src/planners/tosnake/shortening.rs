//! Fewer steps: between one change of bonds and the next, the joints go straight from posture to
//! posture wherever that is free, and leave out what was on the way.

use super::robot::Robot;
use super::state::{Joints, State, Step};
use super::sweep::Scene;
use super::weight::Weight;
use std::sync::Arc;

/// The same docks and undocks, in as few turns between them as halving finds. `robot` is as it was at the
/// start, with all bonds that the steps number. `work` counts poses.
pub fn shortened(robot: Robot, weight: Option<Arc<Weight>>, steps: &[Step], work: &mut u64) -> Vec<Step> {
    let mut state = State::with_weight(robot, weight);
    let mut postures = vec![state.robot.joints.clone()];
    for step in steps {
        match step {
            Step::Turn(turns) => {
                let mut next = postures[postures.len() - 1].clone();
                turns.iter().for_each(|&(module, joint, to)| next[module][joint] = to);
                postures.push(next);
            }
            Step::Dock(bond) => {
                take(&mut state, &mut postures, work);
                let bond = state.robot.bonds[*bond];
                state.dock(bond);
                state.regrow();
            }
            Step::Undock(bond) => {
                take(&mut state, &mut postures, work);
                state.undock(*bond);
                state.regrow();
            }
        }
    }
    take(&mut state, &mut postures, work);
    *work += state.work;
    state.steps
}

/// Goes through the postures, and leaves the last.
fn take(state: &mut State, postures: &mut Vec<Joints>, work: &mut u64) {
    let mut stops = Vec::new();
    if postures.len() > 1 {
        straight(&state.scene(), postures, work, &mut stops);
    }
    stops.iter().for_each(|joints| state.go(joints));
    postures.drain(..postures.len() - 1);
}

/// The postures between which the straight way is free; that from each to the next was found so before.
fn straight(scene: &Scene, postures: &[Joints], work: &mut u64, stops: &mut Vec<Joints>) {
    let last = postures.len() - 1;
    if last == 1 || scene.is_free(&postures[0], &postures[last], work) {
        stops.push(postures[last].clone());
        return;
    }
    straight(scene, &postures[..=last / 2], work, stops);
    straight(scene, &postures[last / 2..], work, stops);
}
