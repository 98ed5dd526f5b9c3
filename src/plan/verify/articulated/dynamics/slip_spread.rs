//! The spread of the travel if wheels and feet slip by a part of their own speed: how far the heading and the place of the
//! robot may then go astray.
//!
//! The velocities that the joints give the contacts of one link are taken to be off by the same part of them, at most `slip`
//! in size; the links are independent of each other. The twist of the base follows them as friction weighs them: the
//! reweighted least squares of [`twist`](super::twist), linearised where they ended. The worst signs of all links are summed,
//! so that a differential drive with the track width W goes astray in heading by `slip (|v_l| + |v_r|) / W` a second.

use super::posed::Candidate;
use super::twist::regularized_speed;
use crate::geometry::Vec3;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

/// The rates at which a robot goes astray, for each unit of slip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlipSpread {
    /// The rate of the heading, rad/s.
    pub heading: f64,
    /// The rate of the place of the centre of mass, m/s, without what follows from the heading.
    pub place: f64,
}

impl SlipSpread {
    /// Returns the rates at an instant. `loads`: the normal force at each candidate, N; `friction`: the slip (m/s) and the
    /// force of friction at each. Zero where no contact bears a load.
    pub(super) fn of(candidates: &[Candidate], loads: &[f64], friction: &[(Vec3, Vec3)]) -> SlipSpread {
        let mut resistance = Matrix3::zeros();
        let mut pulls: BTreeMap<usize, Vector3<f64>> = BTreeMap::new();
        for ((candidate, load), (slip, _)) in candidates.iter().zip(loads).zip(friction) {
            if *load <= 0.0 {
                continue;
            }
            let (p, v) = (&candidate.p, &candidate.by_joints);
            let weight = candidate.friction * load / regularized_speed(slip.norm_squared());
            resistance +=
                weight * Matrix3::new(1.0, 0.0, -p.y, 0.0, 1.0, p.x, -p.y, p.x, p.x * p.x + p.y * p.y);
            *pulls.entry(candidate.link).or_default() +=
                weight * Vector3::new(v.x, v.y, p.x * v.y - p.y * v.x);
        }
        let Some(resistance) = resistance.cholesky() else { return SlipSpread::default() };
        let mut spread = SlipSpread::default();
        for pull in pulls.values() {
            let twist = resistance.solve(pull);
            spread.heading += twist.z.abs();
            spread.place += libm::hypot(twist.x, twist.y);
        }
        spread
    }
}
