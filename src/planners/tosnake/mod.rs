//! Unwinding: from any configuration of RoFI modules to a snake, after "Tentacle-Based Shape Shifting of
//! Metamorphic Robots Using Fast Inverse Kinematics" (Mrázek, Ondika, Černá, Barnat).
//!
//! What is kept of the paper, what is better than it, and by which conditions plans are judged:
//! `docs/planners/tosnake.md`.
//!
//! Loops are opened; then two chains at a time become one: their ends meet ([`merging`], [`closing`]),
//! and the loop that this closes is opened at a bond that is none of a snake. Between that the robot is
//! straightened ([`opening`]), and in the end what is superfluous is left out ([`shortening`]). Every motion is checked on the way ([`sweep`], [`turn`]), not only where
//! it ends. Lengths are in parts of the pitch, angles in radians.

pub mod rigid;

pub mod robot;

pub mod tree;

pub mod near;
pub mod sound;

pub mod sweep;
pub mod turn;

pub mod state;

pub mod opening;

mod linear;

pub mod closing;

pub mod merging;

mod search;
mod shortening;

pub mod assembly;

pub mod tangle;

pub use robot::{Bond, Dock, Robot};
pub use search::unwind;
pub use sound::Unsound;
pub use state::Step;

/// What the search may do.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub seed: u64,
    /// Poses of the whole robot that may be worked out.
    pub budget: u64,
    /// The part of its spread by which a shake may draw the robot together.
    pub shake_slack: f64,
    /// Turns that one shake tries.
    pub shake_turns: usize,
    pub closing: closing::Settings,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 0,
            budget: BUDGET,
            shake_slack: 0.02,
            shake_turns: 100,
            closing: closing::Settings::default(),
        }
    }
}

/// Takes a minute or two for a hundred modules.
pub const BUDGET: u64 = 5_000_000;

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Chains that are to become one another's parts: one less than there are.
    pub needed: usize,
    pub made: usize,
    /// Pairs of ends that were tried.
    pub tried: u64,
    pub work: u64,
}

/// A way to the snake.
#[derive(Clone, Debug)]
pub struct Found {
    /// As it is in the end: all joints at zero, or whole turns.
    pub robot: Robot,
    pub steps: Vec<Step>,
    pub progress: Progress,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    Unsound(Unsound),
    /// The docks of this bond do not meet, by so much (parts of the pitch, or of a turn's matrix).
    Open {
        bond: usize,
        missing: f64,
    },
    /// The budget is spent.
    Budget(Progress),
    /// Whoever watches had enough.
    Stopped(Progress),
}
