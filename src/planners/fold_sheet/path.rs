//! The way from flat to folded on which all loops stay closed, by continuation from the folded form.
//!
//! The flat sheet is a place where ways branch: from there the angles alone do not say which way a sheet goes. So the way
//! is followed backwards. From the folded form on, all angles shrink as fast as the loops let them: each step goes along
//! the part of the direction to flat that leaves the loops closed to first order, and Newton's method then closes them.

use super::loops::Loops;
use super::tolerances::TOLERANCES;
use nalgebra::{Cholesky, DMatrix, DVector};

/// The number of equal parts of the norm of the angles that the way is followed in.
const PARTS: usize = 192;

/// The number of these parts next to flat that are straight: there the angles of a way are in proportion to each other up
/// to the cube of their size.
const STRAIGHT_PARTS: usize = 3;

/// The most steps of Newton's method, and the most halvings of a step whose loops it does not close.
const NEWTON_MAX: usize = 12;
const HALVINGS_MAX: usize = 12;

/// The greatest change of all angles together in a step, rad.
const STEP_MAX: f64 = 0.2;

/// A way from flat to folded: the angles of all creases at parts of the way.
#[derive(Clone, Debug)]
pub struct Path {
    /// The places of the way in their order, the first flat, the last folded.
    pub places: Vec<Place>,
    /// The greatest rotation (rad) that is left over round a vertex at a place or half way between two.
    pub gap: f64,
    /// The number of angles that could be chosen freely at the folded form.
    pub freedom: usize,
}

/// A place of a way.
#[derive(Clone, Debug)]
pub struct Place {
    /// The norm of the angles as a part of that of the folded form, 0 to 1.
    pub part: f64,
    /// The angles of the creases, rad.
    pub angles: DVector<f64>,
    /// Their derivatives by `part`, rad.
    pub slopes: DVector<f64>,
}

/// The reason why no way was found: it ends before the sheet is flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuck {
    /// The norm of the angles where it ends, as a part of that of the folded form.
    pub part: f64,
}

/// Returns the way from flat to the folded form with these angles (rad), at which the loops are closed or nearly so.
///
/// # Errors
/// [`Stuck`] where it ends before.
pub fn from_flat(loops: &Loops, folded: &[f64]) -> Result<Path, Stuck> {
    let stuck = |part: f64| Stuck { part };
    let mut at = closed(loops, DVector::from_column_slice(folded)).ok_or(stuck(1.0))?;
    let whole = at.norm();
    let level =
        Place { part: 0.0, angles: DVector::zeros(folded.len()), slopes: DVector::zeros(folded.len()) };
    if whole == 0.0 {
        return Ok(Path {
            places: vec![level.clone(), Place { part: 1.0, ..level }],
            gap: 0.0,
            freedom: folded.len(),
        });
    }
    let freedom = freedom(&loops.jacobian(at.as_slice()));
    let mut places = Vec::with_capacity(PARTS);
    let mut goal = PARTS;
    loop {
        crate::interrupt::checkpoint();
        let part = at.norm() / whole;
        let free = free_part(&loops.jacobian(at.as_slice()), &at).ok_or(stuck(part))?;
        let gain = free.norm_squared() / at.norm_squared();
        if gain < TOLERANCES.gain {
            return Err(stuck(part));
        }
        // Along the way the norm grows by one part of the whole where the angles grow by this.
        let slopes = &free * (at.norm() * whole / free.norm_squared());
        places.push(Place { part, angles: at.clone(), slopes: slopes.clone() });
        if goal == STRAIGHT_PARTS {
            break;
        }
        goal -= 1;
        at = shrunk(loops, at, whole, goal as f64 / PARTS as f64).ok_or(stuck(part))?;
    }
    let last = places.last().expect("the folded form is a place");
    let slopes = &last.angles / last.part;
    places.push(Place { slopes, ..level });
    places.reverse();
    let half = |pair: &[Place]| loops.gap(between(&pair[0], &pair[1], 0.5).0.as_slice());
    let gap =
        places.windows(2).map(half).chain(places.iter().map(|place| loops.gap(place.angles.as_slice())));
    Ok(Path { gap: gap.fold(0.0, f64::max), places, freedom })
}

