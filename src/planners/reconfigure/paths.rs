//! Free paths of the direct search from posture to posture, the connections of which stay.

use super::direct::{Node, Search};
use crate::planners::tosnake::Step;
use crate::planners::tosnake::motion_check::Scene;
use crate::planners::tosnake::rrt_connect::RrtConnect;
use crate::planners::tosnake::stance::Stance;
use crate::planners::tosnake::state::{Joints, State};
use crate::planners::tosnake::straighten::straighten;
use crate::planners::tosnake::tree::JointRef;

/// Greatest number of detours looked for, each with other random numbers.
const DETOURS_MAX: usize = 3;
/// Greatest number of orders in which modules turn one after the other.
const ORDERS_MAX: usize = 4;

impl Search<'_> {
    /// Returns a motion around what is in the way, with its duration.
    pub(super) fn detour(
        &mut self,
        scene: &Scene,
        joints: &[JointRef],
        from: &Joints,
        to: &Joints,
    ) -> Option<(f64, Vec<Joints>)> {
        for _ in 0..DETOURS_MAX {
            let rrt = RrtConnect { scene, joints };
            if let Some(path) = rrt.path(from, to, &mut self.rng, &mut self.work) {
                let mut whole = vec![from.clone()];
                whole.extend(path);
                let path = shortcut(scene, whole, &mut self.work);
                return Some((self.duration(from, &path), path));
            }
        }
        None
    }

    /// Returns a free path to a posture, on the floor to one of its stances: straight, by a detour, or over the
    /// straightened robot.
    pub(super) fn way(&mut self, state: &State, goal: &Joints, stances: &[Stance]) -> Option<Vec<Joints>> {
        let here = &state.robot.joints;
        if here == goal {
            return Some(Vec::new());
        }
        let scene = state.scene();
        if scene.is_free(here, goal, &mut self.work) {
            return Some(vec![goal.clone()]);
        }
        if let Some(path) = self.by_turns(state, goal) {
            return Some(path);
        }
        let joints = state.tree.all_joints();
        if let Some((_, path)) = self.detour(&scene, &joints, here, goal) {
            return Some(path);
        }
        if stances.is_empty() {
            return self.way_by_straightening(state, goal, None);
        }
        stances.iter().find_map(|stance| self.way_by_straightening(state, goal, Some(stance)))
    }

    /// Returns a path to a posture, on the floor to a stance, on which the tilts turn to zero from either end, as far
    /// as they are free to.
    fn way_by_straightening(
        &mut self,
        state: &State,
        goal: &Joints,
        stance: Option<&Stance>,
    ) -> Option<Vec<Joints>> {
        let (mut first, mut last) = (state.clone(), state.clone());
        (first.steps, last.steps) = (Vec::new(), Vec::new());
        last.robot.joints = goal.clone();
        last.update_poses();
        last.stance = stance.cloned();
        let before = first.work + last.work;
        straighten(&mut first, &mut self.rng);
        straighten(&mut last, &mut self.rng);
        self.work += first.work + last.work - before;
        let here = &state.robot.joints;
        let mut path = vec![here.clone()];
        path.extend(postures(here, &first.steps));
        let mut back = postures(goal, &last.steps);
        back.insert(0, goal.clone());
        back.reverse();
        let from = first.robot.joints.clone();
        if first.scene().is_free(&from, &back[0], &mut self.work) {
            path.extend(back);
        } else {
            let between = self.by_turns(&first, &back[0]);
            let between = between.or_else(|| {
                let joints = state.tree.all_joints();
                self.detour(&first.scene(), &joints, &from, &back[0]).map(|(_, path)| path)
            })?;
            path.extend(between);
            path.extend(back.into_iter().skip(1));
        }
        Some(self.shortened(state, path))
    }

    /// Turns the tilts of a state to zero as far as they are free to.
    pub(super) fn straighten(&mut self, node: &mut Node) {
        let mut tried = node.state.clone();
        let before = tried.robot.joints.clone();
        let steps = tried.steps.len();
        straighten(&mut tried, &mut self.rng);
        self.work += tried.work - node.state.work;
        let mut path = vec![before.clone()];
        path.extend(postures(&before, &tried.steps.split_off(steps)));
        let path = shortcut(&node.state.scene(), path, &mut self.work);
        let (mut moved, mut time, mut from) = (node.state.clone(), node.time, before);
        for joints in path {
            time += self.time(&from, &joints);
            // A shortcut on the floor may be one for another stance.
            if !moved.try_move_to(&joints) {
                return;
            }
            from = joints;
        }
        (node.state, node.time) = (moved, time);
    }

    /// Returns a path of a robot on the floor to a posture in which modules turn one after the other, as many at once
    /// as leaves it standing; `None` without a stance, or where some modules can't turn to the end in any order that
    /// was tried.
    pub(super) fn by_turns(&mut self, state: &State, goal: &Joints) -> Option<Vec<Joints>> {
        state.stance.as_ref()?;
        for _ in 0..ORDERS_MAX {
            let mut moved = state.clone();
            moved.steps = Vec::new();
            let before = moved.work;
            loop {
                let joints = &moved.robot.joints;
                let mut left: Vec<usize> = (0..goal.len()).filter(|&m| joints[m] != goal[m]).collect();
                self.rng.shuffle(&mut left);
                if !turn_together(&mut moved, &left, goal) {
                    break;
                }
            }
            self.work += moved.work - before;
            if moved.robot.joints == *goal {
                let mut path = vec![state.robot.joints.clone()];
                path.extend(postures(&state.robot.joints, &moved.steps));
                return Some(self.shortened(state, path));
            }
        }
        None
    }

    /// Returns a path without its first posture, with shortcuts if the robot stands on these, too.
    fn shortened(&mut self, state: &State, path: Vec<Joints>) -> Vec<Joints> {
        let short = shortcut(&state.scene(), path.clone(), &mut self.work);
        let mut moved = state.clone();
        let stands = short.iter().all(|joints| moved.try_move_to(joints));
        self.work += moved.work - state.work;
        if stands { short } else { path.into_iter().skip(1).collect() }
    }

    /// Returns the duration of a path of straight motions from a posture, s.
    pub(super) fn duration(&self, from: &Joints, path: &[Joints]) -> f64 {
        let postures = std::iter::once(from).chain(path);
        postures.zip(path).map(|(from, to)| self.time(from, to)).sum()
    }

    /// Returns the duration of the straight motion between two postures, s.
    pub(super) fn time(&self, from: &Joints, to: &Joints) -> f64 {
        let mut longest = 0.0;
        for (module, (from, to)) in from.iter().zip(to).enumerate() {
            for k in (0..3).filter(|&k| from[k] != to[k]) {
                longest = f64::max(longest, (self.pace)(module, k, to[k] - from[k]));
            }
        }
        longest
    }
}

