//! Spatial vectors and inertias (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, ch. 2): the velocity of a body, or
//! the wrench on it, as one vector of six components.
//!
//! All quantities of a computation are along the axes of the world and about one point O: an inertia is added to that of
//! the body that carries it as it is, without any change of frame.

use super::dynamics::{Composite, Wrench};
use super::jacobian::JointAxis;
use crate::geometry::Vec3;
use nalgebra::{Matrix3, Matrix6, Vector6};

/// A spatial vector about O: a twist (rad/s, and m/s of the body's point that is at O), its derivative, or a wrench (N·m
/// about O, N).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialVector {
    /// The angular velocity, rad/s; of a wrench the moment about O, N·m.
    pub angular: Vec3,
    /// The velocity of the point at O, m/s; of a wrench the force, N.
    pub linear: Vec3,
}

impl SpatialVector {
    /// Returns the twist of a body that a joint with this axis moves at 1 rad/s or 1 m/s; `origin`: the point O in the
    /// world, m.
    pub fn of_axis(axis: &JointAxis, origin: &Vec3) -> SpatialVector {
        let (linear, angular) = axis.velocity(origin);
        SpatialVector { angular, linear }
    }

    /// Returns a wrench from its force (N) and the point on its line of action, from O (m).
    pub fn of_force(force: Vec3, point: &Vec3) -> SpatialVector {
        SpatialVector { angular: point.cross(&force), linear: force }
    }

    /// Returns the scalar product of a twist with a wrench, their power (W), or of a wrench with a twist.
    #[inline]
    pub fn dot(&self, other: &SpatialVector) -> f64 {
        self.angular.dot(&other.angular) + self.linear.dot(&other.linear)
    }

    /// Returns the sum of this vector and a multiple of another.
    #[inline]
    pub fn plus(&self, other: &SpatialVector, factor: f64) -> SpatialVector {
        SpatialVector {
            angular: self.angular + other.angular * factor,
            linear: self.linear + other.linear * factor,
        }
    }

    /// Returns the velocity, in the world, of the point of the body that is at `point` (from O, m) for this twist, m/s.
    #[inline]
    pub fn at(&self, point: &Vec3) -> Vec3 {
        self.linear + self.angular.cross(point)
    }

    /// Returns the cross product of this twist with another (Featherstone 2008, eq. 2.31).
    #[inline]
    pub fn cross(&self, other: &SpatialVector) -> SpatialVector {
        SpatialVector {
            angular: self.angular.cross(&other.angular),
            linear: self.linear.cross(&other.angular) + self.angular.cross(&other.linear),
        }
    }

    /// Returns the cross product of this twist with a wrench or momentum (Featherstone 2008, eq. 2.32).
    #[inline]
    pub fn cross_force(&self, force: &SpatialVector) -> SpatialVector {
        SpatialVector {
            angular: self.angular.cross(&force.angular) + self.linear.cross(&force.linear),
            linear: self.angular.cross(&force.linear),
        }
    }
}

impl From<Wrench> for SpatialVector {
    /// Returns a wrench whose moment is about O.
    fn from(Wrench { force, moment }: Wrench) -> SpatialVector {
        SpatialVector { angular: moment, linear: force }
    }
}

/// A symmetric spatial inertia about O, or an impedance: it maps a twist to a momentum, or to a wrench. Rows are angular
/// and linear: `[[angular, mixed], [mixedᵀ, linear]]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialInertia {
    /// The moments of inertia about O, kg·m².
    pub angular: Matrix3<f64>,
    /// The first moment of mass as a cross product, kg·m.
    pub mixed: Matrix3<f64>,
    /// The mass along each axis, kg.
    pub linear: Matrix3<f64>,
}

impl SpatialInertia {
    /// Returns the inertia that a symmetric matrix `linear` (kg) at one point of a body makes; `point`: that point, from
    /// O (m).
    pub fn at_point(linear: &Matrix3<f64>, point: &Vec3) -> SpatialInertia {
        let cross = point.cross_matrix();
        let mixed = cross * linear;
        SpatialInertia { angular: mixed * cross.transpose(), mixed, linear: *linear }
    }

    /// Returns the momentum of a twist, or the wrench of an acceleration.
    #[inline]
    pub fn times(&self, v: &SpatialVector) -> SpatialVector {
        SpatialVector {
            angular: self.angular * v.angular + self.mixed * v.linear,
            linear: self.mixed.tr_mul(&v.angular) + self.linear * v.linear,
        }
    }

    /// Adds another inertia.
    #[inline]
    pub fn add(&mut self, other: &SpatialInertia) {
        self.angular += other.angular;
        self.mixed += other.mixed;
        self.linear += other.linear;
    }

    /// Returns the inertia less `u uᵀ / d`.
    #[inline]
    pub fn less(&self, u: &SpatialVector, d: f64) -> SpatialInertia {
        let (angular, linear) = (u.angular / d, u.linear / d);
        SpatialInertia {
            angular: self.angular - angular * u.angular.transpose(),
            mixed: self.mixed - angular * u.linear.transpose(),
            linear: self.linear - linear * u.linear.transpose(),
        }
    }

    /// Returns the 6 × 6 matrix, angular rows first.
    pub fn matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.angular);
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.mixed);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&self.mixed.transpose());
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.linear);
        matrix
    }
}

impl From<Composite> for SpatialInertia {
    /// Returns the inertia of bodies that move as one, about the point that theirs is about.
    fn from(composite: Composite) -> SpatialInertia {
        SpatialInertia {
            angular: composite.inertia,
            mixed: composite.first.cross_matrix(),
            linear: Matrix3::from_diagonal_element(composite.mass),
        }
    }
}

impl SpatialVector {
    /// Returns the weight of bodies that move as one (N·m about the point that their inertia is about, N); `gravity`: the
    /// acceleration of free fall in the world, m/s².
    pub fn weight(composite: &Composite, gravity: &Vec3) -> SpatialVector {
        SpatialVector { angular: composite.first.cross(gravity), linear: gravity * composite.mass }
    }

    /// Returns the six components, angular first.
    pub fn vector(&self) -> Vector6<f64> {
        Vector6::from_iterator(self.angular.iter().chain(&self.linear).copied())
    }

    /// Returns the spatial vector of six components, angular first.
    pub fn from_vector(vector: &Vector6<f64>) -> SpatialVector {
        SpatialVector { angular: vector.fixed_rows::<3>(0).into(), linear: vector.fixed_rows::<3>(3).into() }
    }
}
