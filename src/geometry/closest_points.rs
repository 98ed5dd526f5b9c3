//! Closest points of points, segments, triangles and boxes, in closed form.
//!
//! Distances are never negative unless said otherwise: a point, segment or triangle has no inside. Signed distances of
//! convex parts and solids, by the method of Gilbert, Johnson and Keerthi, are in [`super::distance`]. All coordinates
//! of one call are in one frame, in metres. The algorithms are those of Ericson, *Real-Time Collision Detection*
//! (2005), chapter 5, unless another source is named.

use super::broad_phase::Aabb;
use super::distance::SignedDistance;
use super::distance::signed_distance_within;
use super::part::Part;
use super::pose::{Pose, Vec3};

/// A segment from its first point to its second, m, both in one frame of the caller's choice; the two may be one
/// point.
pub type Segment = (Vec3, Vec3);

/// Threshold: segments count as parallel in [`segment_segment`] if the squared sine of their angle, without unit, is
/// below this: at lesser angles, 3.2e-5 rad, rounding decides where the lines are nearest.
const TOL_PARALLEL_SINE_SQUARED: f64 = 1e-9;

/// The closest points of two segments, by their positions along them, with their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentPair {
    /// The distance of the two points, m; not negative.
    pub distance: f64,
    /// The unit vector from the second segment's point to the first's, in the frame of the segments. If the segments
    /// meet, it is perpendicular to both of them, with arbitrary sign, and +z where they are parallel or a point.
    pub normal: Vec3,
    /// The positions of the closest points along the first and the second segment, as fractions of the segments'
    /// lengths, 0 (first end) to 1.
    pub along: (f64, f64),
}

