//! Shapes, modules, kinematics and masses, against other truths.

pub mod designs;
pub mod distance;
pub mod kinematics;
pub mod mass;
pub mod mesh_files;
pub mod meshes;
pub mod quadratic;
pub mod rigidity;
pub mod rofi;
pub mod urdf;
