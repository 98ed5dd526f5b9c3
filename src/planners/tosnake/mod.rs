//! `tosnake`: from any configuration of RoFI modules to a snake, after "Tentacle-Based Shape Shifting of
//! Metamorphic Robots Using Fast Inverse Kinematics" (Mrázek, Ondika, Černá, Barnat).
//!
//! `docs/planners/tosnake.md` lists the parts of the paper that are kept and the differences, and describes the
//! judgement of plans.
//! Lengths are in pitches (the distance of the centres of a module's two bodies), angles in radians.
//!
//! Loops are opened ([`search`]); then two chains at a time become one ([`merging`]): the ends of a pair are
//! brought together by damped least-squares inverse kinematics ([`inverse_kinematics`]), and the bond is
//! undocked that the new one replaces. Between that the robot is straightened ([`straighten`]), and at last
//! the path is shortened by shortcuts. Every motion is checked over its whole duration ([`motion_check`],
//! [`joint_sweep`]), not only at its end; where the straight motion in joint space is not free,
//! RRT-Connect looks for another ([`rrt_connect`]). The entry is [`plan`].

// The robot and its forward kinematics.
pub mod robot;
pub mod tree;

// Collision and load checks.
pub mod broad_phase;
pub mod gravity;
pub mod joint_sweep;
mod motion_bounds;
pub mod motion_check;
pub mod neighbour_list;
pub mod stance;

// Motions that bring two docks together.
pub mod fabrik;
pub mod inverse_kinematics;
mod lattice_closure;
pub mod rrt_connect;
mod segment;

// The search.
mod attempts;
mod concurrent_merges;
pub mod merging;
mod paper;
mod parallel;
mod refusal;
pub mod repair;
pub mod search;
mod settings;
mod shortcut;
pub mod state;
mod status;
pub mod straighten;
mod tolerances;
pub mod validation;

// The entry: assemblies in, plans out.
mod bound;
mod cache;
pub mod conversion;
mod entry;
mod mass_model;
mod program;

pub mod random_configuration;

pub(in crate::planners) use bound::fewest_changes;
pub use cache::SearchCache;
pub(crate) use entry::Task;
pub use entry::{Problem, Report, plan, plan_with_cache};
pub use gravity::{GravityModel, JointLoad};
pub use refusal::{InvalidStart, NotRofi, Operation, Overload, Refusal};
pub use robot::{Bond, Dock, Robot};
pub use search::{StepSequence, unwind};
pub use settings::{BUDGET, Collisions, Settings};
pub use state::Step;
pub use status::SearchStatus;
pub use tolerances::{TOLERANCES, Tolerances};
