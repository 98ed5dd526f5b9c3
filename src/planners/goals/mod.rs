//! `goals`: motions that are stated by their goal: inverse kinematics, lines in space, and ways round obstacles.
//!
//! - [`reach`](mod@reach) finds a posture that brings a frame to a place: damped least squares with limits, from several
//!   starts, with clearance and balance as secondary tasks.
//! - [`line`](mod@line) moves a frame straight or along an arc, as piecewise cubic motions of joints that deviate from the way
//!   by no more than is stated.
//! - [`avoid`](mod@avoid) finds a way of joints on which nothing meets: RRT-Connect with shortcuts.
//! - [`resolve`](resolve()) puts actions in the place of all goals of a program, each from the state in which it begins.
//!
//! ```
//! use modl::robot::chain::{Orientation, PoseError, Target};
//! use modl::geometry::Vec3;
//!
//! // A place, and an error that is within a tolerance.
//! let place = Target { position: Vec3::new(0.2, 0.0, 0.1), orientation: Orientation::Along(-Vec3::z()) };
//! assert!(PoseError { distance: 1e-9, angle: 0.0 }.is_within(&PoseError { distance: 1e-6, angle: 1e-6 }));
//! assert_eq!(place.orientation, Orientation::Along(Vec3::new(0.0, 0.0, -1.0)));
//! ```

#![allow(non_snake_case)]

pub mod avoid;
pub mod line;
pub mod reach;

mod free_space;
mod front;
mod resolve;
mod timing;
mod tolerances;

pub use free_space::{FreeSpace, Meeting, Surroundings};
pub use front::Misplaced;
pub use resolve::{GOALS_MAX, Placing, Problem, Reason, Refusal, Resolved, resolve};
pub(super) use timing::together as least_time;
