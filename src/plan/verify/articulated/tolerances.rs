//! Tolerances and thresholds of the judgement of articulated robots.

/// Tolerances of the judgement of collisions: how deep, exact and early a penetration is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// The depth beyond `touch` up to which penetration is not excluded, m: it is proved to be no deeper. Default 1
    /// µm: far below any `touch`, well above rounding.
    pub tol_depth: f64,
    /// The greatest error of the clearance, and of the depth of a collision, m. Default 20 µm: halving it costs √2
    /// times as many intervals.
    pub tol_clearance: f64,
    /// The greatest time from the begin of a first penetration (by more than `touch` and `tol_depth`) to that at
    /// which it is found, s. Default 1 µs: below a tick of any controller.
    pub tol_time: f64,
}

impl Precision {
    /// The least length to which intervals are halved in a search for collisions along deflected joints, s. 5 ms:
    /// half of the spacing of the instants of full dynamics.
    pub(super) const DEFLECTED_TIME_MIN: f64 = 5e-3;
}

impl Default for Precision {
    fn default() -> Precision {
        Precision { tol_depth: 1e-6, tol_clearance: 2e-5, tol_time: 1e-6 }
    }
}

/// The tolerances of the judgement of articulated robots. Lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The part of the greatest deviation that a path states, without unit, by which a bound on the deviation may exceed it: below
    /// that nothing is halved any more. Default 1e-3.
    pub path_part: f64,
    /// The predicted fall of the centre of mass below which settling ends, m. Default 1e-9 m: rounding of
    /// coordinates.
    pub fall_min: f64,
    /// The fall up to which a change between rest attitudes counts as no tip-over, m. Default 1 mm: the usual contact
    /// tolerance.
    pub fall_floor: f64,
    /// The gap up to which a contact point bears weight, m. Default 1 mm: real contacts yield.
    pub gap_loaded: f64,
    /// The least stiffness of the ground under a contact point, as a fraction of that without a gap. Default 1e-3:
    /// the distribution of normal forces stays unique.
    pub stiffness_min: f64,
    /// The normal force, as a fraction of the weight, below which a contact point does not steer the guess of the
    /// next attitude. Default 1e-6: rounding of the distribution.
    pub load_min: f64,
    /// The gap up to which a contact point belongs to the exact support polygon, m. Default 10 µm.
    pub gap_exact: f64,
    /// The gap up to which contact points keep a robot from being perturbed, m. Default 0.1 µm.
    pub gap_standing: f64,
    /// The stability margin above which a robot is not perturbed, m. Default 1e-9 m: rounding.
    pub inside_min: f64,
    /// The angle of the perturbation that leaves an unstable equilibrium, rad. Default 1e-3 rad.
    pub perturbation: f64,
    /// The fall that a perturbation must show, m. Default 2e-8 m: well above rounding.
    pub perturbation_fall: f64,
    /// The distance of the centre of mass outside the support polygon up to which a robot counts as stable, m.
    /// Default 1e-9 m: rounding.
    pub margin: f64,
    /// The height above the lowest module centre up to which a centre counts as lowest, for the rule of module
    /// centres, m. Default 1 mm.
    pub centres: f64,
    /// The angle by which the base of a robot leans that has tipped, rad. Default 10°: less comes of feet that a gait lifts.
    pub tipped: f64,
    /// The greatest turn of a joint between two samples, rad. Default 5°: attitudes are then followed reliably.
    pub turn_sample: f64,
    /// The greatest motion of a point between two samples, m; where it is greater the step is halved. Default 2 cm.
    pub motion_sample: f64,
    /// The part of a sample by which an interval may be longer than a whole number of samples. Default 1e-6: rounding
    /// of times.
    pub sample_count: f64,
    /// The relative excess over a limit of range, speed or acceleration that is not a failure. Default 1e-9: rounding
    /// of the plan's numbers.
    pub limit: f64,
    /// The jump of a speed that counts as none, rad/s or m/s. Default 1e-6: rounding of control points over short
    /// segments.
    pub speed_jump: f64,
    /// The speed of a base below which a robot counts as at rest as it comes apart, m/s. Default 1e-3: what docking at
    /// rest allows.
    pub rest_speed: f64,
    /// The difference of distances up to which two modules are equally near a point, m. Default 1e-9: rounding alone.
    pub nearest: f64,
    /// The jump of a rate below which a motion bound takes a rate as continuous, rad/s or m/s. Default 1e-9: a jump
    /// that is ignored is not bounded.
    pub rate_jump: f64,
    /// The distance by which loops may be open, where the connector states no capture, m. Default 1 mm.
    pub closure_distance: f64,
    /// The angle by which loops may be open, where the connector states no capture, rad. Default 1°.
    pub closure_angle: f64,
    /// The greatest speed of a port against the one that it docks with, of another robot, m/s. Default 1 mm/s: at rest, less
    /// what finite differences of a rollout leave.
    pub dock_speed: f64,
    /// The greatest angular speed of such a port, rad/s. Default 1°/s.
    pub dock_rate: f64,
    /// The part of the trace of an inertia that is added to it where a robot floats, without unit. Default 1e-12: a line of
    /// masses, which can't be turned about itself, is not.
    pub inertia_ridge: f64,
    /// The step by which such speeds are found just before a docking, s. Default 0.1 ms: within it nothing changes its speed
    /// that can be seen.
    pub dock_step: f64,
    /// The greatest way of a point between two places at which a cluster is looked at as it snaps to another, m. Default
    /// 0.5 mm.
    pub snap_step: f64,
    /// The steps to which the spread of a docking is rounded up, m and rad. Default 0.1 mm and 0.1°.
    pub spread_step: [f64; 2],
    /// The time before a docking at which the speed of a robot is compared with that at docking, s. Default 50 ms, the
    /// length of the windows over which full dynamics take means of velocities.
    pub braking_time: f64,
    /// The fraction of its speed before that a robot whose joints have come to rest may seem to have left. Default 0.25: means
    /// over a window lag behind.
    pub braked: f64,
    /// The part of the weight below which slip of a link is not counted. Default 0.05.
    pub slip_load: f64,
    /// The slip from which on an exemption for slip is needed, m. Default 1 mm.
    pub slip: f64,
    /// The precision of the time of a tip-over, s. Default 1e-9 s.
    pub time: f64,
    /// The greatest imbalance of contact forces, in parts of the weight (and of the weight times a metre). Default
    /// 1e-6: precision of the LP solver.
    pub balance: f64,
    /// The excess of a gravity load over its limit with a fixed base that is not a failure, as a fraction of the
    /// limit. Default 1e-9: rounding.
    pub load: f64,
    /// The length of an interval below which loads with a fixed base are not decided further, s. Default 10 µs.
    pub load_interval: f64,
    /// The distance within which a part counts as round about a joint's axis, m. Default 1e-9 m: rounding of poses.
    pub roundness: f64,
    /// The depth beyond what is allowed up to which links that meet as servos yield are not a failure, m. Default 1
    /// mm: the usual contact tolerance; grazing contacts push joints back that yield anyway.
    pub deflected_depth: f64,
    /// The tolerances of the check of collisions.
    pub collision: Precision,
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        let degree = std::f64::consts::PI / 180.0;
        Tolerances {
            path_part: 1e-3,
            fall_min: 1e-9,
            fall_floor: 1e-3,
            deflected_depth: 1e-3,
            gap_loaded: 1e-3,
            stiffness_min: 1e-3,
            load_min: 1e-6,
            gap_exact: 1e-5,
            gap_standing: 1e-7,
            inside_min: 1e-9,
            perturbation: 1e-3,
            perturbation_fall: 2e-8,
            margin: 1e-9,
            centres: 1e-3,
            tipped: 10.0 * degree,
            turn_sample: 5.0 * degree,
            motion_sample: 0.02,
            sample_count: 1e-6,
            limit: 1e-9,
            speed_jump: 1e-6,
            rest_speed: 1e-3,
            nearest: 1e-9,
            rate_jump: 1e-9,
            closure_distance: 1e-3,
            closure_angle: degree,
            dock_speed: 1e-3,
            dock_rate: degree,
            inertia_ridge: 1e-12,
            dock_step: 1e-4,
            snap_step: 5e-4,
            spread_step: [1e-4, degree / 10.0],
            braking_time: 0.05,
            braked: 0.25,
            slip_load: 0.05,
            slip: 1e-3,
            time: 1e-9,
            balance: 1e-6,
            load: 1e-9,
            load_interval: 1e-5,
            roundness: 1e-9,
            collision: Precision::default(),
        }
    }
}

