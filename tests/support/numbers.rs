//! A generator of reproducible pseudo-random numbers for randomised tests.

use modl::geometry::pose::turned;
use modl::geometry::{Pose, Vec3};

/// A linear congruential generator of 64 bits (Knuth's MMIX constants). The same state yields the same numbers on every
/// machine.
pub struct Numbers(pub u64);

impl Numbers {
    /// Returns a number in [0, 1): the upper 53 bits of the next state.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64) / ((1u64 << 53) as f64)
    }

    /// Returns a number in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }

    /// Returns a number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Returns a vector whose coordinates are in [-1, 1).
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// Returns a unit vector. A vector too short to be normalised well gives x.
    pub fn direction(&mut self) -> Vec3 {
        self.vector().try_normalize(0.1).unwrap_or(Vec3::x())
    }

    /// Returns a rotation of less than 3 rad about some axis, without translation.
    pub fn rotation(&mut self) -> Pose {
        turned(self.direction(), self.between(-3.0, 3.0))
    }
}
