//! The one test program: a module for each room and each promise.

mod cli;
mod behavior;
mod kinematics;
mod mass;
mod programs;
mod render;
mod robots;
mod syntax;
mod tidy;
