//! Rigid displacements in the planner's own form: a rotation matrix and a vector, in parts of the pitch.

use crate::geometry::angle::sin_cos;
use nalgebra::{Matrix3, Vector3};

pub type Mat = Matrix3<f64>;
pub type Vec3 = Vector3<f64>;

/// `X_AB`: the pose of frame B in frame A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    pub rotation: Mat,
    pub place: Vec3,
}

impl Rigid {
    pub fn identity() -> Rigid {
        Rigid { rotation: Mat::identity(), place: Vec3::zeros() }
    }

    /// `X_AC = X_AB · X_BC`
    pub fn then(&self, next: &Rigid) -> Rigid {
        Rigid { rotation: self.rotation * next.rotation, place: self.rotation * next.place + self.place }
    }

    pub fn inverse(&self) -> Rigid {
        let back = self.rotation.transpose();
        Rigid { rotation: back, place: -(back * self.place) }
    }
}

pub fn about_x(angle: f64) -> Mat {
    let (s, c) = sin_cos(angle);
    Mat::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

pub fn about_z(angle: f64) -> Mat {
    let (s, c) = sin_cos(angle);
    Mat::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

/// The rotation vector of a rotation: axis times angle, 0 to π.
pub fn rotation_vector(r: &Mat) -> Vec3 {
    let twice_sine = Vec3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
    let (s, c) = (0.5 * twice_sine.norm(), 0.5 * (r.trace() - 1.0));
    let angle = libm::atan2(s, c);
    if s > HALF_TURN_MIN {
        return twice_sine * (0.5 * angle / s);
    }
    if c > 0.0 {
        return twice_sine * 0.5;
    }
    // Half a turn: the axis is the longest column of R + 1.
    let both = r + Mat::identity();
    let column = (0..3).max_by(|&i, &j| both.column(i).norm().total_cmp(&both.column(j).norm())).unwrap_or(0);
    both.column(column).normalize() * angle
}

/// Below this sine a rotation is none, or half a turn.
const HALF_TURN_MIN: f64 = 1e-9;
