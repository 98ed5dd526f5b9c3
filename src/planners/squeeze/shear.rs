//! Shear: a row to a column in one go. Along x the row shrinks to a point while along y it grows from
//! one, and the cells shrink to half their size and grow again. It meets the lower bound, and needs a
//! torque from outside.

use super::Refusal;
use super::domain::{Domain, Spot, WHOLE};
use super::way::{Builder, Terms, Way};

/// From a row along x, cell `i` at `i`, to a column along y.
pub fn shear(terms: Terms, count: u64) -> Result<Way, Refusal> {
    let all: Vec<Domain> = Domain::new(0, &[(count, 1)]).into_iter().collect();
    let mut builder = Builder::new(terms, count, &all, |i| Spot::whole([i as i64, 0, 0]))?;
    if count > 1 {
        let half = |i: u64| {
            let place = WHOLE / 2 * i as i64;
            Spot { center: [place, place, WHOLE / 2], size: [WHOLE / 2, WHOLE / 2, WHOLE] }
        };
        builder.twin_stages("shear", WHOLE, &all, half, |i| Spot::whole([0, i as i64, 0]))?;
    }
    Ok(builder.way())
}
