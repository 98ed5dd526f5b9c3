//! Path shortcutting: between one change of bonds and the next, joints go straight from posture to posture
//! wherever that is free, and leave out the postures between.

use super::gravity::GravityModel;
use super::motion_check::Scene;
use super::robot::Robot;
use super::state::{Joints, State, Step};
use std::sync::Arc;

/// Shortcuts the path between changes of bonds: returns steps with the same docks and undocks in which joints go
/// straight from posture to posture where that is free, with as few postures between as bisection finds. `robot`: the
/// start, with all bonds in its list that the steps name; `gravity`: the gravity model, `None` for a robot that floats.
/// `work` counts forward kinematics.
pub(super) fn shortened(
    robot: Robot,
    gravity: Option<Arc<GravityModel>>,
    steps: &[Step],
    work: &mut u64,
) -> Vec<Step> {
    let mut state = State::with_gravity(robot, gravity);
    let mut postures = vec![state.robot.joints.clone()];
    for step in steps {
        match step {
            Step::Turn(turns) => {
                let mut next = postures[postures.len() - 1].clone();
                turns.iter().for_each(|&(module, joint, to)| next[module][joint] = to);
                postures.push(next);
            }
            Step::Dock(bond) => {
                move_along(&mut state, &mut postures, work);
                let bond = state.robot.bonds[*bond];
                state.dock(bond);
                state.rebuild_tree();
            }
            Step::Undock(bond) => {
                move_along(&mut state, &mut postures, work);
                state.undock(*bond);
                state.rebuild_tree();
            }
        }
    }
    move_along(&mut state, &mut postures, work);
    *work += state.work;
    state.steps
}

/// Moves along a path of postures, shortened, and leaves the last of them.
fn move_along(state: &mut State, postures: &mut Vec<Joints>, work: &mut u64) {
    let mut path = Vec::new();
    if postures.len() > 1 {
        bisect(&state.scene(), postures, work, &mut path);
    }
    path.iter().for_each(|joints| state.move_to(joints));
    postures.drain(..postures.len() - 1);
}

/// Appends postures between which straight motions are free; that from each of the given ones to the next was
/// checked before.
fn bisect(scene: &Scene, postures: &[Joints], work: &mut u64, path: &mut Vec<Joints>) {
    let last = postures.len() - 1;
    if last == 1 || scene.is_free(&postures[0], &postures[last], work) {
        path.push(postures[last].clone());
        return;
    }
    bisect(scene, &postures[..=last / 2], work, path);
    bisect(scene, &postures[last / 2..], work, path);
}
