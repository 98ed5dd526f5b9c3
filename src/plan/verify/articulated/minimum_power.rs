//! Quasi-static motion over the ground while joints move, by the minimum power principle (Peshkin and Sanderson
//! 1989): wheels roll, feet hold.
//!
//! The displacement is the one for which the sum of load times friction times slip over all patches is least:
//! Coulomb friction lets the loaded contacts stick and the light ones slip. Contacts of the sample before and of
//! this one count half each, which makes it reversible in time.

use super::contact::ContactPatch;
use super::model::{Model, Posture};
use super::stance::Stance;
use super::tolerances::NUMERICS;
use crate::geometry::Mat3;
use crate::geometry::Vec3;

/// A pose in the plane: the horizontal position of the centre of mass, m, and the heading, rad, in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarPose {
    /// The position of the centre of mass along the x axis of the world, m.
    pub x: f64,
    /// The position of the centre of mass along the y axis of the world, m.
    pub y: f64,
    /// The heading of the level axes, rad, counter-clockwise from above in the world; 0 at the start, and wherever a
    /// stance is built anew.
    pub yaw: f64,
}

impl PlanarPose {
    /// Returns the pose after a motion along a circular arc. `shift`: the displacement in the pose's own frame,
    /// (forward, m; left, m; turn, rad, counter-clockwise from above).
    pub fn moved(&self, shift: &Vec3) -> PlanarPose {
        let (s, c) = libm::sincos(shift.z);
        // sin(w)/w and (1 - cos w)/w, by their series where w is small.
        let (a, b) = if shift.z.abs() > NUMERICS.series_angle {
            (s / shift.z, (1.0 - c) / shift.z)
        } else {
            (1.0, shift.z / 2.0)
        };
        let (dx, dy) = (a * shift.x - b * shift.y, b * shift.x + a * shift.y);
        let (s, c) = libm::sincos(self.yaw);
        PlanarPose { x: self.x + c * dx - s * dy, y: self.y + s * dx + c * dy, yaw: self.yaw + shift.z }
    }
}

/// Returns a vector in level axes, whose heading is `yaw` (rad), in the axes of the ground.
pub(super) fn along_ground(v: &Vec3, yaw: f64) -> Vec3 {
    let (s, c) = libm::sincos(yaw);
    Vec3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z)
}

/// The greatest number of rounds of reweighted least squares.
const ROUNDS_MAX: usize = 100;

/// A patch with its motion from the sample before to this one if the base stood still, in level axes.
struct SlidingPatch {
    /// The number of its link.
    link: usize,
    /// The load as a part of the weight, halved.
    load: f64,
    /// The load times the coefficient of friction.
    friction_load: f64,
    /// The centre of pressure from the centre of mass along x, m.
    x: f64,
    /// The centre of pressure from the centre of mass along y, m.
    y: f64,
    /// The mean square distance of the contact points from the centre of pressure, and a little more, m².
    spread: f64,
    /// The displacement at the centre of pressure along x and y, m.
    v: [f64; 2],
    /// The turn about the vertical, rad.
    spin: f64,
}

impl SlidingPatch {
    /// Returns the slip of the patch, x and y (m) and turn (rad), if the robot is displaced by `shift` (m, m, rad).
    fn slip(&self, shift: &Vec3) -> [f64; 3] {
        [self.v[0] + shift.x - shift.z * self.y, self.v[1] + shift.y + shift.z * self.x, self.spin + shift.z]
    }

    /// Returns the mean square slip of the points of the patch, m².
    fn square(&self, slip: &[f64; 3]) -> f64 {
        slip[0] * slip[0] + slip[1] * slip[1] + self.spread * slip[2] * slip[2]
    }
}

