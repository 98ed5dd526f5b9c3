//! The one test program: a module for each room and each promise.

mod check;
mod cli;
mod behavior;
mod distance;
mod behavior;
mod cli;
mod conflicts;
mod behavior;
mod cli;
mod kinematics;
mod mass;
mod programs;
mod render;
mod robots;
mod suite;
mod syntax;
mod tidy;
