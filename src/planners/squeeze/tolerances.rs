//! The tolerances and thresholds of lattice planning, in which all else is computed in whole numbers.

/// The tolerances with which `squeeze` computes.
pub(super) struct Tolerances {
    /// The relative error to which limits are rounded, to the safe side, so that they are short rational numbers;
    /// without unit.
    pub limits: f64,
}

/// The values of the tolerances with which every plan of this planner is made.
pub(super) const TOLERANCES: Tolerances = Tolerances { limits: 1e-12 };
