//! The kernel of the truss planners [`morph`](super::morph) and [`locomote`](super::locomote): trusses of
//! linear actuators after "Linear Actuator Robots: Differential Kinematics, Controllability, and Algorithms
//! for Locomotion and Shape Morphing" (Usevitch, Hammond, Follmer, Schwager), with Algorithm 1 mended
//! ([`step`]) and a certificate by conservative advancement between the ends of steps (`advancement`).
//!
//! Data stand first, the computations on them below: a [`Structure`] with its [`Limits`] and [`Surroundings`]; its
//! inequality [`constraint`]s with gradients; the singular values of its rigidity matrix; the broad phase;
//! one step of sequential quadratic programming; static stability on a support polygon, and rolls over its
//! edges; the plan's body.

pub mod structure;
pub mod surroundings;
pub mod tolerances;

pub(super) mod forces;
mod positions;
mod rigidity;
mod threads;

pub mod margins;

pub mod constraint;

mod broad_phase;

mod advancement;
mod environment;

pub mod step;
mod violations;

pub(super) mod support_polygon;

pub mod roll;
mod rotation;

pub mod motion;
pub mod problem;
pub mod stated_steps;
pub mod timing;

pub use rigidity::kept as rigidity_kept;
pub(super) use rigidity::weakest_node as rigidity_weakest;
pub use structure::{Limits, Structure};
pub use surroundings::Surroundings;
pub use tolerances::Tolerances;
