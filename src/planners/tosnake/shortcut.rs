//! Path shortcutting: between one change of bonds and the next, joints go straight from posture to posture
//! wherever that is free, and leave out the postures between.

use super::broad_phase;
use super::gravity::GravityModel;
use super::motion_check::{LoadLimit, Scene};
use super::parallel;
use super::robot::Robot;
use super::state::{Joints, State, Step, turns};
use super::tree::Tree;
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// The motion between two changes of bonds.
struct Segment {
    /// The joint positions at its start, rad, by module.
    start: Joints,
    /// The steps, all of them turns, by their indices.
    steps: Range<usize>,
    /// The flag of each bond of the robot: true if it is closed.
    holds: Vec<bool>,
    /// The module at the root of the tree.
    root: usize,
}

/// Shortcuts the path between changes of bonds: returns steps with the same docks and undocks in which joints go
/// straight from posture to posture where that is free, with as few postures between as bisection finds. `robot`: the
/// start, with all bonds in its list that the steps name; `gravity`: the gravity model, `None` for a robot that floats.
/// `work` counts forward kinematics. Up to `threads` threads do it, and the result does not depend on their number.
pub(super) fn shortened(
    robot: Robot,
    gravity: Option<Arc<GravityModel>>,
    steps: &[Step],
    threads: usize,
    work: &mut u64,
) -> Vec<Step> {
    let mut state = State::with_gravity(robot, gravity);
    let mut joints = state.robot.joints.clone();
    let mut segments: Vec<Segment> = Vec::new();
    let mut first = 0;
    for index in 0..=steps.len() {
        let changes = match steps.get(index) {
            Some(Step::Turn(_)) => continue,
            Some(Step::Dock(bond)) => Some((*bond, true)),
            Some(Step::Undock(bond)) => Some((*bond, false)),
            None => None,
        };
        let (holds, root) = (state.robot.holds.clone(), state.tree.shoe[0] / 2);
        segments.push(Segment { start: joints.clone(), steps: first..index, holds, root });
        steps[first..index].iter().for_each(|step| turn(step, &mut joints));
        first = index + 1;
        if let Some((bond, docks)) = changes {
            if docks {
                state.dock(state.robot.bonds[bond])
            } else {
                state.undock(bond)
            }
            state.rebuild_tree();
        }
    }
    *work += state.work;
    let changes = std::mem::take(&mut state.steps);
    let (robot, gravity) = (&state.robot, state.gravity.as_deref());
    let path = |index: usize| segments[index].path(robot, gravity, steps);
    let mut shortened = Vec::new();
    let (mut index, mut changes) = (0, changes.into_iter());
    parallel::in_order(0..segments.len(), threads, &path, &mut |(path, done)| {
        *work += done + path.len() as u64;
        let mut from = &segments[index].start;
        for to in &path {
            shortened.extend(turns(from, to));
            from = to;
        }
        shortened.extend(changes.next());
        index += 1;
        false
    });
    shortened
}

impl Segment {
    /// Returns the postures of the shortened path, without the first, and the number of forward kinematics evaluated.
    /// `robot`: with the bonds that `holds` is about; `steps`: those of the whole path.
    fn path(&self, robot: &Robot, gravity: Option<&GravityModel>, steps: &[Step]) -> (Vec<Joints>, u64) {
        let mut postures = vec![self.start.clone()];
        for step in &steps[self.steps.clone()] {
            let mut next = postures[postures.len() - 1].clone();
            turn(step, &mut next);
            postures.push(next);
        }
        let (mut path, mut work) = (Vec::new(), 0);
        if postures.len() > 1 {
            let robot = Robot { holds: self.holds.clone(), ..robot.clone() };
            let tree = Tree::grow(&robot, self.root).expect("it was connected before");
            let least_overload = Cell::new(None);
            let limit = |gravity| LoadLimit { gravity, share: 1.0, least_overload: &least_overload };
            let docked = broad_phase::docked(&robot, &tree);
            let scene = Scene { tree: &tree, docked, load_limit: gravity.map(limit), stance: None };
            bisect(&scene, &postures, &mut work, &mut path);
        }
        (path, work)
    }
}

/// Turns the joints of a step.
fn turn(step: &Step, joints: &mut Joints) {
    if let Step::Turn(turns) = step {
        turns.iter().for_each(|&(module, joint, to)| joints[module][joint] = to);
    }
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
