//! Rigid-body inertia of triangular panels.

use super::target::Target;
use crate::geometry::Vec3;
use nalgebra::Matrix3;

/// The distribution of a panel's mass, from which its centre and inertia follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    /// A mass spread evenly over the triangle, without thickness.
    Lamina,
    /// A mass spread evenly over the triangle with a thickness, m, half of it on either side.
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
    pub fn of_panel(corners: &[Vec3; 3], mass: f64, inertia: Inertia) -> Body {
        let centre = corners.iter().sum::<Vec3>() / 3.0;
        let second = second_moment(&corners.map(|c| c - centre), inertia) * mass;
        Body { mass, centre, inertia: Matrix3::identity() * second.trace() - second }
    }

    /// Returns the rigid bodies of all panels in the frame of the target, in the order of [`Target::faces`]; `masses`:
    /// one for each face in that order, kg. `inertia`: how the mass of a panel is spread. Panics if there are more
    /// masses than faces.
    pub fn of_target(target: &Target, masses: &[f64], inertia: Inertia) -> Vec<Body> {
        let body = |(face, &mass): (usize, &f64)| Body::of_panel(&target.corners(face), mass, inertia);
        masses.iter().enumerate().map(body).collect()
    }
}

/// Returns the moment of inertia (kg·m²) of a panel with these corners (m) and this `mass` (kg), spread as `inertia`
/// says, about the line through `point` (m) along the unit vector `axis`.
pub fn moment_about(corners: &[Vec3; 3], mass: f64, inertia: Inertia, point: &Vec3, axis: &Vec3) -> f64 {
    let second = second_moment(&corners.map(|c| c - point), inertia);
    mass * (second.trace() - axis.dot(&(second * axis)))
}

/// Returns the second moment `∫ v vᵀ` over the panel by its mass, for corners relative to the reference point, m².
fn second_moment(corners: &[Vec3; 3], inertia: Inertia) -> Matrix3<f64> {
    let sum: Vec3 = corners.iter().sum();
    if inertia == Inertia::Point {
        return sum * sum.transpose() / 9.0;
    }
    let spread = corners.iter().map(|v| v * v.transpose()).sum::<Matrix3<f64>>() + sum * sum.transpose();
    let Inertia::Prism(thickness) = inertia else { return spread / 12.0 };
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a)).normalize();
    (spread + normal * normal.transpose() * (thickness * thickness)) / 12.0
}
