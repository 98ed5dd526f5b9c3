//! Convex outlines of solids as seen from above, grown by a distance.

use super::tolerances::TOLERANCES;
use crate::geometry::{Placed, Pose, Shape, Vec3, monotone_chain, sin_cos};
use std::f64::consts::{FRAC_PI_8, TAU};

/// A point of a plane seen from above, x and y, m.
pub type Point = [f64; 2];

/// The number of corners of the polygon around a rim or a ball that is not grown: its corners are 0.03 % farther out.
const RIM_CORNERS: usize = 128;

/// The greatest angle between two edges of a rounded corner, rad: its corners are 2 % of the radius farther out.
const ROUNDING: f64 = FRAC_PI_8;

/// A convex polygon, its corners counter-clockwise, m.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The corners, counter-clockwise as seen from above, m; at least three.
    pub corners: Vec<Point>,
}

impl Outline {
    /// Returns the outlines of a solid as seen from above, grown by `clearance` (m): one for each of its convex parts,
    /// which contains all points of the plane closer to the part's outline than that, and is bounded by tangents of
    /// their boundary. A mesh counts as its convex hull. `shapes`: the parts in the world's frame.
    pub fn of_solid(shapes: &[Placed], clearance: f64) -> Vec<Outline> {
        let mut found = Vec::new();
        shapes.iter().for_each(|part| collect(part, &Pose::identity(), clearance, &mut found));
        found
    }

    /// Returns the convex outline of points (m) grown by `radius` (m), with tangents at corners; `None` if they are on
    /// one line and the radius is zero.
    pub fn around(points: &[Point], radius: f64) -> Option<Outline> {
        let hull = convex_hull(points);
        if radius <= 0.0 {
            return (hull.len() > 2).then_some(Outline { corners: hull });
        }
        let mut corners = Vec::new();
        for (i, corner) in hull.iter().enumerate() {
            let before = hull[(i + hull.len() - 1) % hull.len()];
            let after = hull[(i + 1) % hull.len()];
            let first = if hull.len() == 1 { 0.0 } else { edge_normal(before, *corner) };
            let mut turn = if hull.len() == 1 { TAU } else { edge_normal(*corner, after) - first };
            if turn < 0.0 {
                turn += TAU;
            }
            // Tangents at the ends and at even steps between: each corner is where two of them meet.
            let steps = (turn / ROUNDING).ceil().max(1.0);
            let reach = radius / sin_cos(turn / steps / 2.0).1;
            for step in 0..steps as usize {
                let (sin, cos) = sin_cos(first + turn * (step as f64 + 0.5) / steps);
                corners.push([corner[0] + reach * cos, corner[1] + reach * sin]);
            }
        }
        Some(Outline { corners })
    }

    /// Returns true if a point (m) is inside, deeper than rounding.
    pub fn contains(&self, point: Point) -> bool {
        self.edges().all(|(a, b)| outside(a, b, point) < -TOLERANCES.depth)
    }

    /// Returns true if the segment between two points (m) passes through the inside, deeper than rounding. Along an
    /// edge it does not.
    pub fn blocks(&self, from: Point, to: Point) -> bool {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for (a, b) in self.edges() {
            let begin = outside(a, b, from) + TOLERANCES.depth;
            let end = outside(a, b, to) + TOLERANCES.depth;
            if begin >= 0.0 && end >= 0.0 {
                return false;
            }
            if begin > 0.0 {
                enters = enters.max(begin / (begin - end));
            } else if end > 0.0 {
                leaves = leaves.min(begin / (begin - end));
            }
        }
        enters < leaves
    }

    fn edges(&self) -> impl Iterator<Item = (Point, Point)> {
        let after = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(after.copied())
    }
}

/// Returns how far a point is on the outer side of an edge of a counter-clockwise polygon, m; negative inside.
fn outside(a: Point, b: Point, point: Point) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let length = (x * x + y * y).sqrt();
    (y * (point[0] - a[0]) - x * (point[1] - a[1])) / length
}

