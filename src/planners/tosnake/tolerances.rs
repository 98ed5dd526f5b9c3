//! The tolerances and thresholds of the planner of RoFI modules.

/// The tolerances and thresholds of `tosnake`; [`TOLERANCES`] has the values. Lengths are in pitches, angles in
/// radians.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// The least distance of the centres of two balls, in pitches. Balls touch at 1; the judge's limit is 0.999, and
    /// the difference is what the check of motions, which is no proof, may be wrong by.
    pub min_distance: f64,
    /// The least distance of the centres of balls during single turns, in pitches: a little more than the checks of
    /// whole motions ask for, so that such a motion may begin there.
    pub turn_min_distance: f64,
    /// The greatest deviation of a ball from a straight line in the middle of a step, in pitches: a part of the
    /// difference between [`Tolerances::min_distance`] and the judge's limit.
    pub deviation: f64,
    /// The shortest step of a check, as a fraction of the motion; a motion that needs shorter ones is refused.
    pub step_min: f64,
    /// The fraction by which a load may grow between checked instants: an axis turns as far as a ball moves that
    /// is one pitch away, so [`Tolerances::deviation`] bounds it, with a factor of five to spare.
    pub load_spare: f64,
    /// The greatest closure residual of a bond that holds: in pitches for positions, without unit for rotations. It
    /// is the limit of RoFI's own tools.
    pub closure: f64,
    /// The violation of a distance constraint, in pitches, below which the constraint stays out of the active set.
    pub constraint: f64,
    /// The deviation of entries of two transforms that count as equal, in pitches or without unit, and the tolerance
    /// of joint ranges, rad. On the lattice of quarter turns different ones deviate by half.
    pub equal_transforms: f64,
    /// The distance of two centres, in pitches, below which they are one ball's and have no normal: rounding.
    pub coincident: f64,
    /// The distance from an axis, in pitches, below which a ball is on it and does not move about it: rounding.
    pub on_axis: f64,
    /// The sum of products of lengths, in squared pitches, below which nothing depends on a joint, and the joint
    /// stays.
    pub indifferent: f64,
    /// The angle by which a tilt may be inside a forbidden interval, rad: rounding.
    pub interval: f64,
    /// The angle between two turns that count as one, rad: rounding.
    pub turn: f64,
    /// The tilt below which a joint counts as at zero, rad: what rounding leaves of a turn to zero.
    pub tilt: f64,
    /// The relative difference of two pitches that count as equal: rounding.
    pub pitch: f64,
    /// The relative excess of a duration over the least, so that rounding does not break a limit.
    pub duration_spare: f64,
    /// The height above the floor, in pitches, up to which a ball touches it: a tenth of the judge's.
    pub contact: f64,
    /// The slope of the floor against the last one, below which a robot rests: rounding.
    pub level: f64,
    /// The imbalance of forces of the floor, in parts of the weight and of the weight times a pitch: rounding.
    pub balance: f64,
    /// The least distance of the centre of mass from the edge of the support polygon, in pitches: what checks at instants may
    /// miss between.
    pub stability: f64,
    /// The angle by which gravity may turn against the robot while its contacts change, from one instant to the next, rad: a
    /// robot that falls over turns farther, however short the step.
    pub handover: f64,
    /// The shortest step to a change of contacts, as a fraction of the motion.
    pub handover_step: f64,
    /// The lean at which a robot that is put down stands as it was drawn, rad: 10 degrees.
    pub upright: f64,
    /// The angle between two directions of gravity that count as one, rad: far below that between two rests.
    pub same_rest: f64,
    /// The least divisor where a step is scaled by the length of what it has to make good, in pitches or rad: any
    /// shorter one needs no scaling.
    pub divisor: f64,
}

/// The values of the tolerances that every search of this planner uses.
pub const TOLERANCES: Tolerances = Tolerances {
    min_distance: 1.0 - 6e-4,
    turn_min_distance: 1.0 - 6e-4 + 2e-4,
    deviation: 4e-4,
    step_min: 1e-7,
    load_spare: 2e-3,
    closure: 1e-3,
    constraint: 1e-3,
    equal_transforms: 1e-6,
    coincident: 1e-6,
    on_axis: 1e-9,
    indifferent: 1e-12,
    interval: 1e-9,
    turn: 1e-9,
    tilt: 1e-12,
    pitch: 1e-9,
    duration_spare: 1e-9,
    contact: 1e-5,
    level: 1e-10,
    balance: 1e-9,
    stability: 0.01,
    handover: 0.03,
    handover_step: 1e-4,
    upright: 10.0 * std::f64::consts::PI / 180.0,
    same_rest: 1e-3,
    divisor: 1e-30,
};
