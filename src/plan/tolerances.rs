//! The tolerances of what a plan is, and of what all judges share. Each family of plans has its judge, with
//! tolerances of its own.

/// Tolerances of plans of all families.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// The most by which joints may be apart where two plans meet, rad or m: what rounding explains and no eye
    /// sees.
    pub join_joint: f64,
    /// The most by which nodes may be apart where two plans meet, m, along each axis: what rounding explains and
    /// no eye sees.
    pub join_node: f64,
    /// The greatest distance of a cut from the border of a stage, s, beside a time of 1 s: rounding.
    pub stage_border: f64,
    /// The most by which a joint may jump between two segments, rad or m: rounding, where plans were joined.
    pub joint_jump: f64,
    /// Lengths (m), angles (rad) and fractions of a limit below this are reported as zero: rounding.
    pub reported_zero: f64,
    /// Hulls of contacts narrower than this are lines, m.
    pub polygon_width: f64,
    /// Numbers of two libraries that differ by less than this part are equal: rounding on the way through other
    /// tools.
    pub equal_facts: f64,
}

/// The tolerances with which every plan is validated, changed and judged.
pub const TOLERANCES: Tolerances = Tolerances {
    join_joint: 1e-6,
    join_node: 1e-6,
    stage_border: 1e-9,
    joint_jump: 1e-9,
    reported_zero: 1e-9,
    polygon_width: 1e-6,
    equal_facts: 1e-9,
};
