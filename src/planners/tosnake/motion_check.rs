//! Continuous collision checking of a straight motion in joint space: many joints turn at once, each at its
//! own constant rate.
//!
//! The motion is followed in steps of adaptive length as in conservative advancement, but without its proof: within a
//! step balls go nearly straight. Their deviation from the straight line is measured in the middle of each step, and
//! the required distance is enlarged by it. The judge proves the motion afterwards.

use super::broad_phase::{self, always_touch};
use super::gravity::{GravityModel, JointLoad};
use super::motion_bounds::ClusterPairs;
use super::robot::Robot;
use super::stance::{Rest, Stance};
use super::tolerances::TOLERANCES;
use super::tree::{Carried, Tree};
use crate::geometry::RigidTransform;
use crate::geometry::broad_phase::{Aabb, all_near_points};
use std::cell::Cell;

/// Greatest displacement of a ball in a step, in pitches.
const STEP_MAX: f64 = 0.4;
/// The first step, as a fraction of the motion.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// Instants checked before all others, as fractions of the motion: of the motions that are not free, the first finds
/// about eight in ten, all three more than nine in ten.
const PRECHECK_INSTANTS: [f64; 3] = [0.5, 0.25, 0.75];

/// The robot as collision and load checks need it: its tree, its docked shoes and its limit of loads.
pub struct Scene<'a> {
    /// The kinematic tree over the closed bonds of the robot.
    pub tree: &'a Tree,
    /// The pairs of shoes docked to each other, as indices in the tree's order, ascending; see
    /// [`broad_phase::docked`].
    pub docked: Vec<(usize, usize)>,
    /// The limit on loads of joints; `None` if the robot is not held.
    pub load_limit: Option<LoadLimit<'a>>,
    /// The stance of a robot that rests on the floor; `None` if it is held or floats.
    pub stance: Option<&'a Stance>,
}

/// A limit on the static loads that joints bear under gravity during a motion.
#[derive(Clone, Copy)]
pub struct LoadLimit<'a> {
    /// The gravity model that loads are computed by.
    pub gravity: &'a GravityModel,
    /// The greatest load that is allowed, as a fraction of the joint's torque limit, less
    /// [`load_spare`](super::Tolerances::load_spare) of it.
    pub share: f64,
    /// The smallest overload so far, which checks of motions write; `None` without any. Of each overloaded motion the
    /// greatest load found counts.
    pub least_overload: &'a Cell<Option<JointLoad>>,
}

/// Number of instants at which the greatest load of an overloaded motion is evaluated.
const OVERLOAD_INSTANTS: u32 = 16;

impl LoadLimit<'_> {
    /// Returns true if all joints hold their loads in a posture.
    fn holds(&self, tree: &Tree, poses: &[RigidTransform]) -> bool {
        let load = self.gravity.greatest(tree, poses);
        load.ratio <= self.share * (1.0 - TOLERANCES.load_spare)
    }
}

/// Stores an overload in `least_overload` if its ratio is less than that of the one stored.
pub(super) fn note_overload(least_overload: &Cell<Option<JointLoad>>, load: JointLoad) {
    if least_overload.get().is_none_or(|known| load.ratio < known.ratio) {
        least_overload.set(Some(load));
    }
}

