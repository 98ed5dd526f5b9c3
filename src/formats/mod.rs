//! Readers of mesh and point cloud files.
//!
//! [`mesh_file`] chooses a reader by the ending of the file's name: Wavefront OBJ, OFF, PLY, STL, and XYZ
//! for clouds of points.

pub mod mesh_file;
pub mod obj;
pub mod off;
pub mod ply;
pub mod stl;
pub mod xyz;
