//! Shapes, modules, kinematics and masses, against other truths.

pub mod cholesky;
pub mod designs;
pub mod distance;
pub mod dynamics;
pub mod embedding;
mod ground_shapes;
pub mod jacobian;
pub mod kinematics;
pub mod mass;
pub mod mesh_files;
pub mod meshes;
pub mod near_pairs;
mod protruding;
pub mod quadratic;
pub mod rigidity;
pub mod rofi;
mod shared;
mod solids;
pub mod sparse_cholesky;
pub mod truss_forces;
pub mod urdf;
