//! Robots as models of MuJoCo, and what a simulation of them shows.

mod falls;
mod floor_contacts;
mod gait_programs;
mod inverse;
mod library_reserves;
pub mod mjcf;
mod random_gaits;
pub mod structures;
mod unneeded_exemptions;
