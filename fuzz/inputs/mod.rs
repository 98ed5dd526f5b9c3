//! Generators of inputs: right by construction, and then damaged.

pub mod corpus;
pub mod crease;
pub mod damage;
pub mod descriptions;
pub mod dice;
pub mod drawings;
pub mod files;
pub mod forms;
pub mod json;
pub mod meshes;
pub mod plans;
pub mod programs;
pub mod project;
pub mod rofi;
pub mod scenes;
pub mod sessions;
pub mod smores;
pub mod wire;
