//! Retiming (time scaling of a trajectory): stages slowed down so that no contact carries more than its limit. The
//! geometry stays.

use super::Refusal;
use crate::plan::lattice::peak_forces;
use crate::plan::{Law, Ratio, Stages};

/// Slows stages down so that contact forces stay below the limit `force`, in units of force (those in which a cell's
/// limit is 1): forces fall with the square of time, so a stage whose greatest force is `f` takes `√(f / κ)` times as
/// long under the limit `κ`. Cells that do not `slide` hold each other by docked contacts. Two phases that pass their speed on are slowed down alike.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits, [`Refusal::Defect`] if the contact forces can't be computed.
pub(super) fn retime(stages: &mut Stages, force: Ratio, slide: bool) -> Result<(), Refusal> {
    let peaks = peak_forces(stages, slide).map_err(|fault| Refusal::Defect(fault.to_string()))?;
    let least: Vec<Ratio> = peaks
        .iter()
        .map(|peak| {
            let (distance, lines) = (peak.0, peak.1);
            Ratio::new(distance, lines)?.times(Ratio(force.1, force.0))
        })
        .collect::<Option<_>>()
        .ok_or(Refusal::TooLarge)?;
    // The factors by which the squares of the times must grow.
    let mut factors: Vec<Ratio> = least
        .iter()
        .zip(&stages.stages)
        .map(|(least, stage)| {
            let time = stage.time_squared;
            if least.order(time).is_le() { Some(Ratio::ONE) } else { least.times(Ratio(time.1, time.0)) }
        })
        .collect::<Option<_>>()
        .ok_or(Refusal::TooLarge)?;
    for i in 1..factors.len() {
        if matches!(stages.stages[i - 1].law, Law::SpeedUp(_)) {
            let most = if factors[i - 1].order(factors[i]).is_le() { factors[i] } else { factors[i - 1] };
            (factors[i - 1], factors[i]) = (most, most);
        }
    }
    for (stage, factor) in stages.stages.iter_mut().zip(factors) {
        stage.time_squared = stage.time_squared.times(factor).ok_or(Refusal::TooLarge)?;
    }
    Ok(())
}
