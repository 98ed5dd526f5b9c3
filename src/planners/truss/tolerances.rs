//! Tolerances and thresholds of the truss planners.

/// Tolerances of the truss planners, each with its default and the reason for it. "Unit" stands for the
/// mean strut length at the start ([`Structure::unit`](super::Structure::unit)): lengths given in units
/// make the planners independent of the size of the truss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The value below 0, in units, from which a constraint counts as violated. Default 1e-10: far above the rounding
    /// of doubles, far below what the judge allows.
    pub rounding: f64,
    /// The margin added to the clearance (units) and to the least angle (rad) during planning, so that conservative
    /// advancement between the ends of a step ends after finitely many samples. Default 2e-4: two samples for most
    /// pairs, and nothing of the clearance lost that matters.
    pub clearance_margin: f64,
    /// The value, in units, that a row of the quadratic program asks a constraint to keep at first. Default 1e-6:
    /// above `qp_residual`, so that the solver's error violates nothing.
    pub bound_inset: f64,
    /// The factor by which a row that is violated again asks for more than the shortfall, and by which that factor grows each
    /// time; above 1, so that second-order terms are overtaken. Default 1.5: the livelock of Algorithm 1 of [Usevitch et al.](super)
    /// mostly ends in two or three rounds.
    pub row_gain: f64,
    /// The greatest multiple of a shortfall that a row asks for. Default 20: the eighth time, when the shortfall is small, or rows
    /// contradict each other.
    pub row_gain_max: f64,
    /// The value, in units, below which a constraint stays in the active set for the next step. Default 0.02: a
    /// little less than half a step.
    pub active_band: f64,
    /// The most that a row asks for at once because its value curved in the step before, units. Default 0.002: a tenth of
    /// `active_band`, and more than most values curve by.
    pub curvature_max: f64,
    /// The part of the limit on singular values of the rigidity matrix by which they are asked to rise where the way of a step is not
    /// proved to keep them above it, though none is below. Default 1e-3.
    pub unproved_part: f64,
    /// The residual of the rows that the quadratic program is solved to, units. Default 1e-9.
    pub qp_residual: f64,
    /// The least fraction of a shortened step by which a shortfall is divided to scale it to the whole step. Default
    /// 0.02: smaller fractions would ask for rows far beyond reach.
    pub step_fraction_min: f64,
    /// The sine of the angle between two struts below which they get a row for each end besides the one for their
    /// closest points, which jump from end to end. Default 0.1.
    pub parallel_sine: f64,
    /// The slack of a length, or sum of lengths, that has to stay, units: nodes move on straight lines, so a strut
    /// that turns gets shorter during the step. Default 2e-3.
    pub locked_slack: f64,
    /// The part of the depth to which struts may be below uneven ground that planners leave unused, units. Default
    /// 1e-4: the judge samples elsewhere.
    pub ground_margin: f64,
    /// The height above the ground, units, up to which nodes are contacts. Default 1e-4.
    pub contact_height: f64,
    /// The distance of the centre of mass inside the support polygon, units, above which the truss is statically
    /// stable. Default 1e-9.
    pub stability_margin: f64,
    /// The distance of the centre of mass outside the support polygon, units, that a step with sliding nodes may pass
    /// through between its ends. Default 1e-6: a tenth of what the judge lets pass of struts of a metre, and so much that
    /// short steps near an edge go on.
    pub stability_dip: f64,
    /// The least angle of a rotation, rad; a touchdown at a lesser one counts as a whole turn later. Default 1e-9.
    pub rotation_min: f64,
    /// The distance from the axis of a rotation, units, up to which a node does not move. Default 1e-9.
    pub on_axis: f64,
    /// The height above the ground, units, up to which a falling node has landed. Default 1e-11: far below
    /// `contact_height`, so that it counts as a contact.
    pub touchdown_tol: f64,
    /// The height above the ground, units, from which a node that started on it has left it. Default 2e-4: above
    /// `contact_height`.
    pub liftoff_height: f64,
    /// The part of the clearance from obstacles that may be missing during a roll, units. Default 1e-4: so that
    /// conservative advancement ends.
    pub roll_clearance_margin: f64,
    /// The distance beyond the plane of a face, units, up to which nodes lie on it; and six times the volume, cubic
    /// units, up to which tetrahedra are flat. Default 1e-6.
    pub coplanar: f64,
    /// The least singular value of the rigidity matrix up to which a truss is not rigid, without unit. Default 1e-7:
    /// rounding.
    pub not_rigid: f64,
    /// The part of a step before the edge of the support at which forces are found where it ends on that edge. Default
    /// 1e-3: they are the same to about as much.
    pub edge_part: f64,
    /// The least part of the accelerations of a step at which forces that hold the truss are looked for. Default 1e-3:
    /// just behind an edge of the support little more holds it.
    pub acceleration_part_min: f64,
    /// The greatest force, as a part of what a strut bears, up to which a step accelerates where forces are looked at: its ends
    /// and its middle. Default 0.998: between them they grow by a thousandth at most.
    pub strength_moving: f64,
    /// The step to which the least coefficient of friction that holds a truss is found, without unit. Default 1e-3: as
    /// much as a message tells.
    pub friction_step: f64,
    /// The greatest force of a strut, as a part of its limit, from which steps bring it down. Default 0.6: it
    /// seldom gets to the limit from there.
    pub force_near: f64,
    /// The descent of the greatest force of a strut, as a part of its limit, that stands in the cost of a step where
    /// forces are limited: units of displacement for a gradient of 1 per unit. Default 0.65: the median force of walks
    /// halves.
    pub force_descent: f64,
    /// The greatest displacement that this descent asks of a node, units. Default 0.015: a third of a step.
    pub force_descent_max: f64,
}

impl Tolerances {
    /// The default values, which the documentation of the fields gives.
    pub const DEFAULT: Tolerances = Tolerances {
        rounding: 1e-10,
        clearance_margin: 2e-4,
        bound_inset: 1e-6,
        row_gain: 1.5,
        row_gain_max: 20.0,
        active_band: 0.02,
        curvature_max: 2e-3,
        unproved_part: 1e-3,
        qp_residual: 1e-9,
        step_fraction_min: 0.02,
        parallel_sine: 0.1,
        locked_slack: 2e-3,
        ground_margin: 1e-4,
        contact_height: 1e-4,
        stability_margin: 1e-9,
        stability_dip: 1e-6,
        rotation_min: 1e-9,
        on_axis: 1e-9,
        touchdown_tol: 1e-11,
        liftoff_height: 2e-4,
        roll_clearance_margin: 1e-4,
        coplanar: 1e-6,
        not_rigid: 1e-7,
        edge_part: 1e-3,
        acceleration_part_min: 1e-3,
        strength_moving: 0.998,
        friction_step: 1e-3,
        force_near: 0.6,
        force_descent: 0.65,
        force_descent_max: 0.015,
    };
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        Tolerances::DEFAULT
    }
}
