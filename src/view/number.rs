//! Numbers as they stand in a page: as exact as an eye can see, and no longer.

use crate::geometry::{Pose, Vec3};
use serde_json::{Value, json};

/// Steps of lengths (m), angles (rad), directions and times (s) in a page.
const STEP: f64 = 1e-7;

/// A number to the nearest step; 0 for what is none, which a page can't draw.
pub(super) fn short(x: f64) -> f64 {
    let rounded = libm::round(x / STEP) * STEP;
    // Once more through decimal, so that 0.1 is not 0.10000000000000002.
    let text = format!("{rounded:.7}");
    let number = text.parse().unwrap_or(0.0);
    if f64::is_finite(number) { number + 0.0 } else { 0.0 }
}

pub(super) fn list(numbers: impl IntoIterator<Item = f64>) -> Value {
    Value::Array(numbers.into_iter().map(number).collect())
}

/// A place on the ground, to a tenth of a millimetre.
pub(super) fn place(x: f64) -> f64 {
    libm::round(x * 1e4) / 1e4
}

/// Whole numbers are written without a fraction.
pub(super) fn number(x: f64) -> Value {
    let x = short(x);
    if x == libm::trunc(x) && x.abs() < 1e15 { json!(x as i64) } else { json!(x) }
}

pub(super) fn vector(v: &Vec3) -> Value {
    list([v.x, v.y, v.z])
}

/// x, y, z, w
pub(super) fn rotation(pose: &Pose) -> Value {
    let q = pose.rotation;
    list([q.i, q.j, q.k, q.w])
}
