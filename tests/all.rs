//! The one test program: a module for each room and each promise.

mod cli;
mod kinematics;
mod mass;
mod render;
mod robots;
mod syntax;
mod tidy;