/// Returns the closest points of two segments of one frame (m), by the method of Ericson (*Real-Time Collision
/// Detection*, 2005, sec. 5.1.9). `p` and `q`: the segments, each by its two ends.
///
/// Of parallel segments, which have many closest pairs, one pair is returned; it may jump while the segments move a
/// little. Segments count as parallel if the squared sine of their angle is less than `TOL_PARALLEL_SINE_SQUARED`; the
/// distance is then too great by at most that angle times the length of the shorter segment. If that matters,
/// [`segment_segment_distance`] is exact at any angle.
pub fn segment_segment(p: Segment, q: Segment) -> SegmentPair {
    let (u, v, w) = (p.1 - p.0, q.1 - q.0, p.0 - q.0);
    let (a, b, c, d, e) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let determinant = a * c - b * b;
    // The closest points of the two lines, then clamped to the one segment and to the other by turns.
    let along_p = if determinant > TOL_PARALLEL_SINE_SQUARED * a * c {
        ((b * e - c * d) / determinant).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let project = |from: f64, over: f64| if over > 0.0 { (from / over).clamp(0.0, 1.0) } else { 0.0 };
    let along_q = project(b * along_p + e, c);
    let along_p = project(b * along_q - d, a);
    let along_q = project(b * along_p + e, c);
    pair_at(p, q, (along_p, along_q))
}

/// Returns the first or second end of the segment `p` (`end` is 0 or 1) with the point of `q` that is closest to it;
/// both segments in m and in one frame.
pub fn end_segment(p: Segment, end: usize, q: Segment) -> SegmentPair {
    let point = if end == 0 { p.0 } else { p.1 };
    let v = q.1 - q.0;
    let along = (point - q.0).dot(&v) / v.norm_squared().max(f64::MIN_POSITIVE);
    pair_at(p, q, (end as f64, along.clamp(0.0, 1.0)))
}

fn pair_at(p: Segment, q: Segment, along: (f64, f64)) -> SegmentPair {
    let apart = p.0 + (p.1 - p.0) * along.0 - q.0 - (q.1 - q.0) * along.1;
    let distance = apart.norm();
    let across = || (p.1 - p.0).cross(&(q.1 - q.0)).try_normalize(0.0).unwrap_or_else(Vec3::z);
    let normal = if distance > 0.0 { apart / distance } else { across() };
    SegmentPair { distance, normal, along }
}

/// Returns the distance of two segments of one frame, m, exact to rounding at any angle between them. `p` and `q`:
/// the segments, each by its two ends.
///
/// It is the least of the four distances from an end to the other segment, and of the distance of the lines if their
/// closest points, by Cramer's rule from the common perpendicular, lie inside both segments.
pub fn segment_segment_distance(p: Segment, q: Segment) -> f64 {
    let (u, v) = (p.1 - p.0, q.1 - q.0);
    let normal = u.cross(&v);
    let ends = [
        point_segment_distance(p.0, q),
        point_segment_distance(p.1, q),
        point_segment_distance(q.0, p),
        point_segment_distance(q.1, p),
    ];
    let least = ends.into_iter().fold(f64::INFINITY, f64::min);
    let area = normal.norm_squared();
    let apart = q.0 - p.0;
    let (s, t) = (apart.cross(&v).dot(&normal), apart.cross(&u).dot(&normal));
    let inside = |x: f64| 0.0 < x && x < area;
    if area > 0.0 && inside(s) && inside(t) {
        least.min(apart.dot(&normal).abs() / area.sqrt())
    } else {
        least
    }
}

/// Returns the position along a segment, as a fraction of its length from 0 to 1, of its point closest to `point` (m,
/// in the segment's frame), by the method of Ericson (*Real-Time Collision Detection*, 2005, sec. 5.1.2); 0 where the
/// segment is a point.
pub fn point_segment(point: Vec3, (a, b): Segment) -> f64 {
    let along = b - a;
    let length = along.norm_squared();
    if length > 0.0 { ((point - a).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the distance of a point (m) from the nearest point of a segment of the same frame, m; not negative, and 0
/// on the segment.
pub fn point_segment_distance(point: Vec3, segment: Segment) -> f64 {
    let (a, b) = segment;
    (point - a - (b - a) * point_segment(point, segment)).norm()
}

/// Returns the point of a triangle `[a, b, c]` that is closest to `point`, all in m and in one frame: its projection
/// on the plane if that is inside, else the closest point of the three edges (compare Ericson, *Real-Time Collision
/// Detection*, 2005, sec. 5.1.5). A triangle whose corners lie on one line is treated as its edges.
pub fn point_triangle(point: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let normal = (b - a).cross(&(c - a));
    let area = normal.norm_squared();
    let p = point - a;
    // Barycentric coordinates of the projection on the plane: of b and c, times the squared area.
    let (of_b, of_c) = (p.cross(&(c - a)).dot(&normal), (b - a).cross(&p).dot(&normal));
    if area > 0.0 && of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= area {
        return a + (b - a) * (of_b / area) + (c - a) * (of_c / area);
    }
    let on = |edge: Segment| edge.0 + (edge.1 - edge.0) * point_segment(point, edge);
    let candidates = [on((a, b)), on((b, c)), on((c, a))];
    let nearer = |x: Vec3, y: Vec3| if (y - point).norm() < (x - point).norm() { y } else { x };
    candidates.into_iter().reduce(nearer).unwrap_or(a)
}

/// Returns the signed distance of a point (m) from the surface of a box of the same frame, m: outside the distance
/// from the box, inside minus the distance from the nearest face. `around`: the box.
pub fn point_box(point: Vec3, around: &Aabb) -> f64 {
    let outside = (around.low - point).sup(&(point - around.high));
    if outside.max() < 0.0 { outside.max() } else { outside.sup(&Vec3::zeros()).norm() }
}

/// Returns the signed distance (m) of a segment from a convex part, both in one frame, and its direction from the
/// segment to the part; negative where the segment goes through the part. The method is that of
/// [`signed_distance_within`], to whose accuracy it holds. Once it is known
/// to be at least `enough` (m), a lower bound on it of at least `enough` is returned.
pub fn segment_part((a, b): Segment, part: &Part, enough: f64) -> SignedDistance {
    let segment = Part::capsule((a + b) / 2.0, (b - a) / 2.0, 0.0);
    signed_distance_within(&segment, part, &Pose::identity(), None, enough)
}
