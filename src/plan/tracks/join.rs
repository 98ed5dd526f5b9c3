//! Tracks one after the other.

use super::motion::Tracks;
use super::remap::Remap;
use crate::plan::operation_error::OperationError;
use crate::robot::matching;

/// The most by which joints may be apart where two plans meet, rad or m: what rounding explains and cannot be
/// seen.
pub const TOL_JOIN_JOINT: f64 = 1e-6;

/// Finds the robot that the second tracks start with in the one that the first end with. The causes of
/// the second come behind `causes` others.
///
/// # Errors
/// [`OperationError::Robots`] where it is another robot, or the same in another pose.
pub(in crate::plan) fn fitted(a: &Tracks, b: &Tracks, causes: u32) -> Result<Remap, OperationError> {
    let found = matching((&a.robot, &a.end()), (&b.robot, &b.start), TOL_JOIN_JOINT)
        .map_err(OperationError::Robots)?;
    Ok(Remap::new(a, b, &found, causes))
}
