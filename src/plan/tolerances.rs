//! The tolerances (thresholds) of plans, and those that all judges share. Each family of plans has its judge, with
//! tolerances of its own. In `geometry`, `optimize` and `robot` thresholds stand beside their algorithm, as `TOL_…`.

/// Tolerances of plans of all families; [`TOLERANCES`] has the values.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// The greatest difference of a joint's positions where two plans meet, rad or m: that of rounding, which cannot
    /// be seen.
    pub join_joint: f64,
    /// The greatest difference of a node's positions where two plans meet, m, along each axis: that of rounding,
    /// which cannot be seen.
    pub join_node: f64,
    /// The greatest distance of nodes of a truss that merge or are merged, m: that of rounding.
    pub meeting: f64,
    /// The greatest distance of a cut at the time t from the border of a stage, as a fraction of 1 s + t: that of
    /// rounding.
    pub stage_border: f64,
    /// The greatest jump of a joint between two segments, rad or m: that of rounding, where plans were joined.
    pub joint_jump: f64,
    /// The absolute value below which lengths (m), angles (rad) and fractions of a limit are reported as zero: that
    /// of rounding.
    pub reported_zero: f64,
    /// The width below which support polygons count as lines, m.
    pub polygon_width: f64,
    /// The part of a step's ramps by which they may overlap, without unit: that of rounding.
    pub ramp_overlap: f64,
    /// The fraction of the larger by which numbers of two libraries may differ and be equal: rounding on the way
    /// through other tools.
    pub equal_facts: f64,
}

/// The tolerances with which every plan is validated, changed and judged.
pub const TOLERANCES: Tolerances = Tolerances {
    join_joint: 1e-6,
    join_node: 1e-6,
    meeting: 1e-9,
    stage_border: 1e-9,
    joint_jump: 1e-9,
    reported_zero: 1e-9,
    polygon_width: 1e-6,
    ramp_overlap: 1e-6,
    equal_facts: 1e-9,
};
