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
pub mod contacts;

pub mod merging;

pub mod detour;

mod alongside;
mod attempts;
mod lattice;

mod piece;

pub mod fabrik;
mod paper;

mod search;
mod shortening;

pub mod weight;

pub mod assembly;
pub mod scales;

pub mod tangle;

pub use robot::{Bond, Dock, Robot};
pub use search::{unwind, unwind_under};
pub use sound::Unsound;
pub use state::Step;
pub use weight::{Load, Weight};

use state::State;

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
    /// Pairs of ends that come together in one turn, at most.
    pub at_once: usize,
    /// Pairs for which a detour is looked for where no other attempt at any pair did.
    pub detours: usize,
    pub closing: closing::Settings,
    pub collisions: Collisions,
    /// Of the paper's own method.
    pub fabrik: fabrik::Settings,
    /// Threads that may be at work at once; what is found does not depend on it.
    pub threads: usize,
}

/// Where collisions are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collisions {
    /// All the way.
    Motion,
    /// The paper's method, and its three settings: nowhere; in the states in which tips meet; there, and
    /// in the inverse kinematics.
    None,
    Detection,
    Avoidance,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 0,
            budget: BUDGET,
            shake_slack: 0.02,
            shake_turns: 100,
            at_once: 8,
            detours: 10,
            closing: closing::Settings::default(),
            collisions: Collisions::Motion,
            fabrik: fabrik::Settings::default(),
            threads: 1,
        }
    }
}

/// Takes a minute or two for a hundred modules.
pub const BUDGET: u64 = 5_000_000;

/// How far a search has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Chains that are to become one another's parts: one less than there are.
    pub needed: usize,
    pub made: usize,
    /// Pairs of ends that were tried.
    pub tried: u64,
    pub work: u64,
    /// Rounds in which no pair came together, so that the robot was shaken.
    pub shakes: u64,
    /// Modules of the longest chain, and how many chains there are.
    pub longest: usize,
    pub chains: usize,
}

impl Progress {
    /// Counts the chains.
    fn see(&mut self, state: &State) {
        let mut chains = state.chains();
        chains.sort_unstable();
        let lengths = chains.chunk_by(|a, b| a == b).map(<[usize]>::len);
        (self.chains, self.longest) = lengths.fold((0, 0), |(n, most), l| (n + 1, most.max(l)));
    }
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
    /// The paper's method has tried all pairs in every order that it came to.
    Exhausted(Progress),
    /// There are not two free ends of different chains.
    NoTips(Progress),
    /// Joints would have to hold more than they can.
    Heavy(Heavy),
}

/// What was too heavy; of all that was tried, and came as far, what was least so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heavy {
    pub load: Load,
    pub doing: Doing,
    pub progress: Progress,
}

/// What a robot that is held was to do when a joint would have had to hold too much.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doing {
    /// Nothing yet.
    Standing,
    /// Letting go the bonds that close loops.
    Opening,
    /// Bringing these docks together, and letting go what they stand in for.
    Joining(Dock, Dock),
    /// Straightening the snake.
    Straightening,
    /// Being the straight snake.
    Ending,
}
