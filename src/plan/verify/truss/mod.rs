//! The judgement of trusses, whose plans are paths of nodes, in closed form and by bounds on how fast
//! distances change.
//!
//! Of each step, in this order: lengths of struts and their rates, distances between struts, obstacles,
//! shape (angles, rigidity, sums of lengths), the ground, and what the truss stands on; last the margins
//! that the plan states at its keyframes.

mod around;
mod distance;
mod judge;
mod lengths;
mod margins;
mod shape;
mod standing;

pub(super) use judge::judge;