impl<'a> Scene<'a> {
    /// Returns the scene of a floating robot, without a limit of loads; `tree`: the kinematic tree over its closed
    /// bonds.
    pub fn new(robot: &Robot, tree: &'a Tree) -> Scene<'a> {
        Scene { tree, docked: broad_phase::docked(robot, tree), load_limit: None, stance: None }
    }

    /// Returns true if two balls, given by their indices in the tree's order ([`Tree::shoe`]), are of different rigid
    /// parts and do not touch by design. `parts`: the part of each ball, as by [`Tree::parts`]. Panics if an index is
    /// none of the tree.
    pub fn may_meet(&self, parts: &[usize], a: usize, b: usize) -> bool {
        parts[a] != parts[b] && !always_touch(self.tree, a, b, &self.docked)
    }

    /// Returns true if a check of the straight motion between two joint positions (rad, by module) finds no overlap of
    /// balls and no overloaded joint, and on the floor no fall. A motion that would need too short steps is refused.
    /// `work` counts forward kinematics.
    pub fn is_free(&self, from: &[[f64; 3]], to: &[[f64; 3]], work: &mut u64) -> bool {
        self.rest_after(from, to, work).is_some()
    }

    /// Returns the rest of a robot on the floor after a motion that is free as by [`Scene::is_free`], [`Rest::NONE`] of one
    /// that is not on the floor; `None` if the motion is not free.
    pub(super) fn rest_after(&self, from: &[[f64; 3]], to: &[[f64; 3]], work: &mut u64) -> Option<Rest> {
        let turns = |module: usize| from[module] != to[module];
        let parts = self.tree.parts(turns);
        let mut here = Vec::new();
        let mut carried = self.tree.carried(turns, from, &mut here);
        // Loads ask for all poses.
        let is_weighed = self.load_limit.is_some() || self.stance.is_some();
        if !is_weighed {
            carried = carried.by_parts(self.tree, &parts, &here);
        }
        let turning = (0..from.len()).filter(|module| turns(*module)).collect();
        *work += 1;
        let joints = from.to_vec();
        let mut motion =
            Motion { scene: self, from, to, parts, carried, turning, joints, work, rest: Rest::NONE };
        if let Some(stance) = self.stance {
            motion.rest = stance.model.rest(self.tree, &here, stance.down_in_root(self.tree, &here))?;
        }
        // Under gravity the overload that comes first counts.
        let is_free = (is_weighed || motion.may_be_free(&here)) && motion.is_free(here);
        is_free.then_some(motion.rest)
    }
}

/// A straight motion in joint space, from time 0 to time 1.
struct Motion<'a> {
    scene: &'a Scene<'a>,
    from: &'a [[f64; 3]],
    to: &'a [[f64; 3]],
    parts: Vec<usize>,
    /// The shoes that move.
    carried: Carried,
    /// The modules whose joints turn.
    turning: Vec<usize>,
    joints: Vec<[f64; 3]>,
    work: &'a mut u64,
    /// The rest on the floor at the instant up to which the motion was followed.
    rest: Rest,
}

/// The outcome of a step of a motion for a robot on the floor.
enum Standing {
    /// It stands all the time, and rests so at the end.
    Stands(Rest),
    /// Its contacts change, and the step is too long to tell in which way.
    TooFar,
    /// It falls over, or a joint is overloaded.
    Fails,
}

