//! Convex hulls of points.

use super::pose::Vec3;
use nalgebra::Matrix3;
use parry3d_f64::transformation::try_convex_hull;
use std::collections::BTreeMap;

/// The surface of a convex hull as a triangle mesh whose vertices are the corners of the hull alone.
#[derive(Clone, Debug)]
pub struct Faces {
    /// The corners of the hull, m, in the frame of the points that it was made of.
    pub points: Vec<Vec3>,
    /// Three indices in `points`, from 0, for each triangle, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Returns the surface of the convex hull of points (m), in their frame, by parry's convex hull of the points after
/// an affine map that makes them as thick as wide; `None` if they span no volume, or rounding keeps parry from a
/// hull.
pub fn faces(points: &[Vec3]) -> Option<Faces> {
    // An affine map leaves the corners the same: coordinates are whitened, so that a thin hull is as thick as wide
    // and not taken for flat.
    let [along, across, up] = extents(points, 0.0)?;
    let whitening = Matrix3::from_columns(&[along, across, up]).try_inverse()?;
    let whitened: Vec<_> = points.iter().map(|p| (whitening * (p - points[0])).into()).collect();
    let (corners, triangles) = try_convex_hull(&whitened).ok()?;
    let bits = |p: [f64; 3]| p.map(f64::to_bits);
    let own: BTreeMap<[u64; 3], Vec3> =
        whitened.iter().map(|p| bits((*p).into())).zip(points.iter().copied()).collect();
    let corners = corners.into_iter().map(|corner| own.get(&bits(corner.into())).copied());
    Some(Faces { points: corners.collect::<Option<_>>()?, triangles })
}

/// Returns the extents of a set of points (m) as three perpendicular, right-handed vectors, each with the length (m)
/// by which the points reach from the first of them: in the direction in which they reach farthest; across that; and
/// across both, the flattest direction among the planes through three far apart points. `None` if one is shorter than
/// `least` (m), or has no length, and for no points.
pub fn extents(points: &[Vec3], least: f64) -> Option<[Vec3; 3]> {
    let first = points.first()?;
    let farthest = |measure: &dyn Fn(&Vec3) -> f64| {
        let (reach, p) =
            points.iter().map(|p| (measure(p), *p)).fold((0.0, *first), |m, x| if x.0 > m.0 { x } else { m });
        (reach > 0.0 && reach >= least).then_some((reach, p))
    };
    let (length, a) = farthest(&|p| (p - first).norm())?;
    let along = (a - first) / length;
    let (width, b) = farthest(&|p| (p - first).cross(&along).norm())?;
    let normal = along.cross(&(b - first)).normalize();
    let (height, _) = farthest(&|p| (p - first).dot(&normal).abs())?;
    Some([along * length, normal.cross(&along) * width, normal * height])
}
