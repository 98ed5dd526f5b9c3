//! The tolerances of motions by goals.

/// The tolerances with which postures and ways are searched for.
pub(super) struct Tolerances {
    /// The motion of two bodies against each other, m, below which a way is not halved any more: ways that keep a
    /// clearance of twice that are proved to.
    pub step: f64,
    /// The same for two links of one module, or of two that are docked to each other, m.
    pub joined_step: f64,
    /// The greatest distance that links of one module, or of two that are docked, keep, m: they are near by design.
    pub near_clearance: f64,
    /// The greatest change of a joint in one step of the secondary tasks, rad or m.
    pub secondary_step: f64,
    /// The change of a joint by which gradients of the secondary tasks are measured, rad or m.
    pub slope_step: f64,
    /// The way of the centre of mass, m, that weighs as much as bodies that touch.
    pub balance: f64,
    /// The cost of the secondary tasks, without unit, below which there is nothing left to gain.
    pub cost: f64,
    /// A distance by which bodies may be nearer than what they keep, m: rounding.
    pub rounding: f64,
    /// The height of a link's lowest point, m, below which it counts as standing on the ground.
    pub stands: f64,
    /// The least lever of a joint, m per rad: of one that moves nothing that could meet anything.
    pub lever: f64,
    /// The travel of a slide without a range, m.
    pub travel: f64,
    /// The depth to which ports explain an overlap of their links where the connector states no capture, m.
    pub closure: f64,
}

/// The values of the tolerances, the same in every call.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    step: 2.5e-4,
    joined_step: 4e-3,
    near_clearance: 2e-4,
    secondary_step: 0.1,
    slope_step: 1e-4,
    balance: 0.05,
    cost: 1e-6,
    rounding: 1e-9,
    stands: 2e-3,
    lever: 1e-2,
    travel: 1.0,
    closure: 1e-3,
};
