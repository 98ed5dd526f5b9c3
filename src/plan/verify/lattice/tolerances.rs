//! Tolerances and thresholds of the judgement of lattices.

/// Tolerances of the judgement of lattices. Everything else is compared exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerances {
    /// The relative excess of the plan's units over what the library states of the cell. Default 1e-9: the units are
    /// products and quotients of the cell's properties, rounded to `f64`.
    pub units: f64,
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        Tolerances { units: 1e-9 }
    }
}