/// Turns modules to a posture at once, or, where that is not free, those of either half of the list; returns true if
/// any turned.
fn turn_together(state: &mut State, modules: &[usize], goal: &Joints) -> bool {
    if modules.is_empty() {
        return false;
    }
    let mut there = state.robot.joints.clone();
    modules.iter().for_each(|&module| there[module] = goal[module]);
    if state.try_move_to(&there) {
        return true;
    }
    if modules.len() == 1 {
        return false;
    }
    let (first, second) = modules.split_at(modules.len() / 2);
    let first = turn_together(state, first, goal);
    turn_together(state, second, goal) || first
}

/// Returns the postures after each of some turns from a posture.
fn postures(from: &Joints, steps: &[Step]) -> Vec<Joints> {
    let mut here = from.clone();
    let mut all = Vec::new();
    for step in steps {
        let Step::Turn(turns) = step else { continue };
        turns.iter().for_each(|&(module, joint, to)| here[module][joint] = to);
        all.push(here.clone());
    }
    all
}

/// Returns a path without its first posture, in as few straight motions as are free: from each posture to the farthest
/// that it reaches.
fn shortcut(scene: &Scene, path: Vec<Joints>, work: &mut u64) -> Vec<Joints> {
    let mut short = Vec::new();
    let mut at = 0;
    while at + 1 < path.len() {
        let next = (at + 2..path.len()).rev().find(|&to| scene.is_free(&path[at], &path[to], work));
        at = next.unwrap_or(at + 1);
        short.push(path[at].clone());
    }
    short
}
