//! Poses in plan files: `{"p": [x, y, z], "q": [w, x, y, z]}`, metres and a unit quaternion,
//! to the bit. For `#[serde(with = "crate::geometry::json")]`.

use super::pose::{Pose, Vec3};
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// A pose as written in a plan file: a translation in metres and a unit quaternion.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Pose", deny_unknown_fields)]
pub(crate) struct PoseText {
    /// Position of the frame's origin: x, y, z in metres, each at most 1000 m from 0; within a module at most 10 m.
    p: [f64; 3],
    /// Rotation as a unit quaternion: w, x, y, z.
    q: [f64; 4],
}

/// Threshold: the norm of a written quaternion, without unit, may differ from 1 by at most this: as much as rounding
/// can explain after many products, and no more.
const TOL_NORM: f64 = 1e-6;

/// Writes a pose, its numbers as they are.
///
/// # Errors
/// The serializer's error.
pub(crate) fn serialize<S: Serializer>(pose: &Pose, to: S) -> Result<S::Ok, S::Error> {
    let (t, q) = (&pose.translation.vector, &pose.rotation);
    PoseText { p: [t.x, t.y, t.z], q: [q.w, q.i, q.j, q.k] }.serialize(to)
}

/// Reads a pose, its numbers as they are.
///
/// # Errors
/// The deserializer's error, also for a quaternion whose norm differs from 1 by more than `TOL_NORM`.
pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Pose, D::Error> {
    let PoseText { p, q } = PoseText::deserialize(from)?;
    let q = Quaternion::new(q[0], q[1], q[2], q[3]);
    if (q.norm() - 1.0).abs() > TOL_NORM {
        return Err(D::Error::custom("a pose's quaternion `q` must be of unit length"));
    }
    let rotation = UnitQuaternion::new_unchecked(q);
    Ok(Pose::from_parts(Translation3::from(Vec3::from(p)), rotation))
}
