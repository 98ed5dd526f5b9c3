//! Every tolerance of the judge, with its reason.

/// Lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The descent ends when the planes promise less of a fall than this.
    pub fall_min: f64,
    /// A fall of up to this, a quarter of the usual contact tolerance, is a clunk between rest
    /// positions and no tip.
    pub fall_floor: f64,
    /// Touches that carry weight: closer to the ground than this.
    pub gap_loaded: f64,
    /// Least stiffness of the ground under a touch, against that of one without a gap.
    pub stiffness_min: f64,
    /// Loads below this part of the weight do not steer the guess of the next attitude.
    pub load_min: f64,
    /// Touches closer than this are what support really is.
    pub gap_exact: f64,
    /// Touches that keep a robot from being shaken, and how far inside them the centre of mass is.
    pub gap_standing: f64,
    pub inside_min: f64,
    /// Angle of a perturbation, and the fall that it must show.
    pub perturbation: f64,
    pub perturbation_fall: f64,
    /// A margin this much below zero is rounding.
    pub margin: f64,
    /// Modules whose centres are within this of the lowest count as lowest (the paper's rule).
    pub centres: f64,
    /// Joints turn by no more than this between two samples.
    pub turn_sample: f64,
    /// Points move by no more than this between two samples, or the step is halved.
    pub motion_sample: f64,
    /// Relative excess over a limit that is rounding of the plan's own numbers.
    pub limit: f64,
    /// A change of speed at once that is rounding (rad/s or m/s).
    pub speed_jump: f64,
    /// Loops that the bonds close may be open by this, where the connector states no capture.
    pub closure_distance: f64,
    pub closure_angle: f64,
    /// Links slipping with less than this part of the weight are not reported.
    pub slip_load: f64,
    /// A slip longer than this makes an exemption for slip needed.
    pub slip: f64,
    /// The time of a tip is known this well, s.
    pub time: f64,
    /// Balance of contact forces that counts as balance, in parts of the weight (and times a metre).
    pub balance: f64,
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        let degree = std::f64::consts::PI / 180.0;
        Tolerances {
            fall_min: 1e-9,
            fall_floor: 1e-3,
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
            turn_sample: 5.0 * degree,
            motion_sample: 0.02,
            limit: 1e-9,
            speed_jump: 1e-6,
            closure_distance: 1e-3,
            closure_angle: degree,
            slip_load: 0.05,
            slip: 1e-3,
            time: 1e-9,
            balance: 1e-6,
        }
    }
}
