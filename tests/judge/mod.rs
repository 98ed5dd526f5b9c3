//! The judge: plans that must fail, each with a twin that must pass.

mod adversary;
pub mod collision;
mod docking;
pub mod ground;
pub mod lattice_judge;
mod missed;
mod momentum;
pub mod oracle;
pub mod parting;
mod random_scenes;
mod rolling;
mod slip_spread;
pub mod slopes;
mod snapping;
mod truss_acceleration;
pub mod truss_judge;
mod truss_loads;
pub mod verify;
