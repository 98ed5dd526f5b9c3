//! Settings of the search, each with its unit, its default and the reason for the default.

/// The settings of [`plan`](super::plan).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The seed of all random numbers; the same seed gives the same plan. Default 0.
    pub seed: u64,
    /// The greatest number of postures of the whole robot that are examined, compared between two attempts. Default
    /// 5,000,000, as with RoFI modules.
    pub budget: u64,
    /// The greatest number of pairs of ends that are tried before joints turn at random. Default 12: those behind are far apart.
    pub pairs_max: usize,
    /// The number of postures from which inverse kinematics begins for a pair. Default 12.
    pub starts: usize,
    /// The greatest number of postures that are examined for a way to the place where a pair meets. Default 10,000.
    pub way_budget: u64,
    /// The greatest number of random turns that are tried before the next attempts at pairs. Default 30.
    pub perturbation_turns: usize,
    /// The greatest number of rounds in a row in which no pair comes together, joints turning at random between them. Default 30.
    pub rounds_max: usize,
    /// The distance that modules keep that are not docked to each other, m. Default 1 mm; where they are nearer at the
    /// start, half of that.
    pub clearance: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 0,
            budget: 5_000_000,
            pairs_max: 12,
            starts: 12,
            way_budget: 10_000,
            perturbation_turns: 30,
            rounds_max: 30,
            clearance: 1e-3,
        }
    }
}

/// The speed of joints of which no limit is stated, rad/s or m/s.
pub(super) const UNLIMITED_SPEED: f64 = 1.0;
/// The span on either side of where it is in which a slide without a range is moved at random, m.
pub(super) const SLIDE_SPAN: f64 = 0.1;
/// The greatest number of links of a robot: the memory of the pairs of them grows with the cube of it.
pub(super) const LINKS_MAX: usize = 500;
