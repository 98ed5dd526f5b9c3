//! The state of the robot during the search: its configuration, its poses, and the steps so far.

use super::broad_phase;
use super::gravity::{GravityModel, JointLoad};
use super::motion_check::{self, LoadLimit, Scene};
use super::robot::{Bond, Robot};
use super::stance::Stance;
use super::tolerances::TOLERANCES;
use super::tree::Tree;
use crate::geometry::{RigidTransform, Vec3};
use std::cell::Cell;
use std::sync::Arc;

/// The positions of all joints: alpha, beta and gamma of each module, by module, rad.
pub type Joints = Vec<[f64; 3]>;

/// A step of a plan to the snake: joints turn together, or one bond changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Joints turn at once, each at a constant rate, so that joint space is crossed in a straight line: for each joint
    /// (module, joint, final position in rad), with joints counted as [`ALPHA`](super::robot::ALPHA) says.
    Turn(Vec<(usize, usize, f64)>),
    /// Docking: the bond of this index in [`Robot::bonds`] closes.
    Dock(usize),
    /// Undocking: the bond of this index in [`Robot::bonds`] opens.
    Undock(usize),
}

/// The state of the search for the snake: the robot with its tree and poses, the steps made so far, and the work.
#[derive(Clone, Debug)]
pub struct State {
    /// The configuration at the present: joint positions and bonds.
    pub robot: Robot,
    /// The kinematic tree over the closed bonds.
    pub tree: Tree,
    /// The poses of the shoes in the tree's order ([`Tree::shoe`]), in pitches, in the frame of its root.
    pub poses: Vec<RigidTransform>,
    /// The pairs of shoes docked to each other, as indices in the tree's order, the smaller first, ascending.
    pub docked: Vec<(usize, usize)>,
    /// The steps made so far, in order.
    pub steps: Vec<Step>,
    /// The number of forward-kinematics evaluations of the whole robot so far.
    pub work: u64,
    /// The gravity model of a robot that is held; `None` if it floats or rests on the floor.
    pub gravity: Option<Arc<GravityModel>>,
    /// The stance of a robot on the floor; `None` if it is held or floats.
    pub stance: Option<Stance>,
    /// Greatest load of a joint that motions may cause, as a fraction of its torque limit.
    pub load_share: f64,
    /// The smallest overload noted since the last was taken, `None` without any; see [`LoadLimit::least_overload`].
    pub least_overload: Cell<Option<JointLoad>>,
}

impl State {
    /// Returns the state of a floating robot, with the tree rooted at the module in the middle of its longest path.
    /// Panics if closed bonds do not connect the robot.
    pub fn new(robot: Robot) -> State {
        let tree = Tree::grow(&robot, 0).expect("a robot that was validated is connected");
        let mut state = State {
            robot,
            tree,
            poses: Vec::new(),
            docked: Vec::new(),
            steps: Vec::new(),
            work: 0,
            gravity: None,
            stance: None,
            load_share: 1.0,
            least_overload: Cell::new(None),
        };
        state.rebuild_tree();
        state
    }

    /// Returns the state of a robot. With a gravity model, the tree is rooted at the module that the model names, near
    /// which loops stay closed; without, as [`State::new`] has it. Panics if closed bonds do not connect the robot.
    pub fn with_gravity(robot: Robot, gravity: Option<Arc<GravityModel>>) -> State {
        let mut state = State::new(robot);
        if let Some(gravity) = &gravity {
            state.tree = Tree::grow(&state.robot, gravity.root).expect("it is connected");
            state.docked = broad_phase::docked(&state.robot, &state.tree);
            state.update_poses();
        }
        state.gravity = gravity;
        state
    }

    /// Returns the joint with the greatest load as a fraction of its torque limit; `None` if the robot floats.
    pub fn load(&self) -> Option<JointLoad> {
        self.gravity.as_ref().map(|gravity| gravity.greatest(&self.tree, &self.poses))
    }

