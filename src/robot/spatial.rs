//! Spatial vectors and inertias (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, ch. 2): the velocity of a body, or
//! the wrench on it, as one vector of six components.
//!
//! All quantities of a computation are along the axes of the world and about one point O: an inertia is added to that of
//! the body that carries it as it is, without any change of frame.
#![allow(non_snake_case)]

use super::dynamics::{Composite, RigidBody, Wrench};
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
    #[inline(always)]
    pub fn of_axis(axis: &JointAxis, origin: &Vec3) -> SpatialVector {
        let (linear, angular) = axis.velocity(origin);
        SpatialVector { angular, linear }
    }

    /// Returns a wrench from its force (N) and the point on its line of action, from O (m).
    #[inline(always)]
    pub fn of_force(force: Vec3, point: &Vec3) -> SpatialVector {
        SpatialVector { angular: point.cross(&force), linear: force }
    }

    /// Returns the scalar product of a twist with a wrench, their power (W), or of a wrench with a twist.
    #[inline(always)]
    pub fn dot(&self, other: &SpatialVector) -> f64 {
        self.angular.dot(&other.angular) + self.linear.dot(&other.linear)
    }

    /// Returns the sum of this vector and a multiple of another.
    #[inline(always)]
    pub fn plus(&self, other: &SpatialVector, factor: f64) -> SpatialVector {
        SpatialVector {
            angular: self.angular + other.angular * factor,
            linear: self.linear + other.linear * factor,
        }
    }

    /// Returns the velocity, in the world, of the point of the body that is at `point` (from O, m) for this twist, m/s.
    #[inline(always)]
    pub fn at(&self, point: &Vec3) -> Vec3 {
        self.linear + self.angular.cross(point)
    }

    /// Returns the cross product of this twist with another (Featherstone 2008, eq. 2.31).
    #[inline(always)]
    pub fn cross(&self, other: &SpatialVector) -> SpatialVector {
        SpatialVector {
            angular: self.angular.cross(&other.angular),
            linear: self.linear.cross(&other.angular) + self.angular.cross(&other.linear),
        }
    }

    /// Returns the cross product of this twist with a wrench or momentum (Featherstone 2008, eq. 2.32).
    #[inline(always)]
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

/// A symmetric 3 × 3 matrix, by the six entries that may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Symmetric {
    /// The entries xx, xy, xz, yy, yz and zz, in the unit of the matrix.
    pub entries: [f64; 6],
}

impl Symmetric {
    /// Returns the matrix with the upper triangle of another.
    #[inline(always)]
    pub fn of_upper(m: &Matrix3<f64>) -> Symmetric {
        Symmetric { entries: [m[(0, 0)], m[(0, 1)], m[(0, 2)], m[(1, 1)], m[(1, 2)], m[(2, 2)]] }
    }

    /// Returns the product with a vector.
    #[inline(always)]
    pub fn times(&self, v: &Vec3) -> Vec3 {
        let [xx, xy, xz, yy, yz, zz] = self.entries;
        Vec3::new(
            xx * v.x + xy * v.y + xz * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z,
        )
    }

    /// Returns the sum with another matrix.
    #[inline(always)]
    pub fn plus(&self, other: &Symmetric) -> Symmetric {
        Symmetric { entries: std::array::from_fn(|entry| self.entries[entry] + other.entries[entry]) }
    }

    /// Adds another matrix.
    #[inline(always)]
    pub fn add(&mut self, other: &Symmetric) {
        self.entries.iter_mut().zip(other.entries).for_each(|(sum, entry)| *sum += entry);
    }

    /// Returns the matrix less `u uᵀ` times a factor.
    #[inline(always)]
    pub fn less(&self, u: &Vec3, factor: f64) -> Symmetric {
        let f = u * factor;
        let [xx, xy, xz, yy, yz, zz] = self.entries;
        Symmetric {
            entries: [
                xx - f.x * u.x,
                xy - f.x * u.y,
                xz - f.x * u.z,
                yy - f.y * u.y,
                yz - f.y * u.z,
                zz - f.z * u.z,
            ],
        }
    }

    /// Returns all nine entries.
    pub fn matrix(&self) -> Matrix3<f64> {
        let [xx, xy, xz, yy, yz, zz] = self.entries;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

/// A symmetric spatial inertia about O, or an impedance: it maps a twist to a momentum, or to a wrench. Rows are angular
/// and linear: `[[angular, mixed], [mixedᵀ, linear]]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialInertia {
    /// The moments of inertia about O, kg·m².
    pub angular: Symmetric,
    /// The first moment of mass as a cross product, kg·m.
    pub mixed: Matrix3<f64>,
    /// The mass along each axis, kg.
    pub linear: Symmetric,
}

impl SpatialInertia {
    /// Returns the inertia that one point of a body makes which is as heavy as `across` (kg), and by `along` (kg) heavier along
    /// a unit vector `normal`; `point`: that point, from O (m).
    #[inline(always)]
    pub fn at_point(across: f64, along: f64, normal: &Vec3, point: &Vec3) -> SpatialInertia {
        let arm = point.cross(normal);
        let even = Symmetric { entries: [across, 0.0, 0.0, across, 0.0, across] };
        let about = across * point.norm_squared();
        let turning = Symmetric { entries: [about, 0.0, 0.0, about, 0.0, about] };
        SpatialInertia {
            angular: turning.less(point, across).less(&arm, -along),
            mixed: (point * across).cross_matrix() + arm * (normal * along).transpose(),
            linear: even.less(normal, -along),
        }
    }

