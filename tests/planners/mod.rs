//! Each planner against its truth, and its plans before the judge.

pub mod fastest;
pub mod fold;
pub mod fold_bounds;
pub mod fold_clearing;
pub mod fold_collisions;
pub mod fold_dynamics;
pub mod fold_files;
pub mod fold_layouts;
pub mod fold_objective;
pub mod fold_orders;
pub mod fold_random;
pub mod goals;
pub mod locomotion;
pub mod morphing;
pub mod planar_path;
pub mod reconfigure;
pub mod refold;
pub mod squeeze;
mod squeeze_push;
pub mod surroundings;
pub mod tosnake;
pub mod tosnake_contradictions;
pub mod tosnake_detour;
pub mod tosnake_near;
pub mod tosnake_search;
pub mod tosnake_weight;
pub mod truss_robots;
