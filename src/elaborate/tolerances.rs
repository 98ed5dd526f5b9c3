//! The tolerances (thresholds) of elaboration, all in one file.

/// The tolerances with which declarations are elaborated. Lengths in metres, angles in radians.
pub(super) struct Tolerances {
    /// Nodes of a truss nearer to each other than this count as coincident, m.
    pub node_distance: f64,
    /// Struts may be this much outside of their range, m: a rounding of what was meant.
    pub strut_length: f64,
    /// A turn of a bond within this of an allowed one, as a fraction of a whole turn, counts as that: a rounding of
    /// `360deg / 4`.
    pub turn: f64,
    /// Loops of bonds may miss closing by this much, m: rounding, not slack.
    pub closure_distance: f64,
    /// Loops of bonds may miss closing by this much, rad: rounding, not slack.
    pub closure_angle: f64,
    /// Centres nearer to each other than this, m, are equally near to the centre of mass, where a base is chosen:
    /// symmetry is exact only in thought.
    pub tie_distance: f64,
    /// Parts whose masses differ by less than this fraction of them are equally heavy, where a base is chosen.
    pub tie_mass: f64,
    /// `up` and `facing` nearer than this to one line leave a port's turn open (sine of the angle).
    pub parallel: f64,
}

/// The tolerances with which every declaration is elaborated.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    node_distance: 1e-9,
    strut_length: 1e-9,
    turn: 1e-9,
    closure_distance: 1e-6,
    closure_angle: 1e-6,
    tie_distance: 1e-9,
    tie_mass: 1e-9,
    parallel: 1e-6,
};