    /// Returns the inertia as [`at_point`](Self::at_point) does, for the vertical as the unit vector.
    #[inline(always)]
    pub fn at_point_of_level(across: f64, along: f64, point: &Vec3) -> SpatialInertia {
        let f = point * across;
        let all = across + along;
        let (xx, yy, zz) = (f.x * point.x, f.y * point.y, f.z * point.z);
        SpatialInertia {
            angular: Symmetric {
                entries: [
                    all * point.y * point.y + zz,
                    -(all * point.x * point.y),
                    -(f.x * point.z),
                    all * point.x * point.x + zz,
                    -(f.y * point.z),
                    xx + yy,
                ],
            },
            mixed: Matrix3::new(0.0, -f.z, all * point.y, f.z, 0.0, -(all * point.x), -f.y, f.x, 0.0),
            linear: Symmetric { entries: [across, 0.0, 0.0, across, 0.0, all] },
        }
    }

    /// Returns the inertia of a rigid body about O, and that about its centre of mass along the axes of the world; `R`: the
    /// rotation from its frame to the world; `com`: its centre of mass, from O in the world (m).
    #[inline(always)]
    pub fn of_rigid(body: &RigidBody, R: &Matrix3<f64>, com: &Vec3) -> (SpatialInertia, Symmetric) {
        let I = &body.inertia;
        let central = if I[(0, 1)] == 0.0 && I[(0, 2)] == 0.0 && I[(1, 2)] == 0.0 {
            // The moments about x and y beyond that about z, which is the same about all axes.
            let (about_x, about_y, all) = (I[(0, 0)] - I[(2, 2)], I[(1, 1)] - I[(2, 2)], I[(2, 2)]);
            let (x, y) = (R.column(0), R.column(1));
            let (fx, fy) = (x * about_x, y * about_y);
            Symmetric {
                entries: [
                    fx.x * x.x + fy.x * y.x + all,
                    fx.x * x.y + fy.x * y.y,
                    fx.x * x.z + fy.x * y.z,
                    fx.y * x.y + fy.y * y.y + all,
                    fx.y * x.z + fy.y * y.z,
                    fx.z * x.z + fy.z * y.z + all,
                ],
            }
        } else {
            let row = |i: usize| {
                let (x, y, z) = (R[(i, 0)], R[(i, 1)], R[(i, 2)]);
                let turned = Vec3::new(
                    x * I[(0, 0)] + y * I[(0, 1)] + z * I[(0, 2)],
                    x * I[(0, 1)] + y * I[(1, 1)] + z * I[(1, 2)],
                    x * I[(0, 2)] + y * I[(1, 2)] + z * I[(2, 2)],
                );
                (turned, Vec3::new(x, y, z))
            };
            let ((ax, x), (ay, y), (az, z)) = (row(0), row(1), row(2));
            Symmetric { entries: [ax.dot(&x), ax.dot(&y), ax.dot(&z), ay.dot(&y), ay.dot(&z), az.dot(&z)] }
        };
        let first = com * body.mass;
        let about = first.dot(com);
        let [xx, xy, xz, yy, yz, zz] = central.entries;
        let entries = [
            xx + about - first.x * com.x,
            xy - first.x * com.y,
            xz - first.x * com.z,
            yy + about - first.y * com.y,
            yz - first.y * com.z,
            zz + about - first.z * com.z,
        ];
        let inertia = SpatialInertia {
            angular: Symmetric { entries },
            mixed: first.cross_matrix(),
            linear: Symmetric { entries: [body.mass, 0.0, 0.0, body.mass, 0.0, body.mass] },
        };
        (inertia, central)
    }

    /// Returns the momentum of a twist, or the wrench of an acceleration.
    #[inline(always)]
    pub fn times(&self, v: &SpatialVector) -> SpatialVector {
        SpatialVector {
            angular: self.angular.times(&v.angular) + self.mixed * v.linear,
            linear: self.mixed.tr_mul(&v.angular) + self.linear.times(&v.linear),
        }
    }

    /// Returns the sum with another inertia.
    #[inline(always)]
    pub fn plus(&self, other: &SpatialInertia) -> SpatialInertia {
        SpatialInertia {
            angular: self.angular.plus(&other.angular),
            mixed: self.mixed + other.mixed,
            linear: self.linear.plus(&other.linear),
        }
    }

    /// Adds another inertia.
    #[inline(always)]
    pub fn add(&mut self, other: &SpatialInertia) {
        self.angular.add(&other.angular);
        self.mixed += other.mixed;
        self.linear.add(&other.linear);
    }

    /// Returns the inertia less `u uᵀ` times a factor.
    #[inline(always)]
    pub fn less(&self, u: &SpatialVector, factor: f64) -> SpatialInertia {
        let angular = u.angular * factor;
        SpatialInertia {
            angular: self.angular.less(&u.angular, factor),
            mixed: self.mixed - angular * u.linear.transpose(),
            linear: self.linear.less(&u.linear, factor),
        }
    }

    /// Returns the 6 × 6 matrix, angular rows first.
    pub fn matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.angular.matrix());
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.mixed);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&self.mixed.transpose());
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.linear.matrix());
        matrix
    }
}

impl From<Composite> for SpatialInertia {
    /// Returns the inertia of bodies that move as one, about the point that theirs is about.
    fn from(composite: Composite) -> SpatialInertia {
        SpatialInertia {
            angular: Symmetric::of_upper(&composite.inertia),
            mixed: composite.first.cross_matrix(),
            linear: Symmetric { entries: [composite.mass, 0.0, 0.0, composite.mass, 0.0, composite.mass] },
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
