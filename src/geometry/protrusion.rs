//! Protrusion: the distance by which drawn shapes stick out of the shapes that are judged in their place.
//!
//! The distance from a convex body is a convex function, so over a polytope, or over a triangle, it is greatest at a
//! corner. The least of these maxima over several bodies is an upper bound of the distance from their union; surfaces
//! are divided until that bound is near (branch and bound, Land and Doig 1960).

use super::distance::{distance_apart, signed_distance};
use super::hull;
use super::part::Part;
use super::pose::{Pose, Vec3};
use super::shape::Placed;
use super::solid::Solid;
use super::soundness::Unsound;
use std::collections::BinaryHeap;

/// The greatest number of divisions of triangles of one part. The bound then stands as it is, too large rather than
/// too small.
const DIVISIONS_MAX: usize = 2000;
/// Threshold: a bound is near enough if it is too large by at most this fraction of the drawn part's radius, without
/// unit: a ten-thousandth, which no drawing shows.
const TOL_NEAR: f64 = 1e-4;

/// Returns an upper bound, m, on the greatest distance of a point on the surfaces of `shapes` from the union of
/// `cover`, both in one frame. A bound of 0 means that all surfaces are covered; a bound above 0 does not mean the
/// opposite. The inside of a closed mesh of `cover` counts as covered. The bound is infinite if `cover` is empty and
/// `shapes` is not.
///
/// For a part that is a polytope the bound is too large by at most the fraction `TOL_NEAR` of the radius of its
/// bounding sphere, unless `DIVISIONS_MAX` divisions of its surface do not suffice. A cylinder is judged as the prism
/// around it, which adds up to 7.5e-5 of the cylinder's radius. For a ball or capsule that no single part of the cover
/// holds there is no such limit.
///
/// # Errors
/// The fault of a shape of `shapes` or `cover` that is not a solid; none is looked for if every shape is itself in
/// `cover`.
pub fn protrusion(shapes: &[Placed], cover: &[Placed]) -> Result<f64, Unsound> {
    let open: Vec<Placed> = shapes.iter().filter(|placed| !cover.contains(placed)).cloned().collect();
    if open.is_empty() {
        return Ok(0.0);
    }
    let (drawn, cover) = (Solid::new(&open)?, Solid::new(cover)?);
    Ok(drawn.parts.iter().map(|part| of_part(part, &cover)).fold(0.0, f64::max))
}

fn of_part(part: &Part, cover: &Solid) -> f64 {
    let corners = part.core_corners();
    let whole = bound(&corners, part.rounding(), cover);
    if whole == 0.0 || part.rounding() > 0.0 || cover.parts.len() == 1 {
        return whole;
    }
    let near = TOL_NEAR * part.radius;
    let mut open: BinaryHeap<Face> = faces(&corners).into_iter().map(|face| Face::new(face, cover)).collect();
    if open.is_empty() {
        // Without a hull there are no faces to divide.
        return whole;
    }
    let mut reached = open.iter().map(|face| face.reached).fold(0.0, f64::max);
    for _ in 0..DIVISIONS_MAX {
        let Some(face) = open.pop() else { break };
        if face.bound <= reached + near {
            open.push(face);
            break;
        }
        for half in face.halves() {
            let half = Face::new(half, cover);
            reached = reached.max(half.reached);
            open.push(half);
        }
    }
    open.peek().map_or(0.0, |face| face.bound).min(whole)
}

/// A triangle of a drawn surface.
struct Face {
    corners: [Vec3; 3],
    /// No point of it is farther from the cover, m.
    bound: f64,
    /// A corner of it is as far from the cover, m.
    reached: f64,
}

impl Face {
    fn new(corners: [Vec3; 3], cover: &Solid) -> Face {
        let nearest = |p: &Vec3| cover.parts.iter().map(|part| apart(p, part)).fold(f64::INFINITY, f64::min);
        let reached = corners.iter().map(nearest).fold(0.0, f64::max);
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
        // The hollow of a closed mesh is covered, too.
        if cover.encloses(&centre) && nearest(&centre) >= radius {
            return Face { corners, bound: 0.0, reached: 0.0 };
        }
        Face {
            corners,
            bound: bound(&corners, 0.0, cover),
            reached: if cover.encloses(&centre) { 0.0 } else { reached },
        }
    }

    /// Returns the two triangles on both sides of the middle of the longest edge.
    fn halves(&self) -> [[Vec3; 3]; 2] {
        let length = |k: usize| (self.corners[k] - self.corners[(k + 1) % 3]).norm();
        let longest = (0..3).fold(0, |best, k| if length(k) > length(best) { k } else { best });
        let [a, b, c] = [0, 1, 2].map(|k| self.corners[(longest + k) % 3]);
        let middle = (a + b) / 2.0;
        [[a, middle, c], [middle, b, c]]
    }
}

impl PartialEq for Face {
    fn eq(&self, other: &Face) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Face {}

impl PartialOrd for Face {
    fn partial_cmp(&self, other: &Face) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Face {
    fn cmp(&self, other: &Face) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Returns an upper bound of the distance from the cover of the hull of corners, rounded by a radius, m: the least over
/// the parts of the cover of the greatest distance of a corner.
fn bound(corners: &[Vec3], rounding: f64, cover: &Solid) -> f64 {
    let beyond = |p: &Vec3, part: &Part| {
        if rounding == 0.0 {
            return apart(p, part);
        }
        let found = signed_distance(&Part::sphere(*p, 0.0), part, &Pose::identity());
        (found.distance + rounding).max(0.0)
    };
    let farthest = |part: &Part| corners.iter().map(|p| beyond(p, part)).fold(0.0, f64::max);
    cover.parts.iter().map(farthest).fold(f64::INFINITY, f64::min)
}

/// Returns the distance of a point from a part, m; 0 inside.
fn apart(p: &Vec3, part: &Part) -> f64 {
    let found = distance_apart(&Part::sphere(*p, 0.0), part, &Pose::identity(), None, f64::MAX);
    found.map_or(0.0, |found| found.distance.max(0.0))
}

/// Returns the triangles of a convex body's surface, or the flat triangle itself.
fn faces(corners: &[Vec3]) -> Vec<[Vec3; 3]> {
    match (corners, hull::faces(corners)) {
        (_, Some(hull)) => hull.triangles.iter().map(|t| t.map(|i| hull.points[i as usize])).collect(),
        ([a, b, c], None) => vec![[*a, *b, *c]],
        _ => Vec::new(),
    }
}