    /// Rebuilds the tree and the poses after bonds changed, rooted at the module in the middle of the longest path, so
    /// that few balls move far. Panics if closed bonds do not connect the robot any more.
    pub fn rebuild_tree(&mut self) {
        let middle = middle(&self.tree, &self.robot);
        self.tree = Tree::grow(&self.robot, middle).expect("the bond that was undocked closed a loop");
        self.docked = broad_phase::docked(&self.robot, &self.tree);
        self.update_poses();
    }

    /// Recomputes the poses of all shoes from the joint positions (forward kinematics), and counts that as work.
    pub fn update_poses(&mut self) {
        self.work += 1;
        self.tree.poses(&self.robot.joints, &mut self.poses);
    }

    /// Returns the robot as collision and load checks need it; overloads are noted in [`State::least_overload`].
    pub fn scene(&self) -> Scene<'_> {
        let load_limit = self.gravity.as_deref().map(|gravity| LoadLimit {
            gravity,
            share: self.load_share,
            least_overload: &self.least_overload,
        });
        let stance = self.stance.as_ref();
        Scene { tree: &self.tree, docked: self.docked.clone(), load_limit, stance }
    }

    /// Stores an overload in [`State::least_overload`], if its ratio is less than that of the one there.
    pub fn note_overload(&self, load: JointLoad) {
        motion_check::note_overload(&self.least_overload, load);
    }

    /// Moves all joints at once to new positions, rad, one entry for each module; adds a step if any position changes.
    /// The motion must be free; see [`State::try_move_to`].
    pub fn move_to(&mut self, to: &[[f64; 3]]) {
        self.follow_stance(to);
        self.set_joints(to);
    }

    /// Moves all joints as [`State::move_to`] does, and returns true, unless the robot rests on the floor and the
    /// motion from its present stance is not free.
    pub fn try_move_to(&mut self, to: &[[f64; 3]]) -> bool {
        let is_free = self.follow_stance(to);
        if is_free {
            self.set_joints(to);
        }
        is_free
    }

    fn set_joints(&mut self, to: &[[f64; 3]]) {
        self.steps.extend(turns(&self.robot.joints, to));
        self.robot.joints = to.to_vec();
        self.update_poses();
    }

    /// Moves one joint of a module to a new position (rad), and adds a step. `joint`: 0 to 2 as in [`Robot::joints`].
    /// Panics if there is no such module or joint.
    pub fn turn(&mut self, module: usize, joint: usize, to: f64) {
        if self.stance.is_some() {
            let mut joints = self.robot.joints.clone();
            joints[module][joint] = to;
            self.follow_stance(&joints);
        }
        self.steps.push(Step::Turn(vec![(module, joint, to)]));
        self.robot.joints[module][joint] = to;
        self.update_poses();
    }

    /// Takes the stance along a motion that the joints are about to make; returns false, and leaves it, if the motion
    /// is not free.
    fn follow_stance(&mut self, to: &[[f64; 3]]) -> bool {
        let Some(stance) = &self.stance else { return true };
        let mut work = 0;
        let rest = self.scene().rest_after(&self.robot.joints, to, &mut work);
        self.work += work;
        let Some(rest) = rest else { return false };
        let mut poses = Vec::new();
        self.tree.poses(to, &mut poses);
        self.stance = Some(stance.turned(&self.tree, &poses, rest.down));
        true
    }

    /// Returns true if the robot is not on the floor, or rests there and all joints hold their loads, with the bonds
    /// that are closed.
    pub fn stands(&self) -> bool {
        let Some(stance) = &self.stance else { return true };
        let down = stance.down_in_root(&self.tree, &self.poses);
        let rest = stance.model.rest(&self.tree, &self.poses, down);
        rest.is_some_and(|rest| stance.bears(&self.tree, &self.poses, &rest))
    }

    /// Returns true if the robot rests on the floor as one of the stances of the same posture has it, or is not on the
    /// floor.
    pub fn rests_as_any(&self, stances: &[Stance]) -> bool {
        let Some(own) = &self.stance else { return true };
        let down = |stance: &Stance| stance.down_in_root(&self.tree, &self.poses);
        stances.iter().any(|stance| (down(stance) - down(own)).norm() < TOLERANCES.same_rest)
    }

    /// Opens the bond of an index in [`Robot::bonds`], and adds a step; the caller has to rebuild the tree. Panics if
    /// there is no such bond.
    pub fn undock(&mut self, bond: usize) {
        self.robot.undock(bond);
        self.steps.push(Step::Undock(bond));
    }

    /// Closes a bond, and adds a step; the caller has to rebuild the tree.
    pub fn dock(&mut self, bond: Bond) {
        let index = self.robot.dock(bond);
        self.steps.push(Step::Dock(index));
    }

    /// Returns the spread of the robot's balls about their centroid, in squared pitches; see [`spread`].
    pub fn spread(&self) -> f64 {
        spread(&self.poses)
    }

    /// Returns for each module, by index, the chain that it belongs to, named by the least index of its modules: those
    /// that a series of snake bonds joins (disjoint-set forest).
    pub fn chains(&self) -> Vec<usize> {
        let mut chain: Vec<usize> = (0..self.robot.modules()).collect();
        fn root(chain: &mut [usize], mut m: usize) -> usize {
            while chain[m] != m {
                chain[m] = chain[chain[m]];
                m = chain[m];
            }
            m
        }
        for (_, bond) in self.robot.held().filter(|(_, bond)| bond.is_snake_bond()) {
            let (a, b) = (root(&mut chain, bond.a.module), root(&mut chain, bond.b.module));
            chain[a.max(b)] = a.min(b);
        }
        (0..chain.len()).map(|m| root(&mut chain, m)).collect()
    }

    /// Returns the number of closed bonds that are not snake bonds ([`Bond::is_snake_bond`](super::robot::Bond)): the
    /// merges still to make, for each replaces one of them by a snake bond.
    pub fn other_bonds(&self) -> usize {
        self.robot.held().filter(|(_, bond)| !bond.is_snake_bond()).count()
    }
}

