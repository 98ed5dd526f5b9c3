//! Features of a robot that can touch the ground: vertices, circles and spheres, each with one lowest point.
//!
//! Wheels are exact circles: with a polygon a chassis would rest on its sides; and a wheel's own spin changes no
//! feature at all, which makes rolling cheap and exact.

use super::broad_phase::Aabb;
use super::hull;
use super::pose::{Mat3, Pose, Vec3, length};
use super::shape::{Placed, Shape};

/// Threshold: the sine of the angle to the level within which the plane of a circle counts as level, so that no point of
/// it is lowest: rounding.
const TOL_LEVEL: f64 = 1e-9;

/// The number of points that represent a circle: its lowest, and seven more at eighths of a turn, so that a disc that
/// lies flat touches the ground at more than one point.
pub const CIRCLE_POINTS: u8 = 8;

/// A part of a link's surface that can touch the ground: a vertex, circle or sphere, in the frame of the link or in
/// another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// The vertex, or the centre of the circle or sphere, in the frame of the feature, m.
    pub centre: Vec3,
    /// The form of the feature about its centre.
    pub form: Form,
}

/// The form of a ground feature; vectors are in the frame of its [`Feature`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A point, such as a vertex of a hull.
    Vertex,
    /// A circle, such as the rim of a cylinder: the unit normal of its plane, and the radius, m.
    Circle(Vec3, f64),
    /// A sphere: its radius, m.
    Sphere(f64),
}

impl Feature {
    /// Returns the feature in the frame in which its own frame has the orientation `R` and the origin `p` (m).
    pub fn placed(&self, R: &Mat3, p: &Vec3) -> Feature {
        let form = match self.form {
            Form::Circle(axis, radius) => Form::Circle(R * axis, radius),
            form => form,
        };
        Feature { centre: R * self.centre + p, form }
    }

    /// Returns the number of points that represent the feature: [`CIRCLE_POINTS`] for a circle, else 1.
    pub fn points(&self) -> u8 {
        if matches!(self.form, Form::Circle(..)) { CIRCLE_POINTS } else { 1 }
    }

    /// Returns the height of the feature's lowest point along the unit vector `up` (in the feature's frame), m, from
    /// the origin of that frame.
    pub fn lowest(&self, up: &Vec3) -> f64 {
        let centre = up.dot(&self.centre);
        match self.form {
            Form::Vertex => centre,
            Form::Sphere(radius) => centre - radius,
            Form::Circle(axis, radius) => {
                let along = up.dot(&axis);
                centre - radius * libm::sqrt((1.0 - along * along).max(0.0))
            }
        }
    }

    /// Returns point `k` of those that represent the feature, in its frame, m; 0 is the lowest along the unit vector
    /// `up` (in that frame), the others of a circle, 1 to 7, follow at eighths of a turn.
    pub fn point(&self, k: u8, up: &Vec3) -> Vec3 {
        match self.form {
            Form::Vertex => self.centre,
            Form::Sphere(radius) => self.centre - up * radius,
            Form::Circle(axis, radius) => {
                let e = downhill(&axis, up);
                let (s, c) = EIGHTHS[usize::from(k % CIRCLE_POINTS)];
                self.centre + (e * c + axis.cross(&e) * s) * radius
            }
        }
    }

    /// Adds to `out` the number and the position ([`point`](Self::point), m) of each of the feature's points whose height
    /// along the unit vector `up` (in the feature's frame) is less than `limit`, m from the origin of that frame. Returns
    /// true if that of the lowest is. `plane`: that of the circle met last in this frame, for the same `up`; it becomes that
    /// of this one.
    #[inline(always)]
    pub fn points_below(
        &self,
        up: &Vec3,
        limit: f64,
        plane: &mut Option<CirclePlane>,
        out: &mut Vec<(u8, Vec3)>,
    ) -> bool {
        let height = up.dot(&self.centre);
        match self.form {
            Form::Vertex if height < limit => out.push((0, self.centre)),
            Form::Sphere(radius) if height - radius < limit => out.push((0, self.centre - up * radius)),
            Form::Circle(axis, radius) => {
                let plane = CirclePlane::known(plane, &axis, up);
                if height - radius * plane.fall >= limit {
                    return false;
                }
                out.push((0, self.centre + plane.down * radius));
                // Nearly always the others, the second lowest of which are an eighth of a turn away, are not below.
                if height - radius * HALF_ROOT * plane.fall >= limit {
                    return true;
                }
                for (k, (s, c)) in (0..CIRCLE_POINTS).zip(EIGHTHS).skip(1) {
                    if height - radius * c * plane.fall < limit {
                        out.push((k, self.centre + (plane.down * c + plane.across * s) * radius));
                    }
                }
            }
            Form::Vertex | Form::Sphere(_) => return false,
        }
        true
    }

    /// Returns the box along the axes of the feature's frame that just holds it, m.
    pub fn bounds(&self) -> Aabb {
        let half = match self.form {
            Form::Vertex => Vec3::zeros(),
            Form::Sphere(radius) => Vec3::repeat(radius),
            Form::Circle(axis, radius) => {
                axis.map(|along| radius * libm::sqrt((1.0 - along * along).max(0.0)))
            }
        };
        Aabb { low: self.centre - half, high: self.centre + half }
    }

    /// Returns an upper bound on the distance of any point of the feature from the origin of its frame, m.
    pub fn reach(&self) -> f64 {
        self.centre.norm() + self.radius()
    }

