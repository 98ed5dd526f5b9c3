//! A lower bound on the duration of any motion between two shapes of a lattice, whatever the path.

use crate::plan::stages::ratio::Ratio;

/// The greatest number of contacts for each cell if edges are at least half a cell long: nine on each of six sides,
/// each contact shared by two cells.
const CONTACTS: f64 = 27.0;

/// Returns the greatest sum, over all contacts of `count` cells, of the forces along an axis that change the moment of the
/// cells about a plane across it, where each is at most `force`. Docked contacts, of cells that do not `slide`, do that only
/// between cells in line along the axis, of which there are chains.
pub fn greatest_force_sum(count: usize, force: Ratio, slide: bool) -> f64 {
    let contacts = if slide { CONTACTS * count as f64 } else { count.saturating_sub(1) as f64 };
    contacts * force.to_f64()
}

/// Returns a duration, in time units, below which no motion takes the cells from one shape to the other while the
/// centre of mass stays; 0 if the shapes are the same but for a translation and there is no limit of force. `before`
/// and `after` give twice the centres of all cells along an axis (0 to 2), in any order, in grid lines; `lines` is
/// the number of grid lines to a cell; `speed_squared` is the square of the greatest difference of the speeds of cells in
/// contact, in cells a unit of time; `forces` is the [greatest sum](greatest_force_sum) of contact forces along an axis in units of a
/// cell's own, `None` if they are not limited.
///
/// Some cell must move at least as far along an axis as the farthest does if cells are matched in order, and to move
/// by `d` from rest to rest takes `2 √d`; for a row and a column `√(2 (n - 1))`. Contacts join all `n` cells, so the
/// speed of none differs from their mean, which is 0, by more than `c = v (n - 1) / 2`, and beyond `c²` it takes `c + d / c`. Contact forces
/// whose sum is at most `F`, between cells whose centres are at most 1 apart, change the rate of the moment `S = ½ Σ x²` by no
/// less than `-F` a unit of time: so `T² ≥ 2 |ΔS| / F`. The derivation is in `docs/planners/squeeze.md`.
pub fn lower_bound(
    before: impl Fn(usize) -> Vec<i64>,
    after: impl Fn(usize) -> Vec<i64>,
    lines: i64,
    speed_squared: Ratio,
    forces: Option<f64>,
) -> f64 {
    let (mut square, mut distance, mut greatest_speed) = (0.0_f64, 0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (mut before, mut after) = (before(axis), after(axis));
        if before == after {
            continue;
        }
        before.sort_unstable();
        after.sort_unstable();
        let count = before.len() as i128;
        let sum = |places: &[i64]| places.iter().map(|&x| i128::from(x)).sum::<i128>();
        let (start, end) = (sum(&before), sum(&after));
        // Times the number of cells, the position about the centre of mass is a whole number.
        let scale = 2.0 * lines as f64 * count as f64;
        let apart =
            |(&a, &b): (&i64, &i64)| ((i128::from(a) - i128::from(b)) * count - (start - end)).unsigned_abs();
        let farthest = before.iter().zip(&after).map(apart).max().unwrap_or(0);
        distance = distance.max(farthest as f64 / scale);
        greatest_speed = libm::sqrt(speed_squared.to_f64()) * (count - 1) as f64 / 2.0;
        if let Some(forces) = forces.filter(|sum| *sum > 0.0) {
            let about = |x: i64, sum: i128| (i128::from(x) * count - sum) as f64 / scale;
            let moment = |places: &[i64], sum: i128| {
                places.iter().map(|&x| about(x, sum) * about(x, sum)).sum::<f64>() / 2.0
            };
            let change = (moment(&before, start) - moment(&after, end)).abs();
            square = square.max(2.0 * change / forces);
        }
    }
    least_time(distance, greatest_speed).max(libm::sqrt(square))
}

/// Returns a duration, in time units, below which no motion takes cells from one shape to the other while others stand
/// fast; `before`, `after` and `lines` are those of [`lower_bound`], for the cells that may move. With the square of the
/// greatest difference of speeds, in cells a unit of time, goes the greatest number of contacts that a cell is away from
/// one that stands fast.
///
/// Nothing recoils, so displacements count as they are; and over `k` contacts from a cell at rest no speed is greater
/// than `k v`.
pub fn anchored_lower_bound(
    before: impl Fn(usize) -> Vec<i64>,
    after: impl Fn(usize) -> Vec<i64>,
    lines: i64,
    (speed_squared, contacts): (Ratio, u64),
) -> f64 {
    let mut farthest = 0;
    for axis in 0..3 {
        let (mut before, mut after) = (before(axis), after(axis));
        before.sort_unstable();
        after.sort_unstable();
        let apart = before.iter().zip(&after).map(|(a, b)| a.abs_diff(*b)).max();
        farthest = farthest.max(apart.unwrap_or(0));
    }
    let greatest_speed = libm::sqrt(speed_squared.to_f64()) * contacts as f64;
    least_time(farthest as f64 / (2.0 * lines as f64), greatest_speed)
}

/// Returns the least time, in time units, in which a cell gets from rest to rest at a distance (in cells), at an
/// acceleration of at most 1 and a greatest speed (in cells a unit of time); 0 for no distance.
fn least_time(distance: f64, greatest_speed: f64) -> f64 {
    let ramps = libm::sqrt(distance);
    if ramps <= greatest_speed { 2.0 * ramps } else { greatest_speed + distance / greatest_speed }
}
