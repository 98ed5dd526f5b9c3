//! Joints and motors with limits of speed and acceleration.

use super::Refusal;
use super::path::Stretch;
use crate::robot::{Assembly, Drive, drives};

/// Returns the drives (joints and motors) of a robot that state a limit of speed or acceleration.
pub(super) fn limited(robot: &Assembly) -> Vec<Drive> {
    let mut found = drives(robot);
    found.iter_mut().for_each(|drive| drive.limits.speed = drive.speed_limit());
    found.retain(|drive| drive.limits.speed.is_some() || drive.limits.acceleration.is_some());
    found
}

/// Checks that every joint that moves in a stretch states an acceleration limit, or is driven by a motor that does.
///
/// # Errors
/// [`Refusal::NoAcceleration`] for the first joint for which neither holds.
pub(super) fn check(stretch: &Stretch, robot: &Assembly, drives: &[Drive]) -> Result<(), Refusal> {
    for track in &stretch.path {
        let id = track.joint.0 as usize;
        let limited = |drive: &Drive| {
            drive.limits.acceleration.is_some()
                && drive.terms.iter().any(|&(joint, factor)| joint == id && factor != 0.0)
        };
        if !drives.iter().any(limited) {
            return Err(Refusal::NoAcceleration { joint: robot.name_of(track.joint), time: stretch.from });
        }
    }
    Ok(())
}
