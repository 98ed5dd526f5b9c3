//! Readers of mesh and point cloud files: Wavefront OBJ, OFF, PLY and STL; PLY and XYZ for clouds.
//!
//! A reader turns bytes into a [`Content`] or says what is wrong. To add one, write its file and add its
//! line to [`MESH_FORMATS`] or [`CLOUD_FORMATS`].

mod content;
mod obj;
mod off;
mod ply;
mod stl;
mod xyz;

pub use content::{Content, Fault, triangles};

/// A file format.
#[derive(Clone, Copy)]
pub struct Format {
    /// The end of the names of its files, after the dot.
    pub ending: &'static str,
    /// The name that messages give it.
    pub name: &'static str,
    read: fn(&[u8]) -> Result<Content, Fault>,
}

/// The formats of meshes.
pub const MESH_FORMATS: &[Format] = &[
    Format { ending: "stl", name: "STL", read: stl::read },
    Format { ending: "obj", name: "OBJ", read: obj::read },
    Format { ending: "off", name: "OFF", read: off::read },
    Format { ending: "ply", name: "PLY", read: ply::read },
];

/// The formats of point clouds.
pub const CLOUD_FORMATS: &[Format] = &[
    Format { ending: "ply", name: "PLY", read: ply::read },
    Format { ending: "xyz", name: "XYZ", read: xyz::read },
];

impl Format {
    /// Reads a mesh: at least one face, each of three corners or more, and finite coordinates.
    ///
    /// # Errors
    /// The fault in words, with its line where the format has lines.
    pub fn read_mesh(&self, bytes: &[u8]) -> Result<Content, Fault> {
        checked_mesh((self.read)(bytes)?)
    }

    /// Reads a cloud: at least one point, and finite coordinates.
    ///
    /// # Errors
    /// The fault in words, with its line where the format has lines.
    pub fn read_cloud(&self, bytes: &[u8]) -> Result<Content, Fault> {
        checked_cloud((self.read)(bytes)?)
    }
}

fn checked_cloud(read: Content) -> Result<Content, Fault> {
    if read.vertices.is_empty() {
        return Err("it holds no points".into());
    }
    finite(&read)?;
    Ok(read)
}

fn finite(read: &Content) -> Result<(), Fault> {
    match read.vertices.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(format!("a coordinate of vertex {vertex} is no finite number")),
        None => Ok(()),
    }
}

/// Checks what holds for a mesh of any format.
fn checked_mesh(read: Content) -> Result<Content, Fault> {
    if read.faces.is_empty() {
        return Err("it holds no faces".into());
    }
    finite(&read)?;
    for (number, face) in read.faces.iter().enumerate() {
        if face.len() < 3 {
            return Err(format!("face {number} has fewer than three corners"));
        }
        if let Some(corner) = face.iter().find(|corner| **corner >= read.vertices.len()) {
            let count = read.vertices.len();
            return Err(format!("face {number} names vertex {corner}; there are {count}"));
        }
    }
    Ok(read)
}
