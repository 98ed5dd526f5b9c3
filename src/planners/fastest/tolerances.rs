//! The tolerances and thresholds of time-optimal path parameterisation.

/// The tolerances with which plans are retimed; [`TOLERANCES`] has the values.
pub(super) struct Tolerances {
    /// The change of a joint's velocity in an instant, rad/s or m/s, below which it counts as none, and the velocity
    /// below which a joint counts as at rest: rounding of control points over short segments.
    pub velocity: f64,
    /// The greatest distance of a joint from a straight line of all joints, rad or m, at which the path counts as
    /// straight: rounding of control points.
    pub straight: f64,
    /// The greatest difference of two directions of straight paths, as a fraction of the joint that moves farthest, at
    /// which they are one path: rounding of positions.
    pub direction: f64,
    /// The part of each limit of acceleration and of squared speed that is left free while a path is timed, so that
    /// rounding does not exceed it.
    pub limit: f64,
    /// The excess over a limit of speed, as a fraction, above which the grid is refined where it occurs.
    pub excess: f64,
    /// The least duration of an interval of a grid, s: accelerations over shorter ones are rounding of positions.
    pub interval: f64,
    /// The relative precision of greatest values of polynomials: well above rounding.
    pub extremum: f64,
    /// The sine of the angle below which two constraints count as parallel: rounding.
    pub parallel: f64,
    /// The part of a squared velocity by which two bounds may cross, and one velocity is left: rounding.
    pub slack: f64,
    /// The size below which an entry of the derivative of a path counts as zero, rad or m per unit of the parameter.
    pub derivative: f64,
    /// The first interval of the grid after an instant in which all joints are at rest, as a part of the stretch. The
    /// velocity of the parameter goes to infinity there; 0.004 costs less than 0.1 % of the duration.
    pub first_interval: f64,
    /// The part of a limit by which a torque at rest may be over it, and count as held: rounding.
    pub torque: f64,
    /// The increase of the duration of a stretch that is slowed down for the first time, as a part of its duration by
    /// the time law; doubled at each further time.
    pub slower: f64,
}

/// The values of the tolerances, the same in every call.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    velocity: 1e-8,
    straight: 1e-11,
    direction: 1e-9,
    limit: 1e-7,
    excess: 5e-4,
    interval: 1e-4,
    extremum: 1e-9,
    parallel: 1e-12,
    slack: 1e-9,
    derivative: 1e-12,
    first_interval: 4e-3,
    torque: 1e-9,
    slower: 2.5e-4,
};
