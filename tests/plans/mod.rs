//! Plan files and operations on plans.

pub mod altered;
pub mod lattice_moves;
pub mod library_of_files;
pub mod plan_file;
pub mod plan_operations;
pub mod plans_stored;
pub mod scenes;
