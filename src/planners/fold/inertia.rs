//! Rigid-body inertia of panels.

use super::polygon;
use super::target::Target;
use crate::geometry::{Pose, Vec3};
use nalgebra::Matrix3;

/// The distribution of a panel's mass, from which its centre and inertia follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    /// A mass spread evenly over the panel, without thickness.
    Lamina,
    /// A mass spread evenly over the panel with a thickness, m, half of it on either side.
    Prism(f64),
    /// A mass at the centroid, to which the numbers of [Yao et al.](super) amount.
    Point,
}

/// A panel as a rigid body: its mass, centre of mass and inertia in the frame of the target, for its pose in the
/// target.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// The mass of the panel, kg.
    pub mass: f64,
    /// The centre of mass in the frame of the target, m.
    pub centre: Vec3,
    /// The inertia tensor about the centre of mass, in the axes of the target, kg·m².
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// Returns the rigid body of a panel from its corners (m) and mass (kg), in the frame of the corners. `inertia`:
    /// how the mass is spread.
    pub fn of_panel(corners: &[Vec3], mass: f64, inertia: Inertia) -> Body {
        let centre = polygon::centroid(corners);
        let second = second_moment(corners, |corner| corner - centre, inertia) * mass;
        Body { mass, centre, inertia: Matrix3::identity() * second.trace() - second }
    }

    /// Returns the rigid bodies of all panels in the frame of the target, in the order of [`Target::faces`]; `masses`:
    /// one for each face in that order, kg. `inertia`: how the mass of a panel is spread. Panics if there are more
    /// masses than faces.
    pub fn of_target(target: &Target, masses: &[f64], inertia: Inertia) -> Vec<Body> {
        let body = |(face, &mass): (usize, &f64)| Body::of_panel(target.corners(face), mass, inertia);
        masses.iter().enumerate().map(body).collect()
    }
}

/// Returns the moment of inertia (kg·m²) of a panel with these corners (m) and this `mass` (kg), spread as `inertia`
/// says, about the line through `point` (m) along the unit vector `axis`.
pub fn moment_about(corners: &[Vec3], mass: f64, inertia: Inertia, point: &Vec3, axis: &Vec3) -> f64 {
    moment_of(second_moment(corners, |corner| corner - point, inertia), mass, axis)
}

/// Returns the moment of inertia (kg·m²) as [`moment_about`] does, of a panel in another pose: `pose` leads from the
/// frame of the corners to that of the line.
pub fn moment_in(
    pose: &Pose,
    corners: &[Vec3],
    mass: f64,
    inertia: Inertia,
    point: &Vec3,
    axis: &Vec3,
) -> f64 {
    let place = |corner: &Vec3| pose.transform_point(&(*corner).into()).coords - point;
    moment_of(second_moment(corners, place, inertia), mass, axis)
}

/// Returns the moment of inertia about an axis through the point of reference of a second moment by mass.
fn moment_of(second: Matrix3<f64>, mass: f64, axis: &Vec3) -> f64 {
    mass * (second.trace() - axis.dot(&(second * axis)))
}

/// Returns the second moment `∫ v vᵀ` over the panel by its mass, for places of the corners relative to the point of
/// reference, m²: that of the triangles of its fan, by their parts of the area.
fn second_moment(corners: &[Vec3], place: impl Fn(&Vec3) -> Vec3, inertia: Inertia) -> Matrix3<f64> {
    if inertia == Inertia::Point {
        let sum = place(&polygon::centroid(corners));
        return sum * sum.transpose();
    }
    if let [a, b, c] = corners {
        return of_triangle([place(a), place(b), place(c)], inertia);
    }
    let parts = polygon::weighted_fan(corners).map(|(triangle, part)| (triangle.map(|p| place(&p)), part));
    parts.map(|(triangle, part)| of_triangle(triangle, inertia) * part).sum()
}

/// Returns the second moment of an even triangle by its mass.
fn of_triangle([a, b, c]: [Vec3; 3], inertia: Inertia) -> Matrix3<f64> {
    let sum: Vec3 = a + b + c;
    let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
    let spread = squares + sum * sum.transpose();
    let Inertia::Prism(thickness) = inertia else { return spread / 12.0 };
    let normal = (b - a).cross(&(c - a)).normalize();
    (spread + normal * normal.transpose() * (thickness * thickness)) / 12.0
}
