//! Tolerances and thresholds of the judgement of trusses.

/// Tolerances of the judgement of trusses. Lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerances {
    /// The excess of a strut's length over its range that is not a failure, m. Default 1e-9 m: rounding of the plan's
    /// coordinates.
    pub length: f64,
    /// The relative excess of a strut's rate over its limit that is not a failure. Default 1e-9: rounding of the
    /// plan's coordinates and times.
    pub rate: f64,
    /// The change of a strut's rate at once that is not a failure, m/s. Default 1e-9 m/s: rounding.
    pub jump: f64,
    /// The lack of an angle between two struts that is not a failure, rad. Default 1e-9 rad: rounding.
    pub angle: f64,
    /// The excess of a sum of lengths over its range that is not a failure, m. Default 1e-9 m: rounding.
    pub length_sum: f64,
    /// The lack of the least singular value of the rigidity matrix, as the plan's limit counts it, that is not a
    /// failure; without unit. Default 1e-7: that of its iteration.
    pub rigidity: f64,
    /// The least singular value of the rigidity matrix that a truss keeps if its plan states none, without unit. Default
    /// 0.05: a tenth of that of regular trusses of some dozens of struts, below which a load of one strut's weight turns
    /// into forces of twenty.
    pub rigidity_limit: f64,
    /// The part of the least singular value at the start that is the limit if that is less. Default an eighth: large
    /// trusses are soft by their size.
    pub rigidity_part: f64,
    /// The excess of a strut's force over its limit, as a part of it, that is not a failure. Default 1e-4: that of the
    /// linear program's solution.
    pub load: f64,
    /// The residual of equilibrium at a node, as a part of the whole weight, up to which forces are in equilibrium.
    /// Default 1e-4: what the solver reaches at worst, ten grams of a truss of 100 kg.
    pub balance: f64,
    /// The sum of squared sines below which the struts of a node lie in one plane. Default 1e-12: rounding.
    pub flat: f64,
    /// The lack of the clearance between two struts that is not a failure, m. Default 1e-9 m: rounding, since
    /// distances of segments are computed in closed form.
    pub strut_distance: f64,
    /// The length of the end of a strut at a node that is about to merge, or has just split, as a multiple of the clearance: so
    /// much of it may come near to the other node's ends. Default 2: struts that meet at more than 30 degrees are then a
    /// clearance apart beyond it.
    pub joint_reach: f64,
    /// The excess, m, by which nodes that are about to merge may part again on the way. Default 1e-9 m: rounding.
    pub approach: f64,
    /// The speed of nodes where some merge or split that counts as rest, m/s. Default 1e-9 m/s: rounding.
    pub rest: f64,
    /// The lack of the clearance between a strut and an obstacle that is not a failure, m. Default 2e-9 m: distances
    /// of convex parts are computed by iteration, whose error adds to the rounding.
    pub obstacle_distance: f64,
    /// The depth of a node below flat ground that is not a failure, m. Default 1e-9 m: rounding, since the lowest
    /// point is computed in closed form.
    pub flat_ground: f64,
    /// The depth of a node or strut below uneven ground, beyond what it may have, that is not a failure, m. Default
    /// 1e-6 m: the advancement over a height field then needs few samples.
    pub uneven_ground: f64,
    /// The height up to which a node bears weight, as a fraction of the mean strut length at the start. Default 1e-4:
    /// real trusses deflect.
    pub contact: f64,
    /// The distance of the centre of mass outside the support polygon at a sample that is not a failure, m; twice that
    /// between samples. Default 1e-5 m: the advancement then needs few samples.
    pub support_margin: f64,
    /// The width below which a support polygon counts as a line, m. Default 1e-6 m: rounding of coordinates.
    pub support_width: f64,
    /// The distance between a node after a rigid roll and where the plan has it that is not a failure, m. Default 1e-6
    /// m: the plan's angle and coordinates are rounded separately.
    pub roll: f64,
    /// The excess of the sum of what nodes slide over its limit that is not a failure, m. Default 1e-6 m: rounding.
    pub slip: f64,
    /// The difference between a margin that the plan states and the margin found that is not a failure, in the
    /// margin's unit (m, rad or none). Default 1e-7: rounding of the singular values of large trusses.
    pub stated_margin: f64,
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        Tolerances {
            length: 1e-9,
            rate: 1e-9,
            jump: 1e-9,
            angle: 1e-9,
            length_sum: 1e-9,
            rigidity: 1e-7,
            rigidity_limit: 0.05,
            rigidity_part: 0.125,
            load: 1e-4,
            balance: 1e-4,
            flat: 1e-12,
            strut_distance: 1e-9,
            joint_reach: 2.0,
            approach: 1e-9,
            rest: 1e-9,
            obstacle_distance: 2e-9,
            flat_ground: 1e-9,
            uneven_ground: 1e-6,
            contact: 1e-4,
            support_margin: 1e-5,
            support_width: 1e-6,
            roll: 1e-6,
            slip: 1e-6,
            stated_margin: 1e-7,
        }
    }
}
