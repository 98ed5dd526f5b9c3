//! Convex parts, of which all solids are made, by their support functions.
//!
//! The support function `h(n)`, the greatest `n · p` over the part's points, is all that distances need: for any unit
//! `n` the separation along it, `-h_B(-n) - h_A(n)`, is a lower bound of the signed distance from A to B, and the
//! greatest of them is that distance.

use super::pose::{Pose, Vec3, perpendicular};

/// Threshold: the greatest sine of the angle between a direction and a cylinder's axis at which the direction counts as
/// along it: what is left across the axis is rounding.
const TOL_STRAIGHT: f64 = 1e-9;

/// The number of corners of the polygon around a rim: it is larger by 1/13000 of the radius.
const RIM_CORNERS: usize = 256;

/// A convex body in the frame of its solid: a box, cylinder, capsule, ball, or the hull of points.
#[derive(Clone, Debug)]
pub struct Part {
    form: Form,
    /// The centre of a ball around the part, m, in the frame of the part's solid.
    pub centre: Vec3,
    /// The radius of the ball about [`Part::centre`] that holds the part, m.
    pub radius: f64,
}

#[derive(Clone, Debug)]
enum Form {
    /// Half the edges as vectors.
    Box([Vec3; 3]),
    /// Half the axis as a vector, its unit, radius.
    Cylinder(Vec3, Vec3, f64),
    Capsule(Vec3, f64),
    Sphere(f64),
    /// Corners, from the centre.
    Points(Vec<Vec3>),
}

impl Part {
    /// Returns the box about `centre` (m) with these halves of its edges (m) as vectors, which must be perpendicular
    /// to each other; all in the frame of the part's solid.
    pub fn boxed(centre: Vec3, half_edges: [Vec3; 3]) -> Part {
        let radius = half_edges.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
        Part { form: Form::Box(half_edges), centre, radius }
    }

    /// Returns the cylinder about `centre` (m) with half of its axis as the vector `half_axis` (m), which must not be
    /// zero, and this `radius` (m); all in the frame of the part's solid.
    pub fn cylinder(centre: Vec3, half_axis: Vec3, radius: f64) -> Part {
        let reach = (half_axis.norm_squared() + radius * radius).sqrt();
        Part { form: Form::Cylinder(half_axis, half_axis.normalize(), radius), centre, radius: reach }
    }

    /// Returns the capsule about `centre` (m), all points within `radius` (m) of the segment from `centre -
    /// half_axis` to `centre + half_axis`, in the frame of the part's solid. Both the radius and the half axis may be
    /// zero.
    pub fn capsule(centre: Vec3, half_axis: Vec3, radius: f64) -> Part {
        Part { form: Form::Capsule(half_axis, radius), centre, radius: half_axis.norm() + radius }
    }

    /// Returns the ball about `centre` (m, in the frame of the part's solid) with this `radius` (m); with a radius of
    /// 0 it is a point.
    pub fn sphere(centre: Vec3, radius: f64) -> Part {
        Part { form: Form::Sphere(radius), centre, radius }
    }

    /// Returns the convex hull of these points (m, in the frame of the part's solid), which may be flat. Panics if
    /// there are none.
    pub fn points(points: &[Vec3]) -> Part {
        let bound = |pick: fn(f64, f64) -> f64| points.iter().fold(points[0], |m, p| m.zip_map(p, pick));
        let centre = (bound(f64::min) + bound(f64::max)) / 2.0;
        let points: Vec<Vec3> = points.iter().map(|p| p - centre).collect();
        let radius = points.iter().map(Vec3::norm).fold(0.0, f64::max);
        Part { form: Form::Points(points), centre, radius }
    }

