//! The tolerances with which docks and joints are told apart.

/// The cosine of the angle between the outward normals of two docks below which they face opposite ways.
pub(super) const COS_OPPOSITE: f64 = -0.999;
/// The sine of the angle between a joint's axis and the line between two docks above which the joint bends that line.
pub(super) const SIN_BENDS: f64 = 0.1;
/// Distances of docks that differ by less count as equal, m: a tenth of a millimetre.
pub(super) const TOL_DISTANCE: f64 = 1e-4;
/// The position of a joint below which it counts as straight, rad or m.
pub(super) const TOL_STRAIGHT: f64 = 1e-9;
