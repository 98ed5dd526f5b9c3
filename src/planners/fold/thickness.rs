//! The fold angles that thick panels can close (Eq. 1 and 2).
//!
//! Two panels of thickness d on a hinge of radius r can't come nearer to each other than the angle ϑ
//! with `sin(ϑ/2) = (d/2)/r`: a hinge with a fold angle beyond π - ϑ does not close. (Eq. 2 forbids
//! angles below ϑ as well, but flat panels stand at 0, where every motion begins; so that half is
//! left out, and nothing is clamped.)

use super::layout::Layout;
use super::target::Target;
use super::tolerances::TOLERANCES;
use std::f64::consts::PI;

/// Returns the least dihedral angle (rad) to which two panels of a thickness (m) can close on a hinge of a radius (m),
/// where `sin(angle / 2) = thickness / 2 / radius` (Eq. 1 of [Yao et al.](super)); π, level, if the radius is at most
/// half the thickness.
pub fn least_opening(thickness: f64, radius: f64) -> f64 {
    2.0 * libm::asin((thickness / 2.0 / radius).clamp(0.0, 1.0))
}

/// Returns the faces of a layout whose hinges would have to close farther than to the angle `opening` (rad) between
/// the panels, as ascending indices in [`Target::faces`]: their absolute fold angle is greater than π - `opening` by
/// more than `TOLERANCES.closing`. `target`: the surface that the layout is of.
pub fn too_thick(target: &Target, layout: &Layout, opening: f64) -> Vec<usize> {
    let angle = |face: &usize| layout.hinge[*face].map_or(0.0, |hinge| target.hinges[hinge].angle.abs());
    (0..target.faces.len()).filter(|face| angle(face) > PI - opening + TOLERANCES.closing).collect()
}