/// Returns the angles on the way from a place to the next one, at a part (0 to 1) of that, with their derivatives by
/// [`Place::part`]: the cubic with the angles and derivatives at both.
pub fn between(from: &Place, to: &Place, part: f64) -> (DVector<f64>, DVector<f64>) {
    let width = to.part - from.part;
    let (u, v) = (part, 1.0 - part);
    let angles = &from.angles * (v * v * (1.0 + 2.0 * u))
        + &to.angles * (u * u * (1.0 + 2.0 * v))
        + (&from.slopes * (u * v * v) - &to.slopes * (u * u * v)) * width;
    let slopes = (&to.angles - &from.angles) * (6.0 * u * v / width)
        + &from.slopes * (v * (v - 2.0 * u))
        + &to.slopes * (u * (u - 2.0 * v));
    (angles, slopes)
}

/// Follows the way until the norm of the angles is `part` of `whole`; `None` where it ends before.
fn shrunk(loops: &Loops, mut at: DVector<f64>, whole: f64, part: f64) -> Option<DVector<f64>> {
    // Newton's method changes the norm a little, so that a few steps may be needed.
    for _ in 0..PARTS {
        let left = at.norm() - part * whole;
        if left <= TOLERANCES.place * whole {
            return Some(at);
        }
        let free = free_part(&loops.jacobian(at.as_slice()), &at)?;
        if free.norm_squared() < TOLERANCES.gain * at.norm_squared() {
            return None;
        }
        let mut by = (left * at.norm() / free.norm_squared()).min(STEP_MAX / free.norm());
        let mut next = None;
        for _ in 0..HALVINGS_MAX {
            next = closed(loops, &at - &free * by).filter(|next| next.norm() < at.norm());
            if next.is_some() {
                break;
            }
            by /= 2.0;
        }
        at = next?;
    }
    None
}

/// Returns the part of a direction of the angles that leaves the loops closed to first order.
pub(super) fn free_part(jacobian: &DMatrix<f64>, direction: &DVector<f64>) -> Option<DVector<f64>> {
    let n = direction.len();
    let regular = jacobian.tr_mul(jacobian) + DMatrix::identity(n, n) * TOLERANCES.regular;
    let factor = Cholesky::new(regular)?;
    // The part that opens them is taken away; what rounding leaves of it is taken away again.
    let keep = |v: &DVector<f64>| v - factor.solve(&jacobian.tr_mul(&(jacobian * v)));
    Some(keep(&keep(direction)))
}

/// Returns the nearest angles at which the loops are closed, by Newton's method; `None` where it does not converge.
pub fn closed(loops: &Loops, mut angles: DVector<f64>) -> Option<DVector<f64>> {
    let n = angles.len();
    let gap = |angles: &DVector<f64>| loops.residuals(angles.as_slice());
    let mut left = gap(&angles);
    for _ in 0..NEWTON_MAX {
        if left.amax() < TOLERANCES.closed {
            return Some(angles);
        }
        let jacobian = loops.jacobian(angles.as_slice());
        let regular = jacobian.tr_mul(&jacobian) + DMatrix::identity(n, n) * TOLERANCES.regular;
        angles -= Cholesky::new(regular)?.solve(&jacobian.tr_mul(&left));
        left = gap(&angles);
    }
    (left.amax() < TOLERANCES.closed).then_some(angles)
}

/// Returns the number of directions that leave the loops closed to first order.
fn freedom(jacobian: &DMatrix<f64>) -> usize {
    let values = jacobian.tr_mul(jacobian).symmetric_eigenvalues();
    let greatest = values.max();
    values.iter().filter(|value| **value <= TOLERANCES.free * greatest).count()
}
