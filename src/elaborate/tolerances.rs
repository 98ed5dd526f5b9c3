//! The tolerances (thresholds) of elaboration, all in one file.

/// The tolerances with which declarations are elaborated. Lengths in metres, angles in radians.
pub(super) struct Tolerances {
    /// The distance below which nodes of a truss count as coincident, m.
    pub node_distance: f64,
    /// The length by which struts may be outside of their range, m: a rounding of what was meant.
    pub strut_length: f64,
    /// The difference between a turn of a bond and an allowed one, as a fraction of a whole turn, below which the
    /// turn counts as the allowed one: a rounding of `360deg / 4`.
    pub turn: f64,
    /// The distance by which loops of bonds may miss closing, m: rounding, not slack.
    pub closure_distance: f64,
    /// The angle by which loops of bonds may miss closing, rad: rounding, not slack.
    pub closure_angle: f64,
    /// The difference of distances to the centre of mass, m, below which centres are equally near to it where a base
    /// is chosen: symmetry is exact only in thought.
    pub tie_distance: f64,
    /// The relative difference of masses below which parts are equally heavy, where a base is chosen.
    pub tie_mass: f64,
    /// The distance of the base modules of two robots of a scene, m, below which they are at one place: a rounding of
    /// what was meant. Robots that only overlap are the judge's affair.
    pub one_place: f64,
    /// The sine of the angle between `up` and `facing` below which they leave a port's turn open.
    pub parallel: f64,
}

/// The values of the tolerances with which every declaration is elaborated.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    node_distance: 1e-9,
    strut_length: 1e-9,
    turn: 1e-9,
    closure_distance: 1e-6,
    closure_angle: 1e-6,
    tie_distance: 1e-9,
    tie_mass: 1e-9,
    one_place: 1e-9,
    parallel: 1e-6,
};
