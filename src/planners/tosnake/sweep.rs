//! Many joints turn at once, each at its own steady rate: does anything meet?
//!
//! Balls are followed from instant to instant, so often that between two of them they go nearly straight;
//! by how much not is measured in the middle and allowed for. The judge proves it afterwards.

use super::near::{self, touch_always};
use super::robot::Robot;
use super::tree::Tree;
use super::weight::{Load, Weight};
use crate::geometry::{RigidTransform, Vec3};
use std::cell::Cell;

/// Balls are never nearer than this; the judge's limit is 0.999.
pub const APART: f64 = 1.0 - 6e-4;

/// How far a ball may be off its straight way in the middle between two instants.
const BEND_MAX: f64 = 4e-4;
/// How far a ball goes at most between two instants.
const STEP_MAX: f64 = 0.4;
/// The list of near pairs reaches this far beyond touching.
const SKIN: f64 = 1.5;
/// Instants that are looked at first, in parts of the whole motion: of the ways that are not free, at the first
/// of them about eight in ten are found out, at all three more than nine.
const GLANCES: [f64; 3] = [0.5, 0.25, 0.75];
/// The shortest step, in parts of the whole motion.
const PART_MIN: f64 = 1e-7;

/// What moves, and what need not be looked at.
pub struct Scene<'a> {
    pub tree: &'a Tree,
    /// Pairs of places that are docked; see [`near::docked`].
    pub docked: Vec<(usize, usize)>,
    pub burden: Option<Burden<'a>>,
}

/// What joints may have to hold on the way.
#[derive(Clone, Copy)]
pub struct Burden<'a> {
    pub weight: &'a Weight,
    /// Of their limits.
    pub share: f64,
    /// The least of the loads that were too great: of each way the greatest that was seen.
    pub refused: &'a Cell<Option<Load>>,
}

/// By so much a load may grow, in parts of it, between instants at which no ball is off its straight way
/// by more than [`BEND_MAX`]: an axis turns as a ball does that is a pitch away.
pub const LOAD_SPARE: f64 = 2e-3;

/// Instants of a way that is too heavy at which its greatest load is looked for.
const PARTS: u32 = 16;

impl Burden<'_> {
    /// Whether joints hold their loads in a posture.
    fn is_borne(&self, tree: &Tree, poses: &[RigidTransform]) -> bool {
        let load = self.weight.greatest(tree, poses);
        load.ratio <= self.share * (1.0 - LOAD_SPARE)
    }
}

/// Remembers a load that was too great, if it is less than the one that is remembered.
pub fn lessened(refused: &Cell<Option<Load>>, load: Load) {
    if refused.get().is_none_or(|known| load.ratio < known.ratio) {
        refused.set(Some(load));
    }
}

impl<'a> Scene<'a> {
    pub fn new(robot: &Robot, tree: &'a Tree) -> Scene<'a> {
        Scene { tree, docked: near::docked(robot, tree), burden: None }
    }

    /// Whether two places' balls move against each other ([`Tree::parts`]) and do not always touch.
    pub fn may_meet(&self, parts: &[usize], a: usize, b: usize) -> bool {
        parts[a] != parts[b] && !touch_always(self.tree, a, b, &self.docked)
    }

    /// Whether the straight way between two positions of the joints is free, and no load on it too
    /// great. `work` counts poses.
    pub fn is_free(&self, from: &[[f64; 3]], to: &[[f64; 3]], work: &mut u64) -> bool {
        let rigid = self.tree.parts(|module| from[module] != to[module]);
        let carried = self.tree.carried(|module| from[module] != to[module]);
        let mut walk = Walk { scene: self, from, to, rigid, carried, joints: from.to_vec(), work };
        let mut here = Vec::new();
        *walk.work += 1;
        self.tree.poses(from, &mut here);
        // Under weight it matters what is in the way first.
        (self.burden.is_some() || walk.may_be_free(&here)) && walk.is_free(here)
    }
}

struct Walk<'a> {
    scene: &'a Scene<'a>,
    from: &'a [[f64; 3]],
    to: &'a [[f64; 3]],
    rigid: Vec<usize>,
    /// The places that move.
    carried: Vec<usize>,
    joints: Vec<[f64; 3]>,
    work: &'a mut u64,
}

