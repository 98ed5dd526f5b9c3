//! RRT-Connect (Kuffner and LaValle 2000): a path between two postures of a loop where the straight motion is
//! not free. Two trees of postures, rooted at either end, grow towards random samples and each other.

use super::inverse_kinematics::clamped;
use super::motion_check::Scene;
use super::robot::GAMMA;
use super::state::Joints;
use super::tree::JointRef;
use crate::optimize::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Greatest number of samples.
const SAMPLES_MAX: usize = 40;
/// Half the width of the samples around the straight motion, as a fraction of the joints' ranges.
const SAMPLE_SPREAD: f64 = 0.4;
/// Greatest turn of a joint from one node of a tree to the next, rad.
const STEP_MAX: f64 = 0.5;

/// A posture with the index of its parent; the root is its own.
type Node = (Joints, usize);

/// RRT-Connect (Kuffner and LaValle 2000) in the space of some joints of the robot.
pub struct RrtConnect<'a> {
    /// The robot as checks of collisions and loads see it.
    pub scene: &'a Scene<'a>,
    /// The joints that turn; the others keep their positions at the start of the path.
    pub joints: &'a [JointRef],
}

impl RrtConnect<'_> {
    /// Returns a path of postures (rad, by module) from `from`, left out, to `to`, between which straight motions in
    /// joint space are free; `None` if `SAMPLES_MAX` samples find none. `to` must differ from `from` in `joints` only.
    /// `work` counts forward kinematics. `rng`: the generator of samples.
    pub fn path(
        &self,
        from: &Joints,
        to: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        let mut trees: [Vec<Node>; 2] = [vec![(from.clone(), 0)], vec![(to.clone(), 0)]];
        for round in 0..SAMPLES_MAX {
            // One tree extends towards a sample; the trees take turns.
            let sample = self.sample(from, to, rng);
            let (growing, other) = (round % 2, 1 - round % 2);
            let Some(grown) = self.extend(&mut trees[growing], &sample, work) else { continue };
            let goal = trees[growing][grown].0.clone();
            // The other tree connects: it comes as near to the new node as it can.
            while let Some(next) = self.extend(&mut trees[other], &goal, work) {
                if trees[other][next].0 == goal {
                    let ends = if growing == 0 { [grown, next] } else { [next, grown] };
                    return Some(joined(&trees, ends));
                }
            }
        }
        None
    }

    /// Returns a random posture around the straight motion.
    fn sample(&self, from: &Joints, to: &Joints, rng: &mut SplitMix64) -> Joints {
        let part = rng.next_f64();
        let mut sample = from.clone();
        for joint in self.joints {
            let (k, m) = (joint.joint, joint.module);
            let range = if k == GAMMA { PI } else { FRAC_PI_2 };
            let straight = from[m][k] + part * (to[m][k] - from[m][k]);
            sample[m][k] = clamped(k, straight + SAMPLE_SPREAD * range * rng.next_signed());
        }
        sample
    }

    /// Extends a tree by one step from its node nearest to a goal towards it; returns the new node, or `None`
    /// if the motion there is not free.
    fn extend(&self, tree: &mut Vec<Node>, goal: &Joints, work: &mut u64) -> Option<usize> {
        let far = |node: &Node| self.squared_distance(&node.0, goal);
        let nearest = (0..tree.len()).min_by(|&a, &b| far(&tree[a]).total_cmp(&far(&tree[b])))?;
        let from = &tree[nearest].0;
        let greatest = self.joints.iter().map(|j| (goal[j.module][j.joint] - from[j.module][j.joint]).abs());
        let greatest = greatest.fold(0.0, f64::max);
        let mut next = goal.clone();
        if greatest > STEP_MAX {
            for joint in self.joints {
                let (k, m) = (joint.joint, joint.module);
                next[m][k] = from[m][k] + STEP_MAX / greatest * (goal[m][k] - from[m][k]);
            }
        }
        if !self.scene.is_free(from, &next, work) {
            return None;
        }
        tree.push((next, nearest));
        Some(tree.len() - 1)
    }

    /// Returns the squared distance in joint space, rad².
    fn squared_distance(&self, a: &Joints, b: &Joints) -> f64 {
        let squared = |joint: &JointRef| {
            let apart = a[joint.module][joint.joint] - b[joint.module][joint.joint];
            apart * apart
        };
        self.joints.iter().map(squared).sum()
    }
}

/// Returns the path through both trees, through one node of each that have the same posture.
fn joined(trees: &[Vec<Node>; 2], [first, second]: [usize; 2]) -> Vec<Joints> {
    let to_root = |tree: &[Node], mut at: usize| {
        let mut nodes = vec![at];
        while at != 0 {
            at = tree[at].1;
            nodes.push(at);
        }
        nodes
    };
    let mut there = to_root(&trees[0], first);
    there.reverse();
    let back = to_root(&trees[1], second);
    let postures = there[1..].iter().map(|&at| trees[0][at].0.clone());
    postures.chain(back[1..].iter().map(|&at| trees[1][at].0.clone())).collect()
}
