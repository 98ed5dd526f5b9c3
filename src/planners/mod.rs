//! Planners: each a room of its own that turns a problem into a plan. What they find goes before the
//! same judge as everything else, and none of them is believed.

pub mod random;

pub mod fold;
pub mod squeeze;
pub mod tosnake;
pub mod truss;