/// Returns the step that takes the joints from one posture (rad, by module) to another; `None` if none moves.
pub(super) fn turns(from: &[[f64; 3]], to: &[[f64; 3]]) -> Option<Step> {
    let mut turns = Vec::new();
    for (module, (from, to)) in from.iter().zip(to).enumerate() {
        turns.extend((0..3).filter(|&k| from[k] != to[k]).map(|k| (module, k, to[k])));
    }
    (!turns.is_empty()).then_some(Step::Turn(turns))
}

/// Returns the spread of balls: the sum of the squared distances of their centres from their centroid, in squared
/// pitches. `poses`: of the balls, in pitches; NaN without any.
pub fn spread(poses: &[RigidTransform]) -> f64 {
    let count = poses.len() as f64;
    let sum = poses.iter().fold(Vec3::zeros(), |sum, pose| sum + pose.translation);
    let squares: f64 = poses.iter().map(|pose| pose.translation.norm_squared()).sum();
    squares - sum.norm_squared() / count
}

/// Returns the module in the middle of the longest path of the tree, found by two sweeps: the shoe farthest
/// from any is one end, and the shoe farthest from that is the other.
fn middle(tree: &Tree, robot: &Robot) -> usize {
    let Some(tree) = Tree::grow(robot, tree.shoe[0] / 2) else { return 0 };
    let depths = |tree: &Tree| {
        let mut depth = vec![0usize; tree.shoes()];
        for index in 1..depth.len() {
            depth[index] = depth[tree.parent[index]] + 1;
        }
        depth
    };
    let deepest = |depth: &[usize]| (0..depth.len()).rev().max_by_key(|&i| depth[i]).unwrap_or(0);
    let far = tree.shoe[deepest(&depths(&tree))] / 2;
    let Some(tree) = Tree::grow(robot, far) else { return 0 };
    let depth = depths(&tree);
    let mut index = deepest(&depth);
    for _ in 0..depth[index] / 2 {
        index = tree.parent[index];
    }
    tree.shoe[index] / 2
}
