//! Parameters of the dynamics of the judge: of contacts and servos, and of the methods that find forces.

/// The parameters of the model with which forces are determined, with the reasons of their values, and those of the
/// methods that determine them. The stiffnesses matter less than that there are some: static torques of the robots
/// tried changed by under 2 % in half of the plans, at most 20 %, for servos of 40 to 600 N·m/rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parameters {
    /// The length of the window over which velocities, accelerations and loads are means, s. 50 ms: the yielding of
    /// servos takes up what is shorter.
    pub window: f64,
    /// The shortest window, s. 1 ms: the step of a servo's own control.
    pub window_min: f64,
    /// The least duration of a motion in windows; a shorter one gets a window of its own, its duration divided by this
    /// number. 4: the acceleration of a smooth motion is then within a few percent.
    pub burst_windows: f64,
    /// The number of intervals into which such a short motion is divided by instants at which loads are determined. 8:
    /// two in each of its quarters.
    pub burst_instants: u32,
    /// The speed below which a joint is at rest between two motions, and its greatest jump that counts as none, rad/s
    /// or m/s. 1e-6: rounding of control points.
    pub rest_speed: f64,
    /// The least time between two instants at which forces are determined, s. 10 ms, less rounding.
    pub spacing_least: f64,
    /// The greatest height of a candidate for contact above the lowest point of the robot, m. 2.5 mm: what the servos'
    /// sag can close.
    pub gap_max: f64,
    /// The greatest height above the lowest point of the robot at which a link that bears nothing is about to, m. 0.3 mm: as far as
    /// servos and contacts yield.
    pub idle_gap: f64,
    /// The least distance of two candidates of one link, m. 2.5 mm: closer ones bear as one.
    pub candidate_distance: f64,
    /// The speed below which friction is viscous rather than Coulomb's, m/s. 1 mm/s: below any travel that counts.
    pub slip_speed: f64,
    /// The weight of a contact's velocity along the normal, relative to that of its slip, in the twist that friction
    /// balances, without unit. 30: contacts neither sink nor lift.
    pub normal_weight: f64,
    /// The damping that keeps the twist unique, in parts of the weight, s/m. 1e-5: far below any friction.
    pub regularization: f64,
    /// The greatest part of the friction that the planar force that a motion needs may use up. 0.97: beyond, the slip
    /// has no bound.
    pub traction_max: f64,
    /// The stiffness of a joint without a motor against its planned position, N·m/rad or N/m: it bears nothing, but its
    /// position is planned; 1e-2, far below that of servos.
    pub passive_stiffness: f64,
    /// The stiffness of a contact, N/m: 1e5, stiffer than the servos.
    pub contact_stiffness: f64,
    /// The stiffness of a bond that closes a loop against shifts, N/m: that of a contact.
    pub bond_stiffness: f64,
    /// The stiffness of a bond that closes a loop against turns, N·m/rad: that of contacts at a lever of 0.1 m.
    pub bond_turn_stiffness: f64,
    /// The stiffness of the stop at an end of the range of a joint that turns, N·m/rad: that of a bond against turns.
    pub stop_stiffness: f64,
    /// The stiffness of the stop at an end of the range of a joint that slides, N/m: that of a contact, as of a stop that turns at a lever of
    /// 0.1 m.
    pub slide_stop_stiffness: f64,
    /// The distance from an end of its range at which a joint may come to rest on its stop, rad or m. 0.05: more than
    /// servos yield.
    pub stop_gap_max: f64,
    /// The factor on a contact's softness with which an imbalance of the base is penalized, without unit. 1e6: stiffer
    /// than any servo at any lever of a robot, so that balance is not given up for less effort.
    pub balance_weight: f64,
    /// The change of the twist from one round of reweighted least squares to the next at which the rounds end, m/s or
    /// rad/s: 1e-6.
    pub twist_change: f64,
    /// The greatest number of rounds of reweighted least squares for the twist.
    pub twist_rounds_max: usize,
    /// The sum of the changes of all normal forces, in parts of the weight, at which the rounds of twist and loads end.
    pub load_change: f64,
    /// The part of the weight that the last normal forces must add up to if they are the guess of the next ones.
    pub load_guess_min: f64,
    /// The gap below which a contact just touches, m or rad. 1e-12: rounding of displacements.
    pub touching: f64,
    /// The greatest number of rounds of Newton's method for the contacts and stops that push. 200: some ten suffice for
    /// the robots tried.
    pub contact_rounds_max: usize,
    /// The greatest number of rounds of the fixed-point iteration of twist and loads.
    pub rounds_max: usize,
    /// The factor by which the relaxation of the normal forces, 1 at first, falls from round to round.
    pub relaxation: f64,
    /// The least relaxation of the normal forces.
    pub relaxation_min: f64,
    /// The least and the greatest time over which friction acts on planar momentum before the twist is determined anew,
    /// s: from about the spacing of instants on.
    pub momentum_step: [f64; 2],
    /// The speed above which a part that came off in motion slides on with its joints at rest, m/s, to which turning counts
    /// with one metre for a radian: a tenth of the one below which friction is viscous.
    pub coasting_speed: f64,
    /// The least size of a robot, by which moments are compared with forces, m.
    pub size_min: f64,
    /// The speed from which on a contact counts as sliding, m/s: five times the one below which friction is viscous.
    pub sliding_speed: f64,
    /// The factor on the friction of contacts that slide, in the variation of friction.
    pub friction_more: f64,
    /// The factor on the friction of the other contacts in that variation.
    pub friction_less: f64,
    /// The least time between two instants at which the travel with other servos is determined, s. 30 ms: three times
    /// the spacing of instants, for they take two more equilibria.
    pub variation_spacing: f64,
    /// The factor on the stiffness of servos in the variation with softer ones. 0.4: 60 N·m/rad for the default of 150.
    pub servo_softer: f64,
    /// The factor on the stiffness of servos in the variation with stiffer ones. 3.3: about 500 N·m/rad for the default
    /// of 150.
    pub servo_stiffer: f64,
    /// The error of the greatest torque against simulations, as a fraction: 0.1, where nothing touches down.
    pub load_error: f64,
    /// The part of the weight from which on a link bears: 0.02, as that which may stay unbalanced.
    pub bearing_min: f64,
    /// The part of its stiffness that a servo keeps at the limit of its motor, so that what gives way comes to rest:
    /// 1/750, 0.2 N·m/rad of 150.
    pub yielding_share: f64,
    /// The sag of a joint up to which `allows saturation` excuses an overload, rad or m: 5°.
    pub sag_allowed: f64,
    /// The greatest deflection of a joint that counts as yielding, rad or m: 20°. Beyond, the robot gives way, and
    /// linear springs say nothing of where its links are.
    pub deflection_max: f64,
    /// The part of the distance travelled by which its end may differ under a variation of friction or servos before it
    /// counts as not determined.
    pub travel_undetermined: f64,
    /// The difference of the ends up to which it counts as determined, m. 15 mm: as far as contacts that scrub take
    /// robots in simulations elsewhere.
    pub travel_undetermined_min: f64,
    /// The part of the distance travelled by which its end may differ under a variation before that is noted.
    pub travel_uncertain: f64,
    /// The difference of the ends up to which it is neither noted nor a failure, m: 1 cm.
    pub travel_uncertain_min: f64,
    /// The part of the distance travelled, and of the turn, within which it is known: 0.1, as simulations of random gaits show.
    pub travel_share: f64,
    /// The part of the greatest slip of a link within which the distance travelled is known: 0.25, as those show.
    pub slip_share: f64,
    /// The part of the greatest slip of a link from which on motions in time find the travel. 0.3: a fifth more than the part within
    /// which that of the rollout is known, as snakes show whose travel is a third of their slip off.
    pub timed_slip_share: f64,
    /// The least tolerance of the travel, m: 5 mm.
    pub travel_tolerance_min: f64,
    /// The least tolerance of the turn, rad: 3°.
    pub turn_tolerance_min: f64,
    /// The part of its travel, and of its turn, within which these are known of a robot that tips: see `tests/dynamics/falls.rs`.
    pub tip_share: f64,
    /// The distance within which the travel of a robot that tips is known at best, m.
    pub tip_tolerance_min: f64,
    /// The angle within which the turn of a robot that tips is known at best, rad.
    pub tip_turn_tolerance_min: f64,
    /// The part of the weight on links that rest below which the slip of the others makes the travel uncertain: 0.3, of
    /// which the friction is as much as dragging links may gain or lose as they chatter.
    pub rest_share: f64,
    /// The speed of a joint from which on the link that it moves rolls, and does not rest, rad/s or m/s.
    pub rolling_speed: f64,
    /// The time step of motions in time, s. 1 ms: half of it changes the travel of robots that scrub by under 1 mm.
    pub timed_step: f64,
    /// The part of a step by which a time may be longer than a number of them: rounding.
    pub timed_count: f64,
    /// The greatest number of steps of a motion in time, times the number of links: 8e6, some seconds.
    pub timed_steps_max: f64,
    /// The speed at which the centre of mass of a robot sinks that falls, m/s: as in simulations.
    pub timed_fall: f64,
    /// The factor on friction of the world beyond which feet may wedge, without unit: 1.25, the greatest with which rollouts are
    /// compared with simulations.
    pub friction_rough: f64,
    /// The greatest angle by which a base may lean in such a motion away from where settling places it, rad: 10 degrees, so
    /// that another simulation, which leans by up to a sixth more, stays within 12.
    pub timed_lean: f64,
    /// The part of the half distance between the ends of motions in time within which the travel is known. 1.25: other
    /// simulations spread a little more.
    pub timed_spread: f64,
    /// The factor by which contacts of motions in time are stiffer or softer, to find if the travel depends on how links share
    /// the weight, and by which they are stiffer with stiffer servos: 4, as for surfaces some 0.1 mm apart.
    pub timed_sharing: f64,
    /// The factor on the damping of contacts on which a robot bounces: 0.1, that of simulations elsewhere.
    pub timed_bounce: f64,
    /// The error of each of these ends, m: 1 mm.
    pub timed_error: f64,
    /// The error of each of these turns, rad: half a degree.
    pub timed_turn_error: f64,
    /// The greatest mean imbalance of the base over a window, in parts of the weight, at which its loads hold the
    /// robot: 2 %.
    pub imbalance_max: f64,
    /// The longest time for which the ground may leave a robot unbalanced that stays upright in motions in time, s: 0.12 s. Random gaits
    /// with up to 0.1 s were compared with simulations.
    pub unbalanced_time: f64,
    /// The time for which loads may make a base lean by more than `timed_lean` before motion in time has to tell how far it does, s:
    /// 0.1 s, in which it falls by little.
    pub lean_time: f64,
}

