//! Flat convex polygons: their sides, centroids and normals, and how one is told from another.
//!
//! Areas are summed over the fan of triangles from the first corner, so that a triangle is its own fan and nothing is
//! rounded there that would not be without it.

use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;

/// The reason why an outline is no flat convex polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineFault {
    /// The outline encloses no area, or a coordinate is not finite.
    Degenerate,
    /// A corner is off the plane of the others by this distance, m.
    NotPlanar {
        /// The number of the corner in the outline, from 0.
        corner: usize,
        /// The distance of the corner from the mean plane of all corners, m.
        off: f64,
    },
    /// The outline does not turn left at a corner, seen from the front, or it goes round more than once.
    NotConvex {
        /// The number of the corner in the outline, from 0.
        corner: usize,
    },
}

/// Returns the triangles of the fan from the first corner of an outline of at least three corners.
pub fn fan(corners: &[Vec3]) -> impl Iterator<Item = [Vec3; 3]> + '_ {
    corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]])
}

/// Returns the normal of an outline, counterclockwise from its front, with twice its area as its length, m².
fn area_normal(corners: &[Vec3]) -> Vec3 {
    let mut triangles = fan(corners).map(|[a, b, c]| (b - a).cross(&(c - a)));
    let first = triangles.next().expect("an outline has three corners");
    triangles.fold(first, |sum, normal| sum + normal)
}

/// Returns the unit normal of a flat outline of at least three corners, counterclockwise from its front.
pub fn normal(corners: &[Vec3]) -> Vec3 {
    area_normal(corners).normalize()
}

/// Returns each triangle of the fan of a flat convex outline with its part of the area; the parts sum to 1.
pub fn weighted_fan(corners: &[Vec3]) -> impl Iterator<Item = ([Vec3; 3], f64)> + '_ {
    let whole = area_normal(corners).norm();
    fan(corners).map(move |[a, b, c]| ([a, b, c], (b - a).cross(&(c - a)).norm() / whole))
}

/// Returns the centroid of a flat convex outline of at least three corners, m.
pub fn centroid(corners: &[Vec3]) -> Vec3 {
    if let [a, b, c] = corners {
        return (a + b + c) / 3.0;
    }
    weighted_fan(corners).map(|([a, b, c], part)| (a + b + c) * part).sum::<Vec3>() / 3.0
}

/// Returns the lengths of the sides of an outline, m; entry k is that of side k, from corner k to the next.
pub fn sides(corners: &[Vec3]) -> Vec<f64> {
    across(corners, 1)
}

/// Returns the lengths that tell a flat convex polygon from others, m: its sides, and where it has more than three, its
/// diagonals from each corner to the next but one.
pub fn measures(corners: &[Vec3]) -> Vec<f64> {
    let mut lengths = sides(corners);
    if corners.len() > 3 {
        lengths.extend(diagonals(corners));
    }
    lengths
}

/// Returns the lengths of the diagonals across side k and the next, from corner k, m.
pub fn diagonals(corners: &[Vec3]) -> Vec<f64> {
    across(corners, 2)
}

/// Returns the distances of each corner from that which follows it by `steps`.
fn across(corners: &[Vec3], steps: usize) -> Vec<f64> {
    let n = corners.len();
    (0..n).map(|k| (corners[(k + steps) % n] - corners[k]).norm()).collect()
}

/// Returns the area of a flat outline of at least three corners, m².
pub fn area(corners: &[Vec3]) -> f64 {
    area_normal(corners).norm() / 2.0
}

/// Returns the corners of a flat convex outline whose sides are moved inwards by a distance (m); `None` where a side
/// would vanish.
pub fn inset(corners: &[Vec3], distance: f64) -> Option<Vec<Vec3>> {
    let n = corners.len();
    let normal = normal(corners);
    let along = |k: usize| (corners[(k + 1) % n] - corners[k % n]).normalize();
    let moved = |k: usize| {
        let [before, after] = [k + n - 1, k].map(|side| normal.cross(&along(side)));
        corners[k] + (before + after) * (distance / (1.0 + before.dot(&after)))
    };
    let inner: Vec<Vec3> = (0..n).map(moved).collect();
    let is_left = |k: usize| (inner[(k + 1) % n] - inner[k]).dot(&along(k)) > 0.0;
    (0..n).all(is_left).then_some(inner)
}

/// Returns true if two polygons, given by their [`measures`], are congruent as their corners are numbered: each length
/// differs from that of the same index by at most `tol` times the longest of the first.
pub fn equal(a: &[f64], b: &[f64], tol: f64) -> bool {
    let longest = a.iter().copied().fold(0.0, f64::max);
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| (x - y).abs() <= tol * longest)
}

/// Checks that an outline of at least three corners (m) is a flat convex polygon that is counterclockwise from its
/// front.
///
/// # Errors
/// The first [`OutlineFault`].
pub fn check(corners: &[Vec3]) -> Result<(), OutlineFault> {
    let n = corners.len();
    let longest = sides(corners).into_iter().fold(0.0, f64::max);
    let area = area_normal(corners);
    // Written so that a number that is none fails, too.
    if !(area.norm() > TOLERANCES.flat_face * longest * longest && longest.is_finite()) {
        return Err(OutlineFault::Degenerate);
    }
    if n == 3 {
        return Ok(());
    }
    // All corners near the plane through their mean.
    let normal = area.normalize();
    let middle = corners.iter().sum::<Vec3>() / n as f64;
    let off = |corner: &Vec3| normal.dot(&(corner - middle)).abs();
    let farthest = (0..n).max_by(|a, b| off(&corners[*a]).total_cmp(&off(&corners[*b])));
    let corner = farthest.expect("an outline has three corners");
    if off(&corners[corner]) > TOLERANCES.planar * longest {
        return Err(OutlineFault::NotPlanar { corner, off: off(&corners[corner]) });
    }
    // A turn to the left at every corner, and one round in all.
    let mut turned = 0.0;
    for corner in 0..n {
        let before = corners[corner] - corners[(corner + n - 1) % n];
        let after = corners[(corner + 1) % n] - corners[corner];
        let turn = libm::atan2(normal.dot(&before.cross(&after)), before.dot(&after));
        turned += turn;
        if turn.is_nan()
            || turn < TOLERANCES.corner
            || turned > 2.0 * std::f64::consts::PI + TOLERANCES.corner
        {
            return Err(OutlineFault::NotConvex { corner });
        }
    }
    Ok(())
}
