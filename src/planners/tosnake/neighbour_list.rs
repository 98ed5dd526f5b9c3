//! A neighbour list (Verlet list) for inverse kinematics: pairs of balls that are near each other, followed
//! from iteration to iteration and found anew only when balls have gone far enough for that to matter.

use super::broad_phase;
use super::motion_check::Scene;
use super::tolerances::TOLERANCES;
use crate::geometry::{RigidTransform, Vec3};

/// A pair of balls (the spheres of two shoes, which are halves of modules) whose centres are near each other, from
/// [`NeighbourList::within`].
pub struct Neighbours {
    /// The index of the first ball's shoe in the tree's order ([`Tree::shoe`](super::tree::Tree::shoe)), the smaller.
    pub a: usize,
    /// The index of the second ball's shoe in the tree's order ([`Tree::shoe`](super::tree::Tree::shoe)).
    pub b: usize,
    /// The distance of the centres of the two balls, in pitches.
    pub distance: f64,
    /// The unit vector from the centre of a to that of b, in the frame of the `poses` given to
    /// [`NeighbourList::within`]; x if the centres coincide.
    pub normal: Vec3,
}

/// Displacement of a ball in one iteration, in pitches, beyond which a list with a skin would not last until
/// the next one.
const LASTING_STEP_MAX: f64 = 0.2;
/// Skin of a list that is to last, in pitches: five such steps, of which two balls take two.
const SKIN: f64 = 1.0;

/// A neighbour list (Verlet 1967): pairs of balls that may be near each other, kept from one call to the next.
pub struct NeighbourList<'a> {
    scene: &'a Scene<'a>,
    /// Two indices whose balls come as near as their docks ask, and are left out.
    docking_pair: (usize, usize),
    /// The rigid part of each ball: balls of one part do not move against each other, and are left out.
    parts: Vec<usize>,
    list: Vec<(u32, u32)>,
    /// The distance within which the list held all pairs when it was made.
    reach: f64,
    /// Centres of balls when the list was made.
    listed: Vec<Vec3>,
    /// Centres of balls at the last call.
    before: Vec<Vec3>,
}

impl<'a> NeighbourList<'a> {
    /// Returns an empty neighbour list. `docking_pair`: the indices in the tree's order, the smaller first, of two
    /// shoes whose docks are to meet; `parts`: the rigid part of each shoe, see
    /// [`Tree::parts`](super::tree::Tree::parts). `scene`: the robot as checks of collisions see it.
    pub fn new(scene: &'a Scene<'a>, docking_pair: (usize, usize), parts: Vec<usize>) -> NeighbourList<'a> {
        let (list, listed, before) = (Vec::new(), Vec::new(), Vec::new());
        NeighbourList { scene, docking_pair, parts, list, reach: 0.0, listed, before }
    }

    /// Returns the pairs of balls whose centres are nearer than `reach` (pitches). `poses`: of the shoes, in the
    /// tree's order, in pitches. Left out: pairs of one rigid part, pairs that touch by design, and the pair whose
    /// docks are to meet.
    pub fn within(&mut self, reach: f64, poses: &[RigidTransform]) -> Vec<Neighbours> {
        let displacement = |from: &[Vec3]| {
            let squared = |(pose, from): (&RigidTransform, &Vec3)| (pose.translation - from).norm_squared();
            libm::sqrt(poses.iter().zip(from).map(squared).fold(0.0, f64::max))
        };
        // Two balls may have come nearer by twice the greatest displacement.
        if self.listed.is_empty() || self.reach - 2.0 * displacement(&self.listed) < reach {
            let lasts = !self.before.is_empty() && displacement(&self.before) < LASTING_STEP_MAX;
            self.reach = reach + if lasts { SKIN } else { 0.0 };
            self.renew(poses);
        }
        self.before.clear();
        self.before.extend(poses.iter().map(|pose| pose.translation));
        let mut all = Vec::new();
        for &(a, b) in &self.list {
            let (a, b) = (a as usize, b as usize);
            let apart = poses[b].translation - poses[a].translation;
            let squared = apart.norm_squared();
            if squared < reach * reach {
                let distance = libm::sqrt(squared);
                // Balls at one position are driven apart along an arbitrary axis.
                let normal = if distance > TOLERANCES.coincident { apart / distance } else { Vec3::x() };
                all.push(Neighbours { a, b, distance, normal });
            }
        }
        all
    }

    /// Makes the list anew.
    fn renew(&mut self, poses: &[RigidTransform]) {
        let NeighbourList { scene, docking_pair, parts, list, reach, listed, .. } = self;
        list.clear();
        broad_phase::pairs(poses, *reach, &mut |a, b, _| {
            let meet = (a, b) == *docking_pair || (b, a) == *docking_pair;
            if !meet && scene.may_meet(parts, a, b) {
                list.push((a as u32, b as u32));
            }
        });
        listed.clear();
        listed.extend(poses.iter().map(|pose| pose.translation));
    }
}
