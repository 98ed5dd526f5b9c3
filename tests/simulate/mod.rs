//! Simulations of plans: beside closed forms of mechanics, by what mechanics conserves, beside MuJoCo, and at the limits
//! of what may be asked.

mod bonds;
mod closed_forms;
mod contacts;
mod facts;
pub mod fixtures;
mod mujoco;
mod obstacles;
mod robustness;
mod sensing;
mod stops;
mod terrain;
