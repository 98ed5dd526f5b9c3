//! Numbers in a page, rounded to what is visible.

use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Vec3};
use serde_json::{Value, json};

/// Rounds a number to the nearest multiple of `TOLERANCES.rounding`; returns 0 for NaN and infinities, which JSON
/// cannot hold.
pub(super) fn short(x: f64) -> f64 {
    let rounded = libm::round(x / TOLERANCES.rounding) * TOLERANCES.rounding;
    // Parsed from decimal text, so that 0.1 is not 0.10000000000000002.
    let text = format!("{rounded:.7}");
    let number = text.parse().unwrap_or(0.0);
    if f64::is_finite(number) { number + 0.0 } else { 0.0 }
}

/// Returns the numbers as a JSON list, each rounded as [`number`] does.
pub(super) fn list(numbers: impl IntoIterator<Item = f64>) -> Value {
    Value::Array(numbers.into_iter().map(number).collect())
}

/// Rounds a coordinate on the ground (m) to a tenth of a millimetre.
pub(super) fn place(x: f64) -> f64 {
    libm::round(x * 1e4) / 1e4
}

/// Returns a number as JSON, rounded by [`short`]; whole numbers without a fraction.
pub(super) fn number(x: f64) -> Value {
    let x = short(x);
    if x == libm::trunc(x) && x.abs() < 1e15 { json!(x as i64) } else { json!(x) }
}

/// Returns a vector as the JSON list `[x, y, z]`, rounded by [`short`].
pub(super) fn vector(v: &Vec3) -> Value {
    list([v.x, v.y, v.z])
}

/// Returns the rotation of a pose as JSON, the unit quaternion `[x, y, z, w]`, rounded by [`short`].
pub(super) fn rotation(pose: &Pose) -> Value {
    let q = pose.rotation;
    list([q.i, q.j, q.k, q.w])
}
