//! Volume, centre and second moments of shapes.

use super::hull;
use super::pose::{Pose, Vec3};
use super::shape::{Placed, Shape};
use super::soundness::{self, Unsound};
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// The volume of a solid, with its first and second moments for a density of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// The volume of the solid, m³.
    pub volume: f64,
    /// The centroid, m, in the frame of the shape or of the poses that it was computed from.
    pub centre: Vec3,
    /// Second moments `∫ p pᵀ dV` with p from the centroid, along the axes of that frame, m⁵: a symmetric matrix.
    pub second: Matrix3<f64>,
}

impl Volume {
    /// Returns the 3 × 3 inertia tensor about the centroid for a density of 1, `tr(S) 1 - S` with S the second
    /// moments, m⁵: times the density in kg/m³ it is in kg·m². Its axes are those of the frame that the volume was
    /// computed in.
    pub fn inertia(&self) -> Matrix3<f64> {
        Matrix3::identity() * self.second.trace() - self.second
    }

    fn centred(volume: f64, second: Matrix3<f64>) -> Volume {
        Volume { volume, centre: Vec3::zeros(), second }
    }

    fn moved(&self, pose: &Pose) -> Volume {
        let r = pose.rotation.to_rotation_matrix();
        let r = r.matrix();
        Volume {
            volume: self.volume,
            centre: pose.translation.vector + r * self.centre,
            second: r * self.second * r.transpose(),
        }
    }

    fn sum(parts: &[Volume]) -> Volume {
        let volume: f64 = parts.iter().map(|p| p.volume).sum();
        let centre = parts.iter().map(|p| p.centre * p.volume).sum::<Vec3>() / volume;
        let second = parts.iter().map(|p| {
            let d = p.centre - centre;
            p.second + d * d.transpose() * p.volume
        });
        Volume { volume, centre, second: second.sum() }
    }
}

/// Returns the volume (m³), centroid (m) and second moments (m⁵) of one shape in its own frame: in closed form, and
/// of a hull or mesh as a sum of tetrahedra.
///
/// # Errors
/// The first fault of the shape ([`soundness::check`]).
pub fn of_shape(shape: &Shape) -> Result<Volume, Unsound> {
    soundness::check(shape)?;
    Ok(match shape {
        Shape::Box { size } => {
            let volume = size.x * size.y * size.z;
            Volume::centred(volume, Matrix3::from_diagonal(&size.component_mul(size)) * (volume / 12.0))
        }
        Shape::Cylinder { radius, length, axis } => {
            let volume = PI * radius * radius * length;
            about_axis(axis, volume, length * length / 12.0, radius * radius / 4.0)
        }
        Shape::Sphere { radius } => {
            let volume = 4.0 / 3.0 * PI * radius * radius * radius;
            Volume::centred(volume, Matrix3::identity() * (volume * radius * radius / 5.0))
        }
        Shape::Capsule { radius, length, axis } => capsule(*radius, *length, axis),
        Shape::Hull { points } => {
            let faces = hull::faces(points).ok_or(Unsound::Flat)?;
            of_triangles(&faces.points, &faces.triangles)
        }
        Shape::Mesh { vertices, triangles, .. } => of_triangles(vertices, triangles),
        Shape::Union { parts } => of_placed(parts)?,
    })
}

/// Returns the volume (m³), centroid (m) and second moments (m⁵) of several placed shapes together, in the frame of
/// their poses, by the parallel axis theorem; an overlap counts as often as shapes share it. Poses are not checked to
/// be rigid.
///
/// # Errors
/// The first fault of a shape ([`soundness::check`]), or [`Unsound::Empty`] if there is none.
pub fn of_placed(shapes: &[Placed]) -> Result<Volume, Unsound> {
    if shapes.is_empty() {
        return Err(Unsound::Empty);
    }
    let parts = shapes.iter().map(|placed| Ok(of_shape(&placed.shape)?.moved(&placed.pose)));
    Ok(Volume::sum(&parts.collect::<Result<Vec<_>, Unsound>>()?))
}

/// Returns the moments of a body of revolution with these mean squares along and across its axis.
fn about_axis(axis: &Vec3, volume: f64, along: f64, across: f64) -> Volume {
    let u = axis.normalize();
    let uu = u * u.transpose();
    Volume::centred(volume, uu * (volume * along) + (Matrix3::identity() - uu) * (volume * across))
}

/// Returns the moments of a cylinder and two half balls; a half ball's centroid is 3/8 of the radius from its flat
/// face.
fn capsule(radius: f64, length: f64, axis: &Vec3) -> Volume {
    let r2 = radius * radius;
    let (rod, ball) = (PI * r2 * length, 4.0 / 3.0 * PI * r2 * radius);
    let caps_along = length * length / 4.0 + 3.0 / 8.0 * length * radius + r2 / 5.0;
    let along = rod * length * length / 12.0 + ball * caps_along;
    let across = rod * r2 / 4.0 + ball * r2 / 5.0;
    let volume = rod + ball;
    about_axis(axis, volume, along / volume, across / volume)
}

/// Returns the moments of the inside of a closed surface of triangles, counter-clockwise from outside: a sum over
/// signed tetrahedra with a common tip.
fn of_triangles(points: &[Vec3], triangles: &[[u32; 3]]) -> Volume {
    let tip = points[0];
    let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Matrix3::zeros());
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| points[i as usize] - tip);
        let v = a.dot(&b.cross(&c)) / 6.0;
        let s = a + b + c;
        volume += v;
        first += s * (v / 4.0);
        let squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose();
        second += squares * (v / 20.0);
    }
    let centre = first / volume;
    Volume { volume, centre: tip + centre, second: second - centre * centre.transpose() * volume }
}
