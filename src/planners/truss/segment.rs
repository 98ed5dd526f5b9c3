//! Where two segments are nearest to each other.

use crate::geometry::Vec3;

/// Segments at a smaller sine of their angle than this count as parallel: their nearest points are
/// looked for at the ends.
const PARALLEL: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
pub struct Witness {
    pub distance: f64,
    /// From the second segment's point to the first's; a unit vector.
    pub normal: Vec3,
    /// How far along the segments the points are, 0 to 1.
    pub along: (f64, f64),
}

pub fn nearest(p: (Vec3, Vec3), q: (Vec3, Vec3)) -> Witness {
    let (u, v, w) = (p.1 - p.0, q.1 - q.0, p.0 - q.0);
    let (a, b, c, d, e) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let determinant = a * c - b * b;
    let along_p =
        if determinant > PARALLEL * a * c { ((b * e - c * d) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let project = |from: f64, over: f64| if over > 0.0 { (from / over).clamp(0.0, 1.0) } else { 0.0 };
    let along_q = project(b * along_p + e, c);
    let along_p = project(b * along_q - d, a);
    let along_q = project(b * along_p + e, c);
    between(p, q, (along_p, along_q))
}

/// The nearest point of a segment to one end of another: `end` is 0 or 1.
pub fn nearest_to_end(p: (Vec3, Vec3), end: usize, q: (Vec3, Vec3)) -> Witness {
    let point = if end == 0 { p.0 } else { p.1 };
    let v = q.1 - q.0;
    let along = (point - q.0).dot(&v) / v.norm_squared().max(f64::MIN_POSITIVE);
    between(p, q, (end as f64, along.clamp(0.0, 1.0)))
}

fn between(p: (Vec3, Vec3), q: (Vec3, Vec3), along: (f64, f64)) -> Witness {
    let apart = p.0 + (p.1 - p.0) * along.0 - q.0 - (q.1 - q.0) * along.1;
    let distance = apart.norm();
    let across = || (p.1 - p.0).cross(&(q.1 - q.0)).try_normalize(0.0).unwrap_or_else(Vec3::z);
    let normal = if distance > 0.0 { apart / distance } else { across() };
    Witness { distance, normal, along }
}
