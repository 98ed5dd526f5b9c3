//! `morph` and `locomote`: trusses of linear actuators that change shape and roll, after "Linear
//! Actuator Robots: Differential Kinematics, Controllability, and Algorithms for Locomotion and Shape
//! Morphing" (Usevitch, Hammond, Follmer, Schwager), with Algorithm 1 mended ([`step`]) and a
//! certificate between the ends of steps ([`between`]).

mod segment;
pub mod structure;
pub mod surroundings;

mod stiffness;

pub mod margins;

pub mod bound;
mod nearby;

pub mod between;
mod passing;

pub mod step;

pub mod locomotion;
mod support;

pub mod roll;
mod turning;

pub mod locomote;

mod ahead;

pub mod surface;

pub mod goal;

pub mod fit;

pub mod morph;

pub use structure::{Limits, Loop, Structure};
pub use surroundings::Surroundings;