    /// Returns an upper bound on the distance of any point of the feature from the corresponding point of `other`, m;
    /// the two must be one feature in two poses, in one frame.
    pub fn moved(&self, other: &Feature) -> f64 {
        let centre = (self.centre - other.centre).norm();
        match (self.form, other.form) {
            (Form::Circle(a, radius), Form::Circle(b, _)) => centre + radius * (a - b).norm(),
            _ => centre,
        }
    }

    fn radius(&self) -> f64 {
        match self.form {
            Form::Vertex => 0.0,
            Form::Circle(_, radius) | Form::Sphere(radius) => radius,
        }
    }
}

const HALF_ROOT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Sine and cosine of the eighths of a turn.
const EIGHTHS: [(f64, f64); 8] = [
    (0.0, 1.0),
    (HALF_ROOT, HALF_ROOT),
    (1.0, 0.0),
    (HALF_ROOT, -HALF_ROOT),
    (0.0, -1.0),
    (-HALF_ROOT, -HALF_ROOT),
    (-1.0, 0.0),
    (-HALF_ROOT, HALF_ROOT),
];

/// Returns the unit vector in the plane of a circle that goes down steepest; for a level circle one that
/// depends on its axis alone.
#[inline]
fn downhill(axis: &Vec3, up: &Vec3) -> Vec3 {
    let e = axis * up.dot(axis) - up;
    let n = length(&e);
    if n > TOL_LEVEL {
        return e / n;
    }
    let across = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    (across - axis * across.dot(axis)).normalize()
}

/// The directions in the planes of all circles with one axis, against one vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CirclePlane {
    axis: Vec3,
    /// The sine of the angle between the axis and the vertical.
    fall: f64,
    /// The unit vector that goes down steepest, and the one across it.
    down: Vec3,
    across: Vec3,
}

impl CirclePlane {
    fn new(axis: &Vec3, up: &Vec3) -> CirclePlane {
        let (along, down) = (up.dot(axis), downhill(axis, up));
        let fall = (1.0 - along * along).max(0.0).sqrt();
        CirclePlane { axis: *axis, fall, down, across: axis.cross(&down) }
    }

    /// Returns the plane of circles with an axis: the known one if it is that.
    #[inline(always)]
    fn known<'p>(known: &'p mut Option<CirclePlane>, axis: &Vec3, up: &Vec3) -> &'p CirclePlane {
        if known.as_ref().is_none_or(|plane| plane.axis != *axis) {
            *known = None;
        }
        known.get_or_insert_with(|| CirclePlane::new(axis, up))
    }
}

/// Returns the point in the middle of the line on which a cylinder with these two rims lies, in their frame (m), with
/// `up` the unit vector upwards in that frame; `None` if they are not the rims of one. A wheel that turns on the spot
/// sticks there, and not at a rim, as it would if only its rims bore it. `plane`: as [`Feature::points_below`] has it.
#[inline(always)]
pub fn tread(first: &Feature, second: &Feature, up: &Vec3, plane: &mut Option<CirclePlane>) -> Option<Vec3> {
    let (Form::Circle(axis, radius), Form::Circle(other, same)) = (first.form, second.form) else {
        return None;
    };
    (axis == other && radius == same).then(|| {
        let lowest = CirclePlane::known(plane, &axis, up).down * radius;
        ((first.centre + lowest) + (second.centre + lowest)) / 2.0
    })
}

/// Returns the features of all shapes of a link, in the frame of the link, in the order in which the shapes are
/// declared: corners of boxes, hulls and meshes, rims of cylinders, spheres, and the end spheres of capsules.
pub fn features(shapes: &[Placed]) -> Vec<Feature> {
    let mut found = Vec::new();
    let mut open: Vec<(Pose, &Shape)> = shapes.iter().rev().map(|s| (s.pose, &s.shape)).collect();
    while let Some((pose, shape)) = open.pop() {
        if let Shape::Union { parts } = shape {
            open.extend(parts.iter().rev().map(|part| (pose * part.pose, &part.shape)));
            continue;
        }
        let (R, p) = (*pose.rotation.to_rotation_matrix().matrix(), pose.translation.vector);
        found.extend(of_shape(shape).iter().map(|feature| feature.placed(&R, &p)));
    }
    found
}

fn of_shape(shape: &Shape) -> Vec<Feature> {
    let feature = |centre, form| Feature { centre, form };
    match shape {
        Shape::Box { size } => {
            let corner = |i: u8| {
                let sign = |bit: u8| if i & bit == 0 { -0.5 } else { 0.5 };
                Vec3::new(sign(1) * size.x, sign(2) * size.y, sign(4) * size.z)
            };
            (0..8).map(|i| feature(corner(i), Form::Vertex)).collect()
        }
        Shape::Cylinder { radius, length, axis } => {
            let ends = [-0.5, 0.5].map(|half| axis * (half * length));
            ends.map(|centre| feature(centre, Form::Circle(*axis, *radius))).to_vec()
        }
        Shape::Sphere { radius } => vec![feature(Vec3::zeros(), Form::Sphere(*radius))],
        Shape::Capsule { radius, length, axis } => {
            let ends = [-0.5, 0.5].map(|half| axis * (half * length));
            ends.map(|centre| feature(centre, Form::Sphere(*radius))).to_vec()
        }
        Shape::Hull { points } => vertices(points),
        Shape::Mesh { vertices: points, .. } => vertices(points),
        Shape::Union { .. } => vec![],
    }
}

/// Returns the corners of the convex hull of points: only they can be lowest.
fn vertices(points: &[Vec3]) -> Vec<Feature> {
    let corners = hull::faces(points).map(|faces| faces.points);
    let corners = corners.as_deref().unwrap_or(points);
    corners.iter().map(|p| Feature { centre: *p, form: Form::Vertex }).collect()
}
