//! The robot on its way: where it is, what it did so far, and what that took.

use super::near;
use super::robot::{Bond, Robot};
use super::sweep::{self, Burden, Scene};
use super::tree::Tree;
use super::weight::{Load, Weight};
use crate::geometry::RigidTransform;
use std::cell::Cell;
use std::sync::Arc;

/// Positions of all joints: alpha, beta and gamma of each module, rad.
pub type Joints = Vec<[f64; 3]>;

/// One step of a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Joints turn at once, each at a steady rate: (module, joint, to), rad.
    Turn(Vec<(usize, usize, f64)>),
    /// A bond begins to hold, by its number.
    Dock(usize),
    /// A bond is let go.
    Undock(usize),
}

#[derive(Clone, Debug)]
pub struct State {
    pub robot: Robot,
    pub tree: Tree,
    pub poses: Vec<RigidTransform>,
    /// Pairs of places that are docked.
    pub docked: Vec<(usize, usize)>,
    pub steps: Vec<Step>,
    /// Poses of the whole robot that were worked out.
    pub work: u64,
    /// Where something pulls.
    pub weight: Option<Arc<Weight>>,
    /// What joints may have to hold, in parts of their limits.
    pub share: f64,
    /// See [`Burden::refused`].
    pub refused: Cell<Option<Load>>,
}

impl State {
    /// The modules must hang together.
    pub fn new(robot: Robot) -> State {
        let tree = Tree::grow(&robot, 0).expect("a robot that was checked hangs together");
        let mut state = State {
            robot,
            tree,
            poses: Vec::new(),
            docked: Vec::new(),
            steps: Vec::new(),
            work: 0,
            weight: None,
            share: 1.0,
            refused: Cell::new(None),
        };
        state.regrow();
        state
    }

    /// With the weight of the robot, where something pulls. The tree is grown from the weight's root, the
    /// module that is held or another: what is let go first leaves short arms there.
    pub fn with_weight(robot: Robot, weight: Option<Arc<Weight>>) -> State {
        let mut state = State::new(robot);
        if let Some(weight) = &weight {
            state.tree = Tree::grow(&state.robot, weight.root).expect("it hangs together");
            state.docked = near::docked(&state.robot, &state.tree);
            state.place();
        }
        state.weight = weight;
        state
    }

    /// The load that is greatest by its limit; none where nothing pulls.
    pub fn load(&self) -> Option<Load> {
        self.weight.as_ref().map(|weight| weight.greatest(&self.tree, &self.poses))
    }

    /// After bonds changed. The root is in the middle of the tree, so that little moves far.
    pub fn regrow(&mut self) {
        let middle = middle(&self.tree, &self.robot);
        self.tree = Tree::grow(&self.robot, middle).expect("what is let go closed a loop");
        self.docked = near::docked(&self.robot, &self.tree);
        self.place();
    }

    pub fn place(&mut self) {
        self.work += 1;
        self.tree.poses(&self.robot.joints, &mut self.poses);
    }

    pub fn scene(&self) -> Scene<'_> {
        let burden =
            self.weight.as_deref().map(|weight| Burden { weight, share: self.share, refused: &self.refused });
        Scene { tree: &self.tree, docked: self.docked.clone(), burden }
    }

    /// Remembers a load that was too great.
    pub fn refuse(&self, load: Load) {
        sweep::lessened(&self.refused, load);
    }

    /// All joints go where they are to be, at once.
    pub fn go(&mut self, to: &[[f64; 3]]) {
        let mut turns = Vec::new();
        for (module, (from, to)) in self.robot.joints.iter().zip(to).enumerate() {
            turns.extend((0..3).filter(|&k| from[k] != to[k]).map(|k| (module, k, to[k])));
        }
        if !turns.is_empty() {
            self.steps.push(Step::Turn(turns));
        }
        self.robot.joints = to.to_vec();
        self.place();
    }

    /// One joint turns.
    pub fn turn(&mut self, module: usize, joint: usize, to: f64) {
        self.steps.push(Step::Turn(vec![(module, joint, to)]));
        self.robot.joints[module][joint] = to;
        self.place();
    }

    pub fn undock(&mut self, bond: usize) {
        self.robot.undock(bond);
        self.steps.push(Step::Undock(bond));
    }

    pub fn dock(&mut self, bond: Bond) {
        let index = self.robot.dock(bond);
        self.steps.push(Step::Dock(index));
    }

    /// How far the balls are spread: the sum of squared distances from their middle.
    pub fn spread(&self) -> f64 {
        spread(&self.poses)
    }

    /// Modules of each chain of good bonds, by a number of its own.
    pub fn chains(&self) -> Vec<usize> {
        let mut chain: Vec<usize> = (0..self.robot.modules()).collect();
        fn root(chain: &mut [usize], mut m: usize) -> usize {
            while chain[m] != m {
                chain[m] = chain[chain[m]];
                m = chain[m];
            }
            m
        }
        for (_, bond) in self.robot.held().filter(|(_, bond)| bond.is_good()) {
            let (a, b) = (root(&mut chain, bond.a.module), root(&mut chain, bond.b.module));
            chain[a.max(b)] = a.min(b);
        }
        (0..chain.len()).map(|m| root(&mut chain, m)).collect()
    }

    /// How many bonds that hold are none of a snake.
    pub fn bad_bonds(&self) -> usize {
        self.robot.held().filter(|(_, bond)| !bond.is_good()).count()
    }
}

pub fn spread(poses: &[RigidTransform]) -> f64 {
    let count = poses.len() as f64;
    let sum = poses.iter().fold(crate::geometry::Vec3::zeros(), |sum, pose| sum + pose.translation);
    let squares: f64 = poses.iter().map(|pose| pose.translation.norm_squared()).sum();
    squares - sum.norm_squared() / count
}

/// The module in the middle of the longest way through the tree.
fn middle(tree: &Tree, robot: &Robot) -> usize {
    let Some(tree) = Tree::grow(robot, tree.shoe[0] / 2) else { return 0 };
    let depths = |tree: &Tree| {
        let mut depth = vec![0usize; tree.shoes()];
        for place in 1..depth.len() {
            depth[place] = depth[tree.parent[place]] + 1;
        }
        depth
    };
    let deepest = |depth: &[usize]| (0..depth.len()).rev().max_by_key(|&p| depth[p]).unwrap_or(0);
    let far = tree.shoe[deepest(&depths(&tree))] / 2;
    let Some(tree) = Tree::grow(robot, far) else { return 0 };
    let depth = depths(&tree);
    let mut place = deepest(&depth);
    for _ in 0..depth[place] / 2 {
        place = tree.parent[place];
    }
    tree.shoe[place] / 2
}
