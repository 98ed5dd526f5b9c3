//! Simulations of plans: beside closed forms of mechanics, by what mechanics conserves, and beside MuJoCo.

mod bonds;
mod closed_forms;
mod contacts;
mod fixtures;
mod mujoco;
