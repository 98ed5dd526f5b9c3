//! Ground that slopes: the frame of the ground, and the direction of gravity in it.
//!
//! The frame of the ground, G, has its origin at that of the world, W, and its z axis along the normal of the ground:
//! it is the world's frame turned by the least angle. In it a slope is level ground under a gravity that leans.

#![allow(non_snake_case)]

use super::world::{World, is_level};
use crate::geometry::{HeightField, Pose, Vec3};
use nalgebra::UnitQuaternion;

/// The greatest rise of a slope, m per m: √2, or 54.7°, which is as steep as a height field can be for 1 km.
pub const SLOPE_RISE_MAX: f64 = std::f64::consts::SQRT_2;

impl World {
    /// Returns true if the ground is not level.
    pub fn is_sloped(&self) -> bool {
        !is_level(&self.slope)
    }

    /// Returns the tangent of the angle by which the ground slopes; 0 where it is level.
    pub fn rise(&self) -> f64 {
        libm::hypot(self.slope[0], self.slope[1])
    }

    /// Returns the angle by which the ground slopes, rad; 0 where it is level.
    pub fn slope_angle(&self) -> f64 {
        libm::atan(self.rise())
    }

    /// Returns `X_WG`, the pose of the frame of the ground in the world; the identity where the ground is level.
    pub fn ground_pose(&self) -> Pose {
        if !self.is_sloped() {
            return Pose::identity();
        }
        let normal = Vec3::new(-self.slope[0], -self.slope[1], 1.0).normalize();
        let turn = UnitQuaternion::rotation_between(&Vec3::z(), &normal).unwrap_or_default();
        Pose::from_parts(Vec3::zeros().into(), turn)
    }

    /// Returns the unit vector along which gravity pulls, in the axes of the ground turned about its normal by `yaw`
    /// (rad): -z where the ground is level.
    pub fn down(&self, yaw: f64) -> Vec3 {
        if !self.is_sloped() {
            return Vec3::new(0.0, 0.0, -1.0);
        }
        let [a, b] = self.slope;
        let (s, c) = libm::sincos(yaw);
        Vec3::new(-c * a - s * b, s * a - c * b, -1.0).normalize()
    }

    /// Returns the shift along x and y, in the axes of the ground turned about its normal by `yaw` (rad), of the line of
    /// gravity for each metre that it comes nearer to the ground, m per m; zero where the ground is level.
    pub fn lean(&self, yaw: f64) -> [f64; 2] {
        let down = self.down(yaw);
        [down.x / -down.z, down.y / -down.z]
    }

    /// Returns the ground as a height field; `None` where it is level, or there is none.
    pub fn terrain(&self) -> Option<HeightField> {
        let rise = self.rise();
        let along = || [self.slope[0] / rise, self.slope[1] / rise];
        (self.is_sloped() && self.has_floor()).then(|| HeightField::plane(along(), rise))
    }
}
