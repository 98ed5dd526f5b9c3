//! Positions of all nodes on straight ways from one to another.

use crate::geometry::Vec3;

/// Returns the positions of the nodes, m, a part of the way from `x` to `y` (m): `x` at 0, `y` at 1.
pub(in crate::planners) fn towards(x: &[Vec3], y: &[Vec3], part: f64) -> Vec<Vec3> {
    x.iter().zip(y).map(|(p, q)| p + (q - p) * part).collect()
}

/// Returns the positions of the nodes, m, half-way from `x` to `y` (m); the same whichever comes first.
pub(in crate::planners) fn halfway(x: &[Vec3], y: &[Vec3]) -> Vec<Vec3> {
    x.iter().zip(y).map(|(p, q)| (p + q) / 2.0).collect()
}
