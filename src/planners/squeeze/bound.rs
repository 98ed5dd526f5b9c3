//! What no motion can beat.

use super::shape::Shape;
use crate::plan::Ratio;

/// Contacts that a cell can have with sizes from a half on: nine on each of six sides, each shared.
const CONTACTS: f64 = 27.0;

/// A bound on the time, in units of time, below which no motion gets cells from one shape to the other,
/// whatever it does on the way. The centre of mass stays.
///
/// Some cell must go at least as far along an axis as cells matched in order do, at worst, and to go
/// `d` from rest to rest takes `2 √d` (section 4 (c) of the notes; for a row and a column
/// `√(2 (n - 1))`). With contact forces of at most `κ` the moment `S = ½ Σ x²` changes by at least
/// `-c n κ` a unit of time twice, for at most `c` contacts a cell whose centres are at most 1 apart: so
/// `T² ≥ 2 |ΔS| / (c n κ)`.
pub fn lower_bound(from: &Shape, to: &Shape, contact_force: Option<Ratio>) -> f64 {
    let count = from.count() as f64;
    let mut square = 0.0_f64;
    for axis in 0..3 {
        let (before, after) = (about_centre(from, axis), about_centre(to, axis));
        let farthest = before.iter().zip(&after).map(|(a, b)| (a - b).unsigned_abs()).max().unwrap_or(0);
        square = square.max(4.0 * farthest as f64 / count);
        if let Some(force) = contact_force {
            let moment =
                |places: &[i128]| places.iter().map(|x| (x * x) as f64).sum::<f64>() / 2.0 / count / count;
            let change = (moment(&before) - moment(&after)).abs();
            square = square.max(2.0 * change / (CONTACTS * count * force.to_f64()));
        }
    }
    libm::sqrt(square)
}

/// Places along an axis about the centre of mass, times the number of cells, in order.
fn about_centre(shape: &Shape, axis: usize) -> Vec<i128> {
    let sum: i128 = shape.places.iter().map(|p| i128::from(p[axis])).sum();
    let count = i128::from(shape.count());
    let mut places: Vec<i128> = shape.places.iter().map(|p| i128::from(p[axis]) * count - sum).collect();
    places.sort_unstable();
    places
}
