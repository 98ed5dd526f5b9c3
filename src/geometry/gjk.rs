//! The nearest points of convex parts that are apart: the method of Gilbert, Johnson and Keerthi (GJK, 1988).
//!
//! Not parry's, because that stops some micrometres short on round parts, and the judge between samples needs to
//! know from which side a distance is off. The method works on the Minkowski difference of the two bodies, of which
//! the point nearest to the origin is as far from it as the bodies are from each other. The distance is bracketed:
//! every point of the difference is at least as far as the nearest, and the separation along any direction is at
//! most as large.

use super::distance::SignedDistance;
use super::part::Part;
use super::pose::{Pose, Vec3};

/// Threshold: the bracket is close enough below this width, a fraction of the distance, plus one in metres: near what
/// rounding leaves.
const TOL_BRACKET: (f64, f64) = (1e-9, 1e-9);

/// Threshold: a point this near to the origin is at it, m: rounding.
const TOL_ORIGIN: f64 = 1e-12;

/// The greatest number of iterations: polytopes take about ten, round parts about thirty.
const ROUNDS_MAX: usize = 100;

/// The accuracy that a distance is needed with: exact below one distance, within a tolerance from there on, and from
/// another distance on any bound.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    /// The distance below which the distance must be exact, m.
    pub exact_below: f64,
    /// The greatest error of a distance that is not exact, m: a lower bound, too small by no more, is then returned.
    pub within: f64,
    /// The distance from which on any lower bound of at least that suffices, m.
    pub enough: f64,
}

impl Needed {
    /// Returns the need of exact distances below `enough` (m), and of any bound of at least `enough` beyond.
    pub fn exact_up_to(enough: f64) -> Needed {
        Needed { exact_below: enough, within: 0.0, enough }
    }

    /// Returns the same need of distances that are greater by `more` (m).
    fn beyond(&self, more: f64) -> Needed {
        Needed { exact_below: self.exact_below + more, enough: self.enough + more, ..*self }
    }
}

/// Returns the distance between the cores ([`Part::rounding`]) of two parts (m) and its direction in a's frame, by
/// the method of Gilbert, Johnson and Keerthi (1988); `None` where the cores overlap or touch. `X_AB` is the pose of
/// b's frame in a's. Stops where the distance is known as well as it is `needed`; what is not exact is a lower bound.
/// `towards`: a first guess of the direction from a to b, in a's frame.
pub(super) fn closest_cores(
    a: &Part,
    b: &Part,
    X_AB: &Pose,
    towards: &Vec3,
    needed: &Needed,
) -> Option<SignedDistance> {
    let needed = needed.beyond(a.rounding() + b.rounding());
    let R_AB = *X_AB.rotation.to_rotation_matrix().matrix();
    // The point of the difference (b minus a) that is lowest along v.
    let lowest =
        |v: &Vec3| R_AB * b.core_support(&-R_AB.tr_mul(v)) + X_AB.translation.vector - a.core_support(v);
    let mut simplex = Simplex { corners: [lowest(towards); 4], count: 1 };
    let mut nearest = simplex.corners[0];
    let mut gap = SignedDistance { distance: f64::NEG_INFINITY, normal: Vec3::x() };
    for _ in 0..ROUNDS_MAX {
        let distance = nearest.norm();
        if distance < TOL_ORIGIN {
            break;
        }
        let normal = nearest / distance;
        let point = lowest(&normal);
        let along = normal.dot(&point);
        if along > gap.distance {
            gap = SignedDistance { distance: along, normal };
        }
        let width = distance - gap.distance;
        let close = width <= TOL_BRACKET.0 * distance + TOL_BRACKET.1;
        let within = gap.distance >= needed.exact_below && width <= needed.within;
        // A lower bound suffices, unless the bracket is so narrow that the distance is exact besides.
        if gap.distance >= needed.enough || (within && !close) {
            return (gap.distance > TOL_ORIGIN).then_some(gap);
        }
        if close || simplex.has(&point) {
            break;
        }
        simplex.corners[simplex.count] = point;
        simplex.count += 1;
        match reduce(&mut simplex, gap.distance > TOL_ORIGIN) {
            Some(next) if next.norm() < distance => nearest = next,
            Some(_) => break,
            None => return None,
        }
    }
    (gap.distance > TOL_ORIGIN).then_some(SignedDistance { distance: nearest.norm(), normal: gap.normal })
}

