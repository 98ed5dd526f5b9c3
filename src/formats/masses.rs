//! Masses as simulators take them: positive, and of a body that can exist.

use crate::robot::Link;
use nalgebra::Matrix3;

/// The least mass of a body, kg: MuJoCo moves none without.
pub(crate) const MASS_MIN: f64 = 1e-9;
/// The least moment of inertia of a body, kg·m².
const INERTIA_MIN: f64 = 1e-12;
/// The part of a moment of inertia by which it stays below the sum of the other two: MuJoCo computes them again.
const ROUNDING: f64 = 1e-12;

/// Returns the inertia of a link (kg·m²: xx, yy, zz, xy, xz, yz), as [`sound`] makes it.
pub(crate) fn sound_inertia(link: &Link) -> [f64; 6] {
    sound(link.inertia)
}

/// Returns an inertia (kg·m²: xx, yy, zz, xy, xz, yz), made larger by a multiple of the unit matrix where no body has it:
/// its moments must be positive, and none may exceed the sum of the other two.
pub(crate) fn sound([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [f64; 6] {
    let mut moments: [f64; 3] =
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [least, middle, most] = moments;
    let missing = most * (1.0 + ROUNDING) - middle - least;
    let more = missing.max(INERTIA_MIN - least).max(0.0);
    [xx + more, yy + more, zz + more, xy, xz, yz]
}