/// Returns (pose, slips) of a change of posture on the ground, by the minimum power principle: the planar pose to
/// which it moves the robot; and, for each loaded patch of the stance before and then for each of this sample, (number
/// of its link, half of its slip in m, its load as a fraction of the weight). `old`: the stance before; `posture`,
/// `R`, `height`: the posture of this sample, the rotation of the base's frame to level axes, and the height of the
/// centre of mass above the ground (m); `patches`: those of this sample.
pub(super) fn displacement(
    model: &Model,
    old: &Stance,
    posture: &Posture,
    R: &Mat3,
    height: f64,
    patches: &[ContactPatch],
) -> (PlanarPose, Vec<(usize, f64, f64)>) {
    let patches: Vec<SlidingPatch> =
        old.patches.iter().chain(patches).map(|patch| drag(model, old, posture, R, height, patch)).collect();
    let shift = least_power(&patches);
    let slips = patches.iter().map(|d| {
        let slip = d.slip(&shift);
        (d.link, libm::hypot(slip[0], slip[1]) / 2.0, 2.0 * d.load)
    });
    (old.planar_pose.moved(&shift), slips.collect())
}

/// Returns a patch with the motion that the change of posture and attitude gives it.
fn drag(
    model: &Model,
    old: &Stance,
    new: &Posture,
    R: &Mat3,
    height: f64,
    patch: &ContactPatch,
) -> SlidingPatch {
    let link = patch.link;
    let p = |posture: &Posture, R: &Mat3, height: f64| {
        R * (posture.p[link] - posture.centre) + Vec3::new(0.0, 0.0, height)
    };
    let (R0, p0) = (old.R * old.posture.R[link], p(&old.posture, &old.R, old.height));
    let (R1, p1) = (R * new.R[link], p(new, R, height));
    let turn = R1 * R0.transpose();
    let (o, v) = twist(&turn, &(p1 - turn * p0));
    let at = Vec3::new(patch.x, patch.y, 0.0);
    let motion = o.cross(&at) + v;
    let load = patch.load / 2.0;
    SlidingPatch {
        link,
        load,
        friction_load: load * model.bodies[link].friction,
        x: patch.x,
        y: patch.y,
        spread: patch.spread + NUMERICS.patch_spread,
        v: [motion.x, motion.y],
        spin: o.z,
    }
}

/// Returns the twist, a rotation vector (rad) and a translation at the origin (m), whose exponential is a displacement:
/// its logarithm.
fn twist(R: &Mat3, t: &Vec3) -> (Vec3, Vec3) {
    let vee = Vec3::new(R[(2, 1)] - R[(1, 2)], R[(0, 2)] - R[(2, 0)], R[(1, 0)] - R[(0, 1)]) / 2.0;
    let (s, c) = (vee.norm(), (R.trace() - 1.0) / 2.0);
    let angle = libm::atan2(s, c);
    let o = if s > NUMERICS.no_rotation { vee * (angle / s) } else { vee };
    let squared = angle * angle;
    let factor = if squared > NUMERICS.series_angle_squared {
        (1.0 - angle * s / (2.0 * (1.0 - c))) / squared
    } else {
        1.0 / 12.0
    };
    (o, t - o.cross(t) * 0.5 + o.cross(&o.cross(t)) * factor)
}

/// Returns the displacement (m, m, rad) of least work of friction, by iteratively reweighted least squares.
fn least_power(patches: &[SlidingPatch]) -> Vec3 {
    let zero = Vec3::zeros();
    let greatest = patches.iter().map(|d| libm::sqrt(d.square(&d.slip(&zero)))).fold(0.0, f64::max);
    if greatest == 0.0 {
        return zero;
    }
    let smoothed = NUMERICS.smoothed_slip * greatest;
    let mut shift = zero;
    for round in 0..ROUNDS_MAX {
        let mut normal = Mat3::zeros();
        let mut right = zero;
        for d in patches {
            let softened = libm::sqrt(d.square(&d.slip(&shift)) + smoothed * smoothed);
            let weight = if round == 0 { d.friction_load } else { d.friction_load / softened };
            let rows = [
                (Vec3::new(1.0, 0.0, -d.y), d.v[0], 1.0),
                (Vec3::new(0.0, 1.0, d.x), d.v[1], 1.0),
                (Vec3::new(0.0, 0.0, 1.0), d.spin, d.spread),
            ];
            for (row, value, factor) in rows {
                normal += row * row.transpose() * (weight * factor);
                right -= row * (value * weight * factor);
            }
        }
        let Some(next) = normal.cholesky().map(|c| c.solve(&right)) else { return shift };
        let change = (next - shift).norm();
        shift = next;
        if change <= NUMERICS.power_change * greatest {
            break;
        }
    }
    shift
}