impl Walk<'_> {
    /// `poses` are those of any instant before.
    fn at(&mut self, t: f64, poses: &mut [RigidTransform]) {
        for (joint, (from, to)) in self.joints.iter_mut().zip(self.from.iter().zip(self.to)) {
            for k in 0..3 {
                joint[k] = from[k] + t * (to[k] - from[k]);
            }
        }
        *self.work += 1;
        self.scene.tree.poses_of(&self.carried, &self.joints, poses);
    }

    /// Whether nothing meets at a few instants: most ways on which something does are found so, quickly.
    fn may_be_free(&mut self, here: &[RigidTransform]) -> bool {
        let mut poses = here.to_vec();
        GLANCES.iter().all(|&t| {
            self.at(t, &mut poses);
            let mut apart = true;
            near::pairs(&poses, APART, &mut |a, b, _| apart &= !self.scene.may_meet(&self.rigid, a, b));
            apart
        })
    }

    fn is_free(&mut self, mut here: Vec<RigidTransform>) -> bool {
        let (mut middle, mut there) = (here.clone(), here.clone());
        let (mut t, mut step) = (0.0, 1.0 / 16.0);
        let mut list = self.list(&here);
        let mut gone = 0.0;
        while t < 1.0 {
            crate::interrupt::checkpoint();
            let until = f64::min(1.0, t + step);
            self.at(0.5 * (t + until), &mut middle);
            self.at(until, &mut there);
            let (bend, far) = bent(&self.carried, &here, &middle, &there);
            if bend > BEND_MAX || far > STEP_MAX {
                step = 0.5 * (until - t);
                if step < PART_MIN {
                    return false;
                }
                continue;
            }
            if gone + far > SKIN / 2.0 {
                list = self.list(&here);
                gone = 0.0;
            }
            gone += far;
            if let Some(burden) = self.scene.burden
                && !(burden.is_borne(self.scene.tree, &middle) && burden.is_borne(self.scene.tree, &there))
            {
                self.refuse(burden, &middle, &there);
                return false;
            }
            let apart = APART + 0.75 * bend;
            if meets(&list, &here, &middle, apart) || meets(&list, &middle, &there, apart) {
                return false;
            }
            if bend < BEND_MAX / 5.0 && far < STEP_MAX / 2.5 {
                step *= 2.0;
            }
            t = until;
            std::mem::swap(&mut here, &mut there);
        }
        true
    }

    /// Remembers the greatest load of the whole way.
    fn refuse(&mut self, burden: Burden, middle: &[RigidTransform], there: &[RigidTransform]) {
        let greatest = |poses: &[RigidTransform]| burden.weight.greatest(self.scene.tree, poses);
        let mut most = greatest(middle).greater(greatest(there));
        let mut poses = middle.to_vec();
        for part in 1..=PARTS {
            self.at(f64::from(part) / f64::from(PARTS), &mut poses);
            most = most.greater(burden.weight.greatest(self.scene.tree, &poses));
        }
        lessened(burden.refused, most);
    }

    /// Pairs that may meet within a while.
    fn list(&self, poses: &[RigidTransform]) -> Vec<(u32, u32)> {
        let mut list = Vec::new();
        near::pairs(poses, 1.0 + SKIN, &mut |a, b, _| {
            if self.scene.may_meet(&self.rigid, a, b) {
                list.push((a as u32, b as u32));
            }
        });
        list
    }
}

/// How far balls are off the straight way in the middle, and how far they go, at most.
fn bent(
    carried: &[usize],
    here: &[RigidTransform],
    middle: &[RigidTransform],
    there: &[RigidTransform],
) -> (f64, f64) {
    let (mut bend, mut far) = (0.0f64, 0.0f64);
    for &place in carried {
        let (h, m, t) = (&here[place], &middle[place], &there[place]);
        bend = bend.max((m.translation - (h.translation + t.translation) * 0.5).norm_squared());
        far = far.max((t.translation - h.translation).norm_squared());
    }
    (libm::sqrt(bend), libm::sqrt(far))
}

fn meets(list: &[(u32, u32)], from: &[RigidTransform], to: &[RigidTransform], apart: f64) -> bool {
    list.iter().any(|&(a, b)| {
        let (a, b) = (a as usize, b as usize);
        let r0 = from[b].translation - from[a].translation;
        let r1 = to[b].translation - to[a].translation;
        nearest_squared(&r0, &(r1 - r0)) < apart * apart
    })
}

/// The least squared length of `r + s·d` for s from 0 to 1.
fn nearest_squared(r: &Vec3, d: &Vec3) -> f64 {
    let along = d.norm_squared();
    let s = if along > 0.0 { (-r.dot(d) / along).clamp(0.0, 1.0) } else { 0.0 };
    (r + d * s).norm_squared()
}
