//! Simulations of plans, beside MuJoCo.

mod mujoco;
