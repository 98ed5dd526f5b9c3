//! Settings and thresholds of the search, each with its unit, its default and the reason for the default.

use super::fabrik;
use super::inverse_kinematics;

/// The settings of the whole search of `tosnake`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The seed of all random numbers; the same seed gives the same plan. Default 0.
    pub seed: u64,
    /// Greatest number of forward kinematics of the whole robot, a measure of work that does not depend
    /// on the machine; it is compared between attempts, which may exceed it a little. Default [`BUDGET`].
    pub budget: u64,
    /// The greatest fraction of the robot's spread (sum of squared distances of balls from their centroid) by which
    /// one turn of a perturbation may reduce the spread. Default 0.02: the robot spreads in the long run, and yet
    /// gets past bottlenecks.
    pub perturbation_slack: f64,
    /// Number of random turns that one perturbation tries. Default 100, about one for each joint of 33 modules.
    pub perturbation_turns: usize,
    /// Greatest number of pairs of ends that are brought together in one step. Default 8; more are hardly
    /// ever independent of each other.
    pub concurrent_merges_max: usize,
    /// Number of pairs, the most promising first, for which RRT-Connect looks for a detour after all other
    /// attempts of a round failed. Default 10: detours are expensive.
    pub detour_pairs_max: usize,
    /// Settings of the inverse kinematics that closes loops, with the defaults that its fields state.
    pub inverse_kinematics: inverse_kinematics::Settings,
    /// The states in which collisions are checked; everything but the default, [`Collisions::Motion`], is the method of
    /// [Mrázek et al.](super) itself.
    pub collisions: Collisions,
    /// The settings of FABRIK, the inverse kinematics of [Mrázek et al.](super), with the defaults that its fields
    /// state.
    pub fabrik: fabrik::Settings,
    /// Number of threads that may work at once, on floating robots of 16 modules or more; the plan does not depend on
    /// it. Default 1; 0 counts as 1.
    pub threads: usize,
}

/// The default of [`Settings::budget`], forward kinematics: one or two minutes of one processor for a hundred modules.
pub const BUDGET: u64 = 5_000_000;

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 0,
            budget: BUDGET,
            perturbation_slack: 0.02,
            perturbation_turns: 100,
            concurrent_merges_max: 8,
            detour_pairs_max: 10,
            inverse_kinematics: inverse_kinematics::Settings::default(),
            collisions: Collisions::Motion,
            fabrik: fabrik::Settings::default(),
            threads: 1,
        }
    }
}

/// The states in which collisions are checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collisions {
    /// All states: every motion is checked over its whole duration, in this planner's own search.
    Motion,
    /// No state, one of the methods of [Mrázek et al.](super).
    None,
    /// The states in which tips meet, one of the methods of [Mrázek et al.](super).
    Detection,
    /// The states in which tips meet, and the inverse kinematics avoids collisions: one of the methods of [Mrázek et
    /// al.](super).
    Avoidance,
}

impl Collisions {
    /// Returns the planner's name as the provenance of a plan states it, such as `tosnake, collisions: none`.
    pub fn planner(self) -> &'static str {
        match self {
            Collisions::Motion => "tosnake",
            Collisions::None => "tosnake, collisions: none",
            Collisions::Detection => "tosnake, collisions: detection",
            Collisions::Avoidance => "tosnake, collisions: avoidance",
        }
    }
}
