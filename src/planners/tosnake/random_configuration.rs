//! Random configurations ("tangles"): a straight snake after random actions, all of which it can do.

use super::broad_phase;
use super::joint_sweep;
use super::robot::{Bond, DOCKS, Dock, FACES, GAMMA, Robot, mate};
use super::tolerances::TOLERANCES;
use super::tree::{JointRef, Tree};
use crate::geometry::{RigidTransform, Vec3};
use crate::optimize::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The number of attempts of which on average one docks and one undocks; the others turn a joint.
const DOCKING_PERIOD: usize = 10;

/// Greatest number of attempts for each action: a configuration that can do little is left as it is.
const ATTEMPTS_MAX: usize = 100;

/// Returns a snake of `modules` modules, at least one, after `actions` random actions: quarter turns of joints that
/// are free of collisions, docking where docks meet, and undocking where the robot stays connected. If `ATTEMPTS_MAX`
/// attempts for each action do not suffice, fewer are made. All bonds in its list are closed. The same seed gives the
/// same configuration. Panics without modules.
pub fn random_configuration(modules: usize, actions: usize, seed: u64) -> Robot {
    let bond = |m: usize| Bond { a: Dock::red(2 * m + 1), b: Dock::red(2 * (m + 1)), turn: 0 };
    let bonds: Vec<Bond> = (0..modules.saturating_sub(1)).map(bond).collect();
    let holds = vec![true; bonds.len()];
    let mut walk = RandomWalk::new(Robot { joints: vec![[0.0; 3]; modules], bonds, holds });
    let mut rng = SplitMix64(seed);
    let (mut done, mut tried) = (0, 0);
    while done < actions && tried < actions.saturating_mul(ATTEMPTS_MAX) {
        tried += 1;
        crate::interrupt::progress_checkpoint(|| format!("{done} of {actions} actions"));
        let did = match rng.below(DOCKING_PERIOD) {
            0 => walk.dock(&mut rng),
            1 => walk.undock(&mut rng),
            _ => walk.turn(&mut rng),
        };
        done += usize::from(did);
    }
    let Robot { joints, bonds, holds } = walk.robot;
    let held: Vec<Bond> = bonds.into_iter().zip(holds).filter(|(_, held)| *held).map(|(b, _)| b).collect();
    Robot { joints, holds: vec![true; held.len()], bonds: held }
}

/// A configuration to which random actions are done. Each action returns false if it could not be done.
struct RandomWalk {
    robot: Robot,
    tree: Tree,
    joints: Vec<JointRef>,
    poses: Vec<RigidTransform>,
}

impl RandomWalk {
    fn new(robot: Robot) -> RandomWalk {
        let tree = Tree::grow(&robot, robot.modules() / 2).expect("a snake is connected");
        let mut poses = Vec::new();
        tree.poses(&robot.joints, &mut poses);
        RandomWalk { joints: tree.all_joints(), robot, tree, poses }
    }

    /// Turns a joint by a quarter turn.
    fn turn(&mut self, rng: &mut SplitMix64) -> bool {
        let joint = self.joints[rng.below(self.joints.len())];
        let turn = if rng.below(2) == 0 { FRAC_PI_2 } else { -FRAC_PI_2 };
        let mut to = self.robot.joints[joint.module][joint.joint] + turn;
        if joint.joint == GAMMA {
            to = if to > PI + TOLERANCES.equal_transforms {
                to - TAU
            } else if to < -PI + TOLERANCES.equal_transforms {
                to + TAU
            } else {
                to
            };
        } else if to.abs() > FRAC_PI_2 + TOLERANCES.equal_transforms {
            return false;
        }
        if self.is_in_loop(joint.child)
            || joint_sweep::free_angle(&self.tree, joint, &self.poses, turn, TOLERANCES.min_distance) != turn
        {
            return false;
        }
        // Rounded, so that many quarter turns do not sum up rounding errors.
        self.robot.joints[joint.module][joint.joint] = FRAC_PI_2 * libm::round(to / FRAC_PI_2);
        self.tree.poses(&self.robot.joints, &mut self.poses);
        true
    }

    /// Returns true if a bond that closes a loop joins the subtree of an index to the rest.
    fn is_in_loop(&self, index: usize) -> bool {
        self.tree.closing.iter().any(|&bond| {
            let ends = self.robot.bonds[bond];
            let inside = |dock: Dock| self.tree.is_in_subtree(self.tree.index[dock.shoe()], index);
            inside(ends.a) != inside(ends.b)
        })
    }

    /// Docks a random pair of free docks that meet.
    fn dock(&mut self, rng: &mut SplitMix64) -> bool {
        let possible = self.bonds_possible();
        if possible.is_empty() {
            return false;
        }
        let bond = possible[rng.below(possible.len())];
        self.robot.dock(bond);
        self.rebuild_tree();
        true
    }

    /// Undocks a random bond, if the robot stays connected.
    fn undock(&mut self, rng: &mut SplitMix64) -> bool {
        let held: Vec<usize> = self.robot.held().map(|(bond, _)| bond).collect();
        if held.is_empty() {
            return false;
        }
        let bond = held[rng.below(held.len())];
        self.robot.holds[bond] = false;
        let connected = Tree::grow(&self.robot, 0).is_some();
        self.robot.holds[bond] = !connected;
        if connected {
            self.rebuild_tree();
        }
        connected
    }

    /// Rebuilds the tree after bonds changed.
    fn rebuild_tree(&mut self) {
        *self = RandomWalk::new(self.robot.clone());
    }

    /// Returns the bonds that can be made between free docks that meet.
    fn bonds_possible(&self) -> Vec<Bond> {
        let at = self.robot.bond_at();
        let mut bonds = Vec::new();
        broad_phase::pairs(&self.poses, 1.0 + TOLERANCES.equal_transforms, &mut |p, q, _| {
            let (a, b) = (self.tree.shoe[p], self.tree.shoe[q]);
            if a / 2 == b / 2 {
                return;
            }
            for (x, y) in (0..FACES).flat_map(|x| (0..FACES).map(move |y| (x, y))) {
                let dock =
                    |shoe: usize, face: usize| Dock { module: shoe / 2, dock: shoe % 2 * FACES + face };
                let (a, b) = (dock(a, x), dock(b, y));
                let free = |dock: Dock| at[dock.module][dock.dock].is_none();
                if free(a) && free(b) {
                    let turn = (0..4).find(|&turn| self.meets(p, q, &mate(x, turn, y)));
                    bonds.extend(turn.map(|turn| Bond { a, b, turn }));
                }
            }
        });
        bonds.sort_by_key(|bond| (bond.a.min(bond.b), bond.a.max(bond.b)));
        bonds
    }

    /// Returns true if the shoe of index `q` is where a bond to that of `p` would have it.
    fn meets(&self, p: usize, q: usize, mated: &RigidTransform) -> bool {
        let wanted = self.poses[p].then(mated);
        let found = &self.poses[q];
        let apart: Vec3 = wanted.translation - found.translation;
        apart.amax() < TOLERANCES.equal_transforms
            && (wanted.rotation - found.rotation).amax() < TOLERANCES.equal_transforms
    }
}

/// Docks of a module are those of its two shoes.
const _: () = assert!(DOCKS == 2 * FACES);
