//! The tolerances of paths in the plane.

/// The tolerances with which paths are planned.
pub(super) struct Tolerances {
    /// The depth inside of an outline up to which a point counts as outside, m: rounding, so that paths run along
    /// edges.
    pub depth: f64,
    /// Twice the area of a triangle of corners, as a part of the product of two of its edges, below which the three
    /// count as in one line: rounding.
    pub straight: f64,
}

/// The values of the tolerances, the same in every call.
pub(super) const TOLERANCES: Tolerances = Tolerances { depth: 1e-9, straight: 1e-12 };
