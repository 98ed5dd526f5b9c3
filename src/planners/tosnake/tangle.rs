//! Tangles to unwind: a straight snake that does random things, all of which it can do.

use super::near;
use super::robot::{Bond, DOCKS, Dock, FACES, GAMMA, Robot, mate};
use super::sweep::APART;
use super::tree::{JointRef, Tree};
use super::turn;
use crate::geometry::{RigidTransform, Vec3};
use crate::planners::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Of so many actions one docks, and one lets go; the others turn a joint.
const DOCKING_OF: usize = 10;

/// Attempts for each action, at most: in a tangle that can do little the rest is left.
const ATTEMPTS_MAX: usize = 100;

/// Docks that are nearer than this meet: on a lattice of quarter turns the next are half a pitch away.
const TOL_MEET: f64 = 1e-6;

/// A snake of `modules` after so many random actions: quarter turns of joints, each free on the way,
/// docking where docks meet, and letting go where the robot stays in one piece. The same seed gives the
/// same tangle.
pub fn tangled(modules: usize, actions: usize, seed: u64) -> Robot {
    let bond = |m: usize| Bond { a: Dock::red(2 * m + 1), b: Dock::red(2 * (m + 1)), turn: 0 };
    let bonds: Vec<Bond> = (0..modules.saturating_sub(1)).map(bond).collect();
    let holds = vec![true; bonds.len()];
    let mut tangle = Tangle::new(Robot { joints: vec![[0.0; 3]; modules], bonds, holds });
    let mut rng = SplitMix64(seed);
    let (mut done, mut tried) = (0, 0);
    while done < actions && tried < actions.saturating_mul(ATTEMPTS_MAX) {
        tried += 1;
        crate::interrupt::progress_checkpoint(|| format!("{done} of {actions} actions"));
        let did = match rng.below(DOCKING_OF) {
            0 => tangle.dock(&mut rng),
            1 => tangle.undock(&mut rng),
            _ => tangle.turn(&mut rng),
        };
        done += usize::from(did);
    }
    let Robot { joints, bonds, holds } = tangle.robot;
    let held: Vec<Bond> = bonds.into_iter().zip(holds).filter(|(_, held)| *held).map(|(b, _)| b).collect();
    Robot { joints, holds: vec![true; held.len()], bonds: held }
}

struct Tangle {
    robot: Robot,
    tree: Tree,
    joints: Vec<JointRef>,
    poses: Vec<RigidTransform>,
}

impl Tangle {
    fn new(robot: Robot) -> Tangle {
        let tree = Tree::grow(&robot, robot.modules() / 2).expect("a snake hangs together");
        let mut poses = Vec::new();
        tree.poses(&robot.joints, &mut poses);
        Tangle { joints: tree.all_joints(), robot, tree, poses }
    }

    fn turn(&mut self, rng: &mut SplitMix64) -> bool {
        let joint = self.joints[rng.below(self.joints.len())];
        let turn = if rng.below(2) == 0 { FRAC_PI_2 } else { -FRAC_PI_2 };
        let mut to = self.robot.joints[joint.module][joint.joint] + turn;
        if joint.joint == GAMMA {
            to = if to > PI + TOL_MEET {
                to - TAU
            } else if to < -PI + TOL_MEET {
                to + TAU
            } else {
                to
            };
        } else if to.abs() > FRAC_PI_2 + TOL_MEET {
            return false;
        }
        if self.is_in_loop(joint.place) || turn::free(&self.tree, joint, &self.poses, turn, APART) != turn {
            return false;
        }
        // Quarters do not add up rounding.
        self.robot.joints[joint.module][joint.joint] = FRAC_PI_2 * libm::round(to / FRAC_PI_2);
        self.tree.poses(&self.robot.joints, &mut self.poses);
        true
    }

    /// Whether a bond that closes a loop joins what hangs on a place to the rest.
    fn is_in_loop(&self, place: usize) -> bool {
        self.tree.closing.iter().any(|&bond| {
            let ends = self.robot.bonds[bond];
            let hangs = |dock: Dock| self.tree.hangs_on(self.tree.place[dock.shoe()], place);
            hangs(ends.a) != hangs(ends.b)
        })
    }

    fn dock(&mut self, rng: &mut SplitMix64) -> bool {
        let meeting = self.meeting();
        if meeting.is_empty() {
            return false;
        }
        let bond = meeting[rng.below(meeting.len())];
        self.robot.dock(bond);
        self.regrow();
        true
    }

    fn undock(&mut self, rng: &mut SplitMix64) -> bool {
        let held: Vec<usize> = self.robot.held().map(|(bond, _)| bond).collect();
        if held.is_empty() {
            return false;
        }
        let bond = held[rng.below(held.len())];
        self.robot.holds[bond] = false;
        let whole = Tree::grow(&self.robot, 0).is_some();
        self.robot.holds[bond] = !whole;
        if whole {
            self.regrow();
        }
        whole
    }

    fn regrow(&mut self) {
        *self = Tangle::new(self.robot.clone());
    }

    /// Bonds that can be made: free docks that meet, with their turn.
    fn meeting(&self) -> Vec<Bond> {
        let at = self.robot.bond_at();
        let mut bonds = Vec::new();
        near::pairs(&self.poses, 1.0 + TOL_MEET, &mut |p, q, _| {
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

    fn meets(&self, p: usize, q: usize, mated: &RigidTransform) -> bool {
        let wanted = self.poses[p].then(mated);
        let found = &self.poses[q];
        let apart: Vec3 = wanted.translation - found.translation;
        apart.amax() < TOL_MEET && (wanted.rotation - found.rotation).amax() < TOL_MEET
    }
}

/// Docks of a module, as the robot counts them.
const _: () = assert!(DOCKS == 2 * FACES);
