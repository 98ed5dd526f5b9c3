//! Tracks one after the other.

use super::motion::Tracks;
use super::remap::Remap;
use crate::plan::operation_error::OperationError;
use crate::plan::tolerances::TOLERANCES;
use crate::robot::matching;

/// Returns the map from the robot of `b`, in the state in which `b` starts, to the robot of `a`, in that in which `a`
/// ends; the causes of `b` are numbered from `causes` on.
///
/// # Errors
/// [`OperationError::Robots`] if the robots differ, or are the same in different poses.
pub(in crate::plan) fn fitted(a: &Tracks, b: &Tracks, causes: u32) -> Result<Remap, OperationError> {
    if a.obstacles != b.obstacles {
        return Err(OperationError::Surroundings);
    }
    let found = matching((&a.robot, &a.end()), (&b.robot, &b.start), TOLERANCES.join_joint)
        .map_err(OperationError::Robots)?;
    Ok(Remap::new(a, b, &found, causes))
}