    /// Returns the support function about the centre, `max n · (p - centre)` over the part's points p, m for a unit
    /// vector `n` of the part's frame; `n` may have any length, with which the result grows in proportion.
    #[inline]
    pub fn reach(&self, n: &Vec3) -> f64 {
        match &self.form {
            Form::Box(e) => n.dot(&e[0]).abs() + n.dot(&e[1]).abs() + n.dot(&e[2]).abs(),
            Form::Cylinder(half, unit, radius) => {
                let along = n.dot(unit);
                n.dot(half).abs() + radius * (n.norm_squared() - along * along).max(0.0).sqrt()
            }
            Form::Capsule(half, radius) => n.dot(half).abs() + radius * n.norm(),
            Form::Sphere(radius) => radius * n.norm(),
            Form::Points(points) => points.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Returns a support point of the part: one that is farthest along `n`, in the part's frame (m). `n` may have any
    /// length.
    pub fn support(&self, n: &Vec3) -> Vec3 {
        self.core_support(n) + unit_or_zero(n) * self.rounding()
    }

    /// Returns a point inside the part, m, in the part's frame: the centre, or the mean of the corners of a hull,
    /// whose centre may be outside.
    pub fn inner_point(&self) -> Vec3 {
        match &self.form {
            Form::Points(points) => self.centre + points.iter().sum::<Vec3>() / points.len() as f64,
            Form::Box(_) | Form::Cylinder(..) | Form::Capsule(..) | Form::Sphere(_) => self.centre,
        }
    }

    /// Returns the radius by which the core of the part is rounded, m: a sphere is a point and a capsule a
    /// segment, rounded by their radii; other parts are their own core, rounded by 0.
    pub fn rounding(&self) -> f64 {
        match self.form {
            Form::Sphere(radius) | Form::Capsule(_, radius) => radius,
            Form::Box(_) | Form::Cylinder(..) | Form::Points(_) => 0.0,
        }
    }

    /// Returns a point of the core (see [`rounding`](Self::rounding)) that is farthest along the vector `n`, in the
    /// part's frame, m.
    pub fn core_support(&self, n: &Vec3) -> Vec3 {
        let toward = |v: &Vec3| if n.dot(v) < 0.0 { -v } else { *v };
        let from_centre = match &self.form {
            Form::Box(e) => toward(&e[0]) + toward(&e[1]) + toward(&e[2]),
            Form::Cylinder(half, unit, radius) => {
                let across = n - unit * n.dot(unit);
                let straight = across.norm() <= TOL_STRAIGHT * n.norm();
                let rim = if straight { Vec3::zeros() } else { across.normalize() * *radius };
                toward(half) + rim
            }
            Form::Capsule(half, _) => toward(half),
            Form::Sphere(_) => Vec3::zeros(),
            Form::Points(points) => farthest(points, n),
        };
        self.centre + from_centre
    }

    /// Returns the corners of a polytope that holds the core of the part, in the part's frame, m. It is the core
    /// itself, but for a cylinder: that is in the prism around it.
    pub(super) fn core_corners(&self) -> Vec<Vec3> {
        let signs = [-1.0, 1.0];
        let from_centre: Vec<Vec3> = match &self.form {
            Form::Box(e) => signs
                .iter()
                .flat_map(|x| signs.map(|y| (*x, y)))
                .flat_map(|(x, y)| signs.map(|z| e[0] * x + e[1] * y + e[2] * z))
                .collect(),
            Form::Cylinder(half, unit, radius) => prism_around(half, unit, *radius),
            Form::Capsule(half, _) => signs.iter().map(|end| half * *end).collect(),
            Form::Sphere(_) => vec![Vec3::zeros()],
            Form::Points(points) => points.clone(),
        };
        from_centre.into_iter().map(|p| self.centre + p).collect()
    }

    /// Returns the part in the frame in which its own frame has the pose `X` (metres): every point p becomes `X · p`.
    pub fn moved(&self, X: &Pose) -> Part {
        let turn = |v: &Vec3| X.rotation * v;
        let form = match &self.form {
            Form::Box(e) => Form::Box([turn(&e[0]), turn(&e[1]), turn(&e[2])]),
            Form::Cylinder(half, unit, radius) => Form::Cylinder(turn(half), turn(unit), *radius),
            Form::Capsule(half, radius) => Form::Capsule(turn(half), *radius),
            Form::Sphere(radius) => Form::Sphere(*radius),
            Form::Points(points) => Form::Points(points.iter().map(turn).collect()),
        };
        Part { form, centre: X.transform_point(&self.centre.into()).coords, radius: self.radius }
    }

    /// Returns the part scaled about its centre by a positive factor without unit; the centre stays.
    pub fn scaled(&self, factor: f64) -> Part {
        let form = match &self.form {
            Form::Box(e) => Form::Box(e.map(|v| v * factor)),
            Form::Cylinder(half, unit, radius) => Form::Cylinder(half * factor, *unit, radius * factor),
            Form::Capsule(half, radius) => Form::Capsule(half * factor, radius * factor),
            Form::Sphere(radius) => Form::Sphere(radius * factor),
            Form::Points(points) => Form::Points(points.iter().map(|p| p * factor).collect()),
        };
        Part { form, centre: self.centre, radius: self.radius * factor }
    }

    /// Returns true if a turn by any angle about the line through `point` (m, in the part's frame) along the unit
    /// vector `axis` leaves the part as it is: it is a ball, cylinder or capsule whose centre and half axis are off
    /// the line by at most `tol`, m.
    pub fn is_round_about(&self, point: &Vec3, axis: &Vec3, tol: f64) -> bool {
        let off_line = |p: &Vec3| (p - axis * axis.dot(p)).norm();
        let centred = off_line(&(self.centre - point)) <= tol;
        centred
            && match &self.form {
                Form::Sphere(_) => true,
                Form::Cylinder(half, ..) | Form::Capsule(half, _) => off_line(half) <= tol,
                Form::Box(_) | Form::Points(_) => false,
            }
    }
}

/// Returns the corners of the regular prism around a cylinder.
fn prism_around(half: &Vec3, unit: &Vec3, radius: f64) -> Vec<Vec3> {
    let across = perpendicular(unit);
    let up = unit.cross(&across);
    let step = std::f64::consts::TAU / RIM_CORNERS as f64;
    let outer = radius / libm::cos(step / 2.0);
    let corner = |k: usize| {
        let (s, c) = libm::sincos(step * k as f64);
        (across * c + up * s) * outer
    };
    (0..RIM_CORNERS).flat_map(|k| [corner(k) - half, corner(k) + half]).collect()
}

fn unit_or_zero(v: &Vec3) -> Vec3 {
    v.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
}

/// Returns the first of the points that are farthest along `n`.
fn farthest(points: &[Vec3], n: &Vec3) -> Vec3 {
    let mut best = (f64::NEG_INFINITY, Vec3::zeros());
    for p in points {
        let along = n.dot(p);
        if along > best.0 {
            best = (along, *p);
        }
    }
    best.1
}
