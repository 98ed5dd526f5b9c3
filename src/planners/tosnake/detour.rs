//! A way between two postures of a loop where the straight one is not free: two trees of postures, one from
//! either, grow towards each other (RRT-Connect, Kuffner and LaValle 2000).

use super::closing::limited;
use super::robot::GAMMA;
use super::state::Joints;
use super::sweep::Scene;
use super::tree::JointRef;
use crate::planners::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Postures that the trees grow towards, at most.
const SAMPLES: usize = 40;
/// How far samples are off the straight way, in parts of the joints' ranges.
const SPREAD: f64 = 0.4;
/// No joint turns farther from one posture of a tree to the next, rad.
const STEP: f64 = 0.5;

/// A posture with the one before it; the root is its own.
type Node = (Joints, usize);

pub struct Detour<'a> {
    pub scene: &'a Scene<'a>,
    /// The joints that turn.
    pub joints: &'a [JointRef],
}

impl Detour<'_> {
    /// Postures from the first, which is left out, to the last; the straight way from each to the next is free.
    pub fn way(
        &self,
        from: &Joints,
        to: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        let mut trees: [Vec<Node>; 2] = [vec![(from.clone(), 0)], vec![(to.clone(), 0)]];
        for round in 0..SAMPLES {
            let sample = self.sample(from, to, rng);
            let (growing, other) = (round % 2, 1 - round % 2);
            let Some(grown) = self.grow(&mut trees[growing], &sample, work) else { continue };
            let goal = trees[growing][grown].0.clone();
            // The other tree comes as near to the new posture as it can.
            while let Some(next) = self.grow(&mut trees[other], &goal, work) {
                if trees[other][next].0 == goal {
                    let ends = if growing == 0 { [grown, next] } else { [next, grown] };
                    return Some(joined(&trees, ends));
                }
            }
        }
        None
    }

    /// Somewhere about the straight way.
    fn sample(&self, from: &Joints, to: &Joints, rng: &mut SplitMix64) -> Joints {
        let part = rng.next_f64();
        let mut sample = from.clone();
        for joint in self.joints {
            let (k, m) = (joint.joint, joint.module);
            let range = if k == GAMMA { PI } else { FRAC_PI_2 };
            let straight = from[m][k] + part * (to[m][k] - from[m][k]);
            sample[m][k] = limited(k, straight + SPREAD * range * rng.next_signed());
        }
        sample
    }

    /// The posture of a tree that is nearest to a goal goes a step towards it; gives the new one, if the way
    /// there is free.
    fn grow(&self, tree: &mut Vec<Node>, goal: &Joints, work: &mut u64) -> Option<usize> {
        let far = |node: &Node| self.distance(&node.0, goal);
        let nearest = (0..tree.len()).min_by(|&a, &b| far(&tree[a]).total_cmp(&far(&tree[b])))?;
        let from = &tree[nearest].0;
        let greatest = self.joints.iter().map(|j| (goal[j.module][j.joint] - from[j.module][j.joint]).abs());
        let greatest = greatest.fold(0.0, f64::max);
        let mut next = goal.clone();
        if greatest > STEP {
            for joint in self.joints {
                let (k, m) = (joint.joint, joint.module);
                next[m][k] = from[m][k] + STEP / greatest * (goal[m][k] - from[m][k]);
            }
        }
        if !self.scene.is_free(from, &next, work) {
            return None;
        }
        tree.push((next, nearest));
        Some(tree.len() - 1)
    }

    fn distance(&self, a: &Joints, b: &Joints) -> f64 {
        let squared = |joint: &JointRef| {
            let apart = a[joint.module][joint.joint] - b[joint.module][joint.joint];
            apart * apart
        };
        self.joints.iter().map(squared).sum()
    }
}

/// The way through both trees, by way of the same posture of either.
fn joined(trees: &[Vec<Node>; 2], [first, second]: [usize; 2]) -> Vec<Joints> {
    let up = |tree: &[Node], mut at: usize| {
        let mut way = vec![at];
        while at != 0 {
            at = tree[at].1;
            way.push(at);
        }
        way
    };
    let mut there = up(&trees[0], first);
    there.reverse();
    let back = up(&trees[1], second);
    let postures = there[1..].iter().map(|&at| trees[0][at].0.clone());
    postures.chain(back[1..].iter().map(|&at| trees[1][at].0.clone())).collect()
}