/// Returns the direction of the outer normal of an edge of a counter-clockwise polygon, rad from x.
fn edge_normal(a: Point, b: Point) -> f64 {
    libm::atan2(a[0] - b[0], b[1] - a[1])
}

/// Adds the outlines of a shape's convex parts, grown by `clearance`. `X_W`: the pose of the shape's frame's parent.
#[allow(non_snake_case)]
fn collect(part: &Placed, X_W: &Pose, clearance: f64, found: &mut Vec<Outline>) {
    let X_WS = X_W * part.pose;
    let seen = |p: Vec3| {
        let p = X_WS * nalgebra::Point3::from(p);
        [p.x, p.y]
    };
    let outline = match &part.shape {
        Shape::Union { parts } => return parts.iter().for_each(|p| collect(p, &X_WS, clearance, found)),
        Shape::Box { size } => {
            let half = size / 2.0;
            let signs = [-1.0, 1.0];
            let corners = signs.iter().flat_map(|x| signs.iter().map(move |y| (*x, *y)));
            let corners = corners.flat_map(|(x, y)| signs.map(|z| Vec3::new(x, y, z).component_mul(&half)));
            Outline::around(&corners.map(seen).collect::<Vec<_>>(), clearance)
        }
        Shape::Hull { points } | Shape::Mesh { vertices: points, .. } => {
            Outline::around(&points.iter().copied().map(seen).collect::<Vec<_>>(), clearance)
        }
        Shape::Sphere { radius } => round(&[seen(Vec3::zeros())], *radius, clearance),
        Shape::Capsule { radius, length, axis } => {
            let half = axis * (length / 2.0);
            round(&[seen(-half), seen(half)], *radius, clearance)
        }
        Shape::Cylinder { radius, length, axis } => {
            let upright = (X_WS.rotation * axis).xy().norm() <= TOLERANCES.depth;
            if upright {
                round(&[seen(Vec3::zeros())], *radius, clearance)
            } else {
                let rim =
                    rim(*axis, *radius).flat_map(|p| [p - axis * (length / 2.0), p + axis * (length / 2.0)]);
                Outline::around(&rim.map(seen).collect::<Vec<_>>(), clearance)
            }
        }
    };
    found.extend(outline);
}

/// Returns the outline of points that are rounded by `radius` and grown by `clearance`, m.
fn round(points: &[Point], radius: f64, clearance: f64) -> Option<Outline> {
    Outline::around(points, radius + clearance)
}

/// Returns the corners of a regular polygon around a circle about the origin across `axis`, a unit vector; m.
fn rim(axis: Vec3, radius: f64) -> impl Iterator<Item = Vec3> {
    let aside = if axis.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
    let across = axis.cross(&aside).normalize();
    let third = axis.cross(&across);
    let step = TAU / RIM_CORNERS as f64;
    let reach = radius / sin_cos(step / 2.0).1;
    (0..RIM_CORNERS).map(move |i| {
        let (sin, cos) = sin_cos(step * i as f64);
        (across * cos + third * sin) * reach
    })
}

/// Returns the corners of the convex hull of points counter-clockwise, without those on its edges (Andrew 1979): one or
/// two where all are at one place or on one line.
fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup_by(|a, b| distance(*a, *b) <= TOLERANCES.depth);
    if sorted.len() < 3 {
        return sorted;
    }
    monotone_chain(&sorted, left_turn)
}

/// Returns true if the way from `a` over `b` to `c` turns left, by more than rounding.
fn left_turn(a: Point, b: Point, c: Point) -> bool {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    u[0] * v[1] - u[1] * v[0] > TOLERANCES.straight * distance(a, b) * distance(b, c)
}

/// Returns the distance between two points, m.
pub(super) fn distance(a: Point, b: Point) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    (x * x + y * y).sqrt()
}
