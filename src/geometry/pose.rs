//! Vectors, and rigid displacements with a quaternion. A pose `X_AB` is the pose of frame B in frame A:
//! `p_A = X_AB * p_B`.

/// A rigid displacement of SE(3) as a unit quaternion and a translation in metres: rotation first, then translation.
/// `X_AB` is the pose of frame B in frame A. For inner loops see [`RigidTransform`](super::RigidTransform).
pub type Pose = nalgebra::Isometry3<f64>;

/// A vector of three real numbers along x, y and z: a position in metres, a direction without unit, or a moment in
/// N·m, as the user of the type states.
pub type Vec3 = nalgebra::Vector3<f64>;

/// A 3×3 matrix of `f64`, mostly a rotation `R_AB`, whose columns are the axes of frame B in frame A.
pub type Mat3 = nalgebra::Matrix3<f64>;

/// Returns the rotation about an axis through the origin by an angle in radians, by the right-hand rule, as a pose
/// without translation. The axis need not be of unit length; a zero axis gives no rotation.
pub fn turned(axis: Vec3, angle: f64) -> Pose {
    let n = axis.norm();
    if n == 0.0 {
        return Pose::identity();
    }
    let (s, c) = libm::sincos(angle / 2.0);
    let v = axis * (s / n);
    let q = nalgebra::Quaternion::new(c, v.x, v.y, v.z);
    Pose::from_parts(nalgebra::Translation3::identity(), nalgebra::UnitQuaternion::new_normalize(q))
}

/// Returns the Euclidean length of a vector, in its unit. It is what `norm` returns, to the bit; but code that is compiled
/// for wider registers stays in them, which `norm` leaves for its square root, at the cost of a hundred nanoseconds.
#[inline(always)]
pub fn length(v: &Vec3) -> f64 {
    v.norm_squared().sqrt()
}

/// Returns a unit vector at right angles to another, which must not be zero.
pub fn perpendicular(axis: &Vec3) -> Vec3 {
    axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize()
}

/// Returns the translation by a vector in metres, as a pose without rotation.
pub fn shifted(p: Vec3) -> Pose {
    Pose::from_parts(p.into(), nalgebra::UnitQuaternion::identity())
}

/// Returns the angle by which a rotation leans the vertical, rad, from 0 to π.
pub fn lean(turn: &nalgebra::UnitQuaternion<f64>) -> f64 {
    let up = turn.transform_vector(&Vec3::z());
    libm::atan2(libm::hypot(up.x, up.y), up.z)
}

/// Returns the angle by which a turn takes the x axis about the vertical, rad, from -π to π.
pub fn turn_about_vertical(turn: &nalgebra::UnitQuaternion<f64>) -> f64 {
    let x = turn.transform_vector(&Vec3::x());
    libm::atan2(x.y, x.x)
}
