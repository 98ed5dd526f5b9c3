//! Parameters of simulations: of contacts, bonds and stops, and of the method.

/// The parameters of contacts and bonds that modules do not state, and those of the time steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parameters {
    /// The damping of a contact, bond or stop of unit stiffness, s. 4 ms: a module of 0.5 kg comes down on such contacts
    /// without bouncing.
    pub contact_damping: f64,
    /// The stiffness of a bond that closes a loop against shifts, N/m. 1e6: ten times that of contacts, so that docked
    /// modules hang together.
    pub bond_stiffness: f64,
    /// The stiffness of such a bond against turns, N·m/rad: that against shifts at a lever of 0.1 m.
    pub bond_turn_stiffness: f64,
    /// The stiffness with which a joint that follows others does so, N·m/rad or N/m.
    pub follower_stiffness: f64,
    /// The stiffness of the stop at an end of the range of a joint that turns, N·m/rad: that of the judge.
    pub stop_stiffness: f64,
    /// The stiffness of the stop at an end of the range of a joint that slides, N/m: that of the judge, as of a stop that turns at a lever of
    /// 0.1 m.
    pub slide_stop_stiffness: f64,
    /// The greatest number of rounds in which a step finds which contacts stick, slide or part, and which motors are at
    /// their limits. 12: three or four suffice but where something hits.
    pub rounds_max: usize,
    /// The change of a contact's force, in parts of the weight, at which these rounds end. 1e-3: far below what the
    /// coefficients of friction are known to.
    pub force_change: f64,
    /// The time constant with which what is off when two ports dock is drawn in, s: 50 ms, that of a magnet or a latch.
    pub docking_time: f64,
    /// The depth from which on links begin inside each other, and not at each other, m. 1e-6: rounding of stated shapes.
    pub inside_depth: f64,
    /// The time for which the robot stands before the plan begins, s: what swings at first has come to rest.
    pub settle: f64,
    /// The time for which it stands after the plan has ended, s.
    pub rest: f64,
}

/// The parameters of every simulation.
pub(crate) const PARAMETERS: Parameters = Parameters {
    contact_damping: 4e-3,
    bond_stiffness: 1e6,
    bond_turn_stiffness: 1e4,
    follower_stiffness: 1e5,
    stop_stiffness: 1e3,
    slide_stop_stiffness: 1e5,
    rounds_max: 12,
    force_change: 1e-3,
    docking_time: 0.05,
    inside_depth: 1e-6,
    settle: 0.3,
    rest: 0.3,
};
