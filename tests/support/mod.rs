//! What the tests share: hosts, sandboxes, terminals, robots and programs made by plain Rust.

pub mod arms;
pub mod dense_model;
pub mod desk;
pub mod fences;
pub mod generated;
pub mod hollow_meshes;
pub mod lattices;
pub mod motions;
pub mod numbers;
pub mod programs;
pub mod properties;
pub mod recount;
pub mod recount_lattice;
pub mod replay;
pub mod robots;
pub mod sources;
pub mod suite;
pub mod terminal;
pub mod tree;
pub mod trusses;
pub mod verdicts;
