//! Balls that are near each other while a loop closes, followed from step to step: which pairs to look
//! at is worked out anew only when balls have gone far enough for that to matter.

use super::near;
use super::sweep::Scene;
use crate::geometry::{RigidTransform, Vec3};

/// Two balls that are near each other.
pub struct Contact {
    pub a: usize,
    pub b: usize,
    pub distance: f64,
    /// From a to b, of length 1.
    pub normal: Vec3,
}

/// Where balls go farther than this in a step, a list of pairs would not last until the next.
const LASTING: f64 = 0.2;
/// The list reaches so much farther where it may last.
const SKIN: f64 = 1.0;

pub struct Contacts<'a> {
    scene: &'a Scene<'a>,
    /// Two places whose balls come as near as their docks ask.
    meeting: (usize, usize),
    /// By place: balls of one number do not move against each other, and need not be looked at.
    parts: Vec<usize>,
    list: Vec<(u32, u32)>,
    /// How far the list reaches.
    reach: f64,
    /// Where balls were when the list was made, and one step before now.
    listed: Vec<Vec3>,
    before: Vec<Vec3>,
}

impl<'a> Contacts<'a> {
    pub fn new(scene: &'a Scene<'a>, meeting: (usize, usize), parts: Vec<usize>) -> Contacts<'a> {
        let (list, listed, before) = (Vec::new(), Vec::new(), Vec::new());
        Contacts { scene, meeting, parts, list, reach: 0.0, listed, before }
    }

    /// All that are nearer than `reach`.
    pub fn within(&mut self, reach: f64, poses: &[RigidTransform]) -> Vec<Contact> {
        let gone = |from: &[Vec3]| {
            let squared = |(pose, from): (&RigidTransform, &Vec3)| (pose.translation - from).norm_squared();
            libm::sqrt(poses.iter().zip(from).map(squared).fold(0.0, f64::max))
        };
        if self.listed.is_empty() || self.reach - 2.0 * gone(&self.listed) < reach {
            let lasts = !self.before.is_empty() && gone(&self.before) < LASTING;
            self.reach = reach + if lasts { SKIN } else { 0.0 };
            self.renew(poses);
        }
        self.before.clear();
        self.before.extend(poses.iter().map(|pose| pose.translation));
        let mut all = Vec::new();
        for &(a, b) in &self.list {
            let (a, b) = (a as usize, b as usize);
            let way = poses[b].translation - poses[a].translation;
            let squared = way.norm_squared();
            if squared < reach * reach {
                let distance = libm::sqrt(squared);
                // Balls in one place have to go somewhere.
                let normal = if distance > 1e-6 { way / distance } else { Vec3::x() };
                all.push(Contact { a, b, distance, normal });
            }
        }
        all
    }

    fn renew(&mut self, poses: &[RigidTransform]) {
        let Contacts { scene, meeting, parts, list, reach, listed, .. } = self;
        list.clear();
        near::pairs(poses, *reach, &mut |a, b, _| {
            let meet = (a, b) == *meeting || (b, a) == *meeting;
            if !meet && scene.may_meet(parts, a, b) {
                list.push((a as u32, b as u32));
            }
        });
        listed.clear();
        listed.extend(poses.iter().map(|pose| pose.translation));
    }
}
