//! The one test program: a module for each room and each promise.

mod behavior;
mod check;
mod cli;
mod conflicts;
mod designs;
mod desk;
mod distance;
mod docs;
mod fences;
mod gaits;
mod ground;
mod kinematics;
mod mass;
mod motions;
mod plan_file;
mod plan_operations;
mod programs;
mod render;
mod robots;
mod suite;
mod syntax;
mod syntax_random;
mod tidy;
mod tree;
mod verify;