/// A simplex of up to four points of the Minkowski difference.
struct Simplex {
    corners: [Vec3; 4],
    count: usize,
}

impl Simplex {
    fn has(&self, point: &Vec3) -> bool {
        let same = |corner: &Vec3| corner.x == point.x && corner.y == point.y && corner.z == point.z;
        self.corners[..self.count].iter().any(same)
    }

    fn keep(&mut self, carriers: &[usize]) {
        let corners = self.corners;
        carriers.iter().enumerate().for_each(|(to, from)| self.corners[to] = corners[*from]);
        self.count = carriers.len();
    }
}

/// Returns the point of a simplex nearest to the origin among its last corner and the edges and faces that have that
/// corner, and leaves in the simplex only the corners that carry it (the distance subalgorithm, by trying all of them).
/// The others were tried before the last corner was added: no point of theirs is nearer than the one found then. `None`
/// where the origin is inside, which can't be where the bodies are known to be `apart`.
fn reduce(simplex: &mut Simplex, apart: bool) -> Option<Vec3> {
    let corners = simplex.corners;
    let count = simplex.count;
    if count == 4 && !apart && holds_origin(&corners) {
        return None;
    }
    let mut best = (f64::INFINITY, Vec3::zeros(), [0; 3], 0);
    let mut offer = |point: Vec3, carriers: [usize; 3], carrying: usize| {
        if point.norm_squared() < best.0 {
            best = (point.norm_squared(), point, carriers, carrying);
        }
    };
    let last = count - 1;
    offer(corners[last], [last, 0, 0], 1);
    for j in 0..last {
        if let Some(point) = on_edge(&corners[last], &corners[j]) {
            offer(point, [last, j, 0], 2);
        }
        for k in 0..j {
            if let Some(point) = on_face(&corners[last], &corners[j], &corners[k]) {
                offer(point, [last, j, k], 3);
            }
        }
    }
    simplex.keep(&best.2[..best.3]);
    Some(best.1)
}

/// Returns the origin's projection on an edge; `None` unless it is between the ends.
fn on_edge(a: &Vec3, b: &Vec3) -> Option<Vec3> {
    let ab = b - a;
    let t = -a.dot(&ab) / ab.norm_squared();
    (t > 0.0 && t < 1.0).then(|| a + ab * t)
}

/// Returns the origin's projection on a triangle's plane; `None` unless it is inside the triangle.
fn on_face(a: &Vec3, b: &Vec3, c: &Vec3) -> Option<Vec3> {
    let normal = (b - a).cross(&(c - a));
    let area = normal.norm_squared();
    let weights = [b.cross(c).dot(&normal), c.cross(a).dot(&normal), a.cross(b).dot(&normal)];
    let inside = area > 0.0 && weights.iter().all(|w| *w > 0.0);
    // The point is found by the weights and not along the normal: a combination of corners is never outside the
    // body.
    inside.then(|| (a * weights[0] + b * weights[1] + c * weights[2]) / weights.iter().sum::<f64>())
}

/// Returns true if the origin is on the inner side of every face of a tetrahedron.
fn holds_origin(corners: &[Vec3]) -> bool {
    let outside = |face: [usize; 3], inner: usize| {
        let [a, b, c] = face.map(|i| corners[i]);
        let normal = (b - a).cross(&(c - a));
        normal.dot(&(corners[inner] - a)) * -normal.dot(&a) < 0.0
    };
    let faces = [([0, 1, 2], 3), ([0, 1, 3], 2), ([0, 2, 3], 1), ([1, 2, 3], 0)];
    !faces.iter().any(|(face, inner)| outside(*face, *inner))
}