/// The parameters of every judgement.
pub(super) const PARAMETERS: Parameters = Parameters {
    window: 0.05,
    window_min: 1e-3,
    burst_windows: 4.0,
    burst_instants: 8,
    rest_speed: 1e-6,
    spacing_least: 0.01 - 1e-6,
    gap_max: 2.5e-3,
    idle_gap: 3e-4,
    candidate_distance: 2.5e-3,
    slip_speed: 1e-3,
    normal_weight: 30.0,
    regularization: 1e-5,
    traction_max: 0.97,
    passive_stiffness: 1e-2,
    contact_stiffness: 1e5,
    bond_stiffness: 1e5,
    bond_turn_stiffness: 1e3,
    stop_stiffness: 1e3,
    slide_stop_stiffness: 1e5,
    stop_gap_max: 0.05,
    balance_weight: 1e6,
    twist_change: 1e-6,
    twist_rounds_max: 80,
    load_change: 5e-3,
    load_guess_min: 0.5,
    touching: 1e-12,
    contact_rounds_max: 200,
    rounds_max: 12,
    relaxation: 0.85,
    relaxation_min: 0.1,
    momentum_step: [0.01, 0.015],
    coasting_speed: 1e-4,
    size_min: 0.05,
    sliding_speed: 5e-3,
    friction_more: 1.25,
    friction_less: 0.8,
    variation_spacing: 0.03 - 1e-6,
    servo_softer: 0.4,
    servo_stiffer: 3.3,
    load_error: 0.1,
    bearing_min: 0.02,
    yielding_share: 1.0 / 750.0,
    sag_allowed: 0.0873,
    deflection_max: std::f64::consts::PI / 9.0,
    travel_undetermined: 0.5,
    travel_undetermined_min: 0.015,
    travel_uncertain: 0.1,
    travel_uncertain_min: 0.01,
    travel_share: 0.1,
    slip_share: 0.25,
    timed_slip_share: 0.3,
    travel_tolerance_min: 5e-3,
    turn_tolerance_min: std::f64::consts::PI / 60.0,
    tip_share: 0.35,
    tip_tolerance_min: 0.01,
    tip_turn_tolerance_min: std::f64::consts::PI / 18.0,
    rest_share: 0.3,
    rolling_speed: 0.05,
    timed_step: 1e-3,
    timed_count: 1e-9,
    timed_steps_max: 8e6,
    timed_fall: 0.5,
    friction_rough: 1.25,
    timed_lean: std::f64::consts::PI / 18.0,
    timed_spread: 1.25,
    timed_sharing: 4.0,
    timed_bounce: 0.1,
    timed_error: 1e-3,
    timed_turn_error: std::f64::consts::PI / 360.0,
    imbalance_max: 0.02,
    unbalanced_time: 0.12,
    lean_time: 0.1,
};
