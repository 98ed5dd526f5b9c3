//! Shear: a row to a column in one go. Along x the row shrinks to a point while along y it grows from
//! one, and the cells shrink to half their size and grow again. It meets the lower bound unless the
//! speed limit binds or accelerations are bounded in length, and needs a torque from outside.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use super::motion::{Builder, Motion, PlanLimits};

/// Returns the motion from a row of `count` cells along x, with cell `i` (from 0) at lattice site (i, 0, 0), to a
/// column along y with cell `i` at (0, i, 0). It takes √(2 (count - 1)) units of time ([`Motion`]), the
/// [`lower_bound`](crate::plan::lattice::lower_bound::lower_bound), unless the speed limit binds or `limits.euclidean`
/// is set; its angular momentum is not zero. The profile of `limits` is not used. Cells must be able to shrink to half
/// their size, which is not checked.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn shear(limits: PlanLimits, count: u64) -> Result<Motion, Refusal> {
    let all: Vec<Domain> = Domain::new(0, &[(count, 1)]).into_iter().collect();
    let mut builder = Builder::new(limits, count, &all, |i| CellState::whole([i as i64, 0, 0]))?;
    if count > 1 {
        let half = |i: u64| {
            let place = WHOLE / 2 * i as i64;
            CellState { center: [place, place, WHOLE / 2], size: [WHOLE / 2, WHOLE / 2, WHOLE] }
        };
        builder.two_phase_stage("shear", WHOLE, &all, half, |i| CellState::whole([0, i as i64, 0]))?;
    }
    Ok(builder.motion())
}
