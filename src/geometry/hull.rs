//! Convex hulls of points.

use super::Vec3;
use parry3d_f64::transformation::try_convex_hull;

/// The surface of a convex hull: only the points that are its corners, and triangles
/// counter-clockwise from outside.
#[derive(Clone, Debug)]
pub struct Faces {
    pub points: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// `None` where the points do not span a volume.
pub fn faces(points: &[Vec3]) -> Option<Faces> {
    let points: Vec<_> = points.iter().map(|p| (*p).into()).collect();
    let (points, triangles) = try_convex_hull(&points).ok()?;
    Some(Faces { points: points.into_iter().map(Vec3::from).collect(), triangles })
}