impl Motion<'_> {
    /// Computes the poses at time `t`. `poses` are those of any other time.
    fn poses_at(&mut self, t: f64, poses: &mut [RigidTransform]) {
        for &module in &self.turning {
            for k in 0..3 {
                let (from, to) = (self.from[module][k], self.to[module][k]);
                self.joints[module][k] = from + t * (to - from);
            }
        }
        *self.work += 1;
        self.carried.poses(&self.joints, poses);
    }

    /// Returns false if balls overlap at one of a few instants, which rules out most motions that are not free.
    fn may_be_free(&mut self, here: &[RigidTransform]) -> bool {
        let mut poses = here.to_vec();
        PRECHECK_INSTANTS.iter().all(|&t| {
            self.poses_at(t, &mut poses);
            self.all_near(&poses, TOLERANCES.min_distance, &mut |a, b, _| {
                !self.scene.may_meet(&self.parts, a, b)
            })
        })
    }

    /// Follows the whole motion from the poses at its start.
    fn is_free(&mut self, mut here: Vec<RigidTransform>) -> bool {
        let (mut middle, mut there) = (here.clone(), here.clone());
        let (mut t, mut step) = (0.0, FIRST_STEP);
        let parts = std::mem::take(&mut self.parts);
        let mut pairs = ClusterPairs::new(self.scene, &parts, self.from, self.to);
        while t < 1.0 {
            crate::interrupt::checkpoint();
            // The step is halved until balls go nearly straight.
            let until = f64::min(1.0, t + step);
            self.poses_at(0.5 * (t + until), &mut middle);
            self.poses_at(until, &mut there);
            let (deviation, far) = deviation(&self.carried.shoes, &here, &middle, &there);
            if deviation > TOLERANCES.deviation || far > STEP_MAX {
                step = 0.5 * (until - t);
                if step < TOLERANCES.step_min {
                    return false;
                }
                continue;
            }
            if let Some(limit) = self.scene.load_limit
                && !(limit.holds(self.scene.tree, &middle) && limit.holds(self.scene.tree, &there))
            {
                self.note_overload(limit, &middle, &there);
                return false;
            }
            if let Some(stance) = self.scene.stance {
                match self.stands(stance, &middle, &there) {
                    Standing::Stands(rest) => self.rest = rest,
                    Standing::TooFar if until - t > TOLERANCES.handover_step => {
                        step = 0.5 * (until - t);
                        continue;
                    }
                    Standing::TooFar => {
                        stance.note_fall();
                        return false;
                    }
                    Standing::Fails => return false,
                }
            }
            // Two straight halves, with what they deviate by to spare.
            let apart = TOLERANCES.min_distance + 0.75 * deviation;
            if pairs.overlap((t, until), [&here, &middle, &there], apart) {
                return false;
            }
            if deviation < TOLERANCES.deviation / 5.0 && far < STEP_MAX / 2.5 {
                step *= 2.0;
            }
            t = until;
            std::mem::swap(&mut here, &mut there);
        }
        true
    }

    /// Returns the outcome of a step for the robot on the floor, from its two halves.
    fn stands(&self, stance: &Stance, middle: &[RigidTransform], there: &[RigidTransform]) -> Standing {
        let mut last = self.rest.clone();
        for poses in [middle, there] {
            let Some(rest) = stance.model.rest(self.scene.tree, poses, last.down) else {
                return Standing::TooFar;
            };
            if rest.contacts != last.contacts && rest.down.cross(&last.down).norm() > TOLERANCES.handover {
                return Standing::TooFar;
            }
            if !stance.bears(self.scene.tree, poses, &rest) {
                return Standing::Fails;
            }
            last = rest;
        }
        Standing::Stands(last)
    }

    /// Notes the greatest load of the whole motion.
    fn note_overload(&mut self, limit: LoadLimit, middle: &[RigidTransform], there: &[RigidTransform]) {
        let greatest = |poses: &[RigidTransform]| limit.gravity.greatest(self.scene.tree, poses);
        let mut most = greatest(middle).greater(greatest(there));
        let mut poses = middle.to_vec();
        for part in 1..=OVERLOAD_INSTANTS {
            self.poses_at(f64::from(part) / f64::from(OVERLOAD_INSTANTS), &mut poses);
            most = most.greater(limit.gravity.greatest(self.scene.tree, &poses));
        }
        note_overload(limit.least_overload, most);
    }

    /// Returns true if `holds` does of every pair of balls whose centres are nearer than `reach` and of which one moves: their
    /// indices, the smaller first, and the squared distance of the centres. It is asked of pairs that both stay, too, where these are near a ball that moves.
    fn all_near(
        &self,
        poses: &[RigidTransform],
        reach: f64,
        holds: &mut dyn FnMut(usize, usize, f64) -> bool,
    ) -> bool {
        let carried = &self.carried.shoes;
        let moving = Aabb::around(carried.iter().map(|index| poses[*index].translation));
        let (low, high) = (moving.low.add_scalar(-reach), moving.high.add_scalar(reach));
        let near = |index: &usize| {
            let at = &poses[*index].translation;
            (0..3).all(|k| low[k] <= at[k] && at[k] <= high[k])
        };
        let near: Vec<usize> = (0..poses.len()).filter(near).collect();
        let place = |index: usize| poses[near[index]].translation;
        all_near_points(near.len(), place, reach, &mut |a, b, squared| holds(near[a], near[b], squared))
    }
}

/// Returns the greatest deviation of a ball from the straight line in the middle of a step, and the greatest
/// displacement, in pitches.
fn deviation(
    carried: &[usize],
    here: &[RigidTransform],
    middle: &[RigidTransform],
    there: &[RigidTransform],
) -> (f64, f64) {
    let (mut deviation, mut far) = (0.0f64, 0.0f64);
    for &index in carried {
        let (h, m, t) = (&here[index].translation, &middle[index].translation, &there[index].translation);
        deviation = deviation.max((m - (h + t) * 0.5).norm_squared());
        far = far.max((t - h).norm_squared());
    }
    (libm::sqrt(deviation), libm::sqrt(far))
}