/// Thresholds of the numerical methods of the judgement: they end iterations and keep systems regular, and are
/// far below every tolerance of [`Tolerances`]. Lengths in metres, angles in radians.
pub(super) struct Numerics {
    /// The weight of the orientation of a link in the alignment of two postures, m² beside its mass: a thousandth of
    /// the mass at 4 cm, against degenerate sets of centres.
    pub orientation_weight: f64,
    /// The weight of a turn in the alignment on contacts, m²: it keeps a robot on one or two contacts from being
    /// turned about them.
    pub turn_weight: f64,
    /// The height above the model of the bundle method from which on a support plane counts as violated, m. 1e-12:
    /// rounding of coordinates.
    pub plane_violation: f64,
    /// The height beyond the one that is asked for up to which points of a circle are looked at, m. 1e-7: more than
    /// rounding makes of the fall of a disc that lies nearly flat.
    pub point_height: f64,
    /// The turn up to which a robot on a slope rests once the line of gravity is found anew, rad. 1e-9: it moves the line by
    /// less than coordinates are rounded.
    pub slope_turn: f64,
    /// The rounding allowed in the multipliers of the bundle method, which are without unit and sum to 1. 1e-10.
    pub multiplier: f64,
    /// The proximal weight of the dual of the normal forces, so that its solution exists whatever the contact points
    /// are. Without unit; 1e-8.
    pub proximal_weight: f64,
    /// The gradient at which the dual of the normal forces counts as solved, in parts of the weight. 1e-14: rounding.
    pub dual_gradient: f64,
    /// The relative precision of the greatest value of a polynomial, without unit. 1e-12: well above rounding.
    pub extremum: f64,
    /// The least spread of a sliding patch, m² (that of 0.1 mm): a point resists spinning a little.
    pub patch_spread: f64,
    /// The fraction of the greatest motion below which slips are smoothed. 1e-4: the power then has a derivative
    /// everywhere.
    pub smoothed_slip: f64,
    /// The fraction of the greatest motion by which the displacement of least friction changes when its rounds end.
    /// 1e-10.
    pub power_change: f64,
    /// The weight that keeps the normal equations of a balance regular, in parts of the weight. 1e-15.
    pub balance_ridge: f64,
    /// The part of [`Tolerances::balance`] to which a balance is corrected, without unit. 1e-6.
    pub balance_spare: f64,
    /// The least size of a robot about its base, m, to which the moment of its weight is compared. 1 mm: smaller
    /// robots would divide by nothing.
    pub robot_size: f64,
    /// The angle below which an arc is followed by the series of sine and cosine, rad. 1e-6: the series is then exact
    /// to rounding.
    pub series_angle: f64,
    /// The square of the angle below which the logarithm of a displacement is taken by its series, rad². 1e-6: the
    /// series is then exact to rounding.
    pub series_angle_squared: f64,
    /// The sine of the angle below which a rotation has no axis. 1e-12: rounding.
    pub no_rotation: f64,
    /// The rounding of the bound from the bounding spheres of two clusters of modules, m, at a metre; it grows with
    /// the distance. 1e-9: well above that of sums over chains, far below the tolerance of the clearance.
    pub cluster_rounding: f64,
    /// The difference up to which two times (s), positions or control points (rad or m) count as equal where motions
    /// repeat. 1e-12: the rounding of times of some minutes. Over a thousand joints that turn at 10 rad/s it moves a link by
    /// less than [`Precision::tol_depth`].
    pub motion_equal: f64,
    /// The grid on which values are rounded before motions are looked up, s, rad or m. 1e-9: equal values hardly ever lie on
    /// two sides of a boundary, and where they do, only a repetition is missed.
    pub motion_grid: f64,
}

/// The thresholds with which every judgement computes.
pub(super) const NUMERICS: Numerics = Numerics {
    orientation_weight: 1e-3 * 0.04 * 0.04,
    turn_weight: 1e-8,
    plane_violation: 1e-12,
    point_height: 1e-7,
    slope_turn: 1e-9,
    multiplier: 1e-10,
    proximal_weight: 1e-8,
    dual_gradient: 1e-14,
    extremum: 1e-12,
    patch_spread: 1e-8,
    smoothed_slip: 1e-4,
    power_change: 1e-10,
    balance_ridge: 1e-15,
    balance_spare: 1e-6,
    robot_size: 1e-3,
    series_angle: 1e-6,
    series_angle_squared: 1e-6,
    no_rotation: 1e-12,
    cluster_rounding: 1e-9,
    motion_equal: 1e-12,
    motion_grid: 1e-9,
};
