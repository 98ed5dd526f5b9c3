//! Readers of mesh and point cloud files: Wavefront OBJ, OFF, PLY, STL and FOLD; PLY and XYZ for clouds.
//!
//! Readers of crease patterns: FOLD, and drawings in SVG.
//!
//! Writers of foldings (FOLD), of robots of RoFI modules, and of robots with their plans as models of MuJoCo.
//!
//! A reader turns bytes into a [`Content`] or says what is wrong. To add one, write its file and add its
//! line to [`MESH_FORMATS`], [`CLOUD_FORMATS`] or [`CREASE_FORMATS`]. A writer turns data into text. To add one, write its file
//! and add its line to [`FOLDING_FORMATS`] or [`ROBOT_FORMATS`]; `save` and its messages follow. The formats
//! of plans are those of the room `exchange`.

mod arrangement;
mod content;
mod crease_drawing;
mod crease_reader;
mod fault;
mod fold;
mod fold_reader;
pub(crate) mod masses;
pub mod mjcf;
mod npy;
mod obj;
mod off;
mod ply;
mod stl;
mod svg;
mod table;
pub(crate) mod xml;
mod xyz;

use crate::robot::{rofi, rofi_json};

pub use content::{Content, triangles};
pub use crease_reader::CreaseSheet;
pub use fault::FormatFault;
pub use fold::{Crease, CreasePattern};
pub use npy::npy;
pub use table::{RecordCell, RecordColumn, RecordTable};

/// A file format of meshes or point clouds, with its reader.
#[derive(Clone, Copy)]
pub struct Format {
    /// The ending of the names of the format's files, after the dot, in lower case.
    pub ending: &'static str,
    /// The name of the format in messages.
    pub name: &'static str,
    read: fn(&[u8]) -> Result<Content, FormatFault>,
}

/// The formats of meshes that can be read.
pub const MESH_FORMATS: &[Format] = &[
    Format { ending: "stl", name: "STL", read: stl::read },
    Format { ending: "obj", name: "OBJ", read: obj::read },
    Format { ending: "off", name: "OFF", read: off::read },
    Format { ending: "ply", name: "PLY", read: ply::read },
    Format { ending: "fold", name: "FOLD", read: fold_reader::read },
];

/// The formats of point clouds that can be read.
pub const CLOUD_FORMATS: &[Format] = &[
    Format { ending: "ply", name: "PLY", read: ply::read },
    Format { ending: "xyz", name: "XYZ", read: xyz::read },
];

/// A file format of crease patterns, with its reader.
#[derive(Clone, Copy)]
pub struct CreaseFormat {
    /// The ending of the names of the format's files, after the dot, in lower case.
    pub ending: &'static str,
    /// The name of the format in messages.
    pub name: &'static str,
    /// The function that reads the bytes of a file, in the file's own unit of length.
    pub read: fn(&[u8]) -> Result<CreaseSheet, FormatFault>,
}

/// The formats of crease patterns that can be read.
pub const CREASE_FORMATS: &[CreaseFormat] = &[
    CreaseFormat { ending: "fold", name: "FOLD", read: crease_reader::read },
    CreaseFormat { ending: "svg", name: "SVG", read: crease_drawing::read },
];

/// A file format in which data of one kind is exported, with its writer.
pub struct ExportFormat<T> {
    /// The ending of the names of the format's files, after the dot, in lower case.
    pub ending: &'static str,
    /// The function that returns the text of the file.
    pub write: fn(&T) -> String,
}

/// The formats in which foldings can be exported: FOLD.
pub const FOLDING_FORMATS: &[ExportFormat<CreasePattern>] =
    &[ExportFormat { ending: "fold", write: fold::write }];

/// The formats in which lists of records can be exported: CSV and JSON.
pub const TABLE_FORMATS: &[ExportFormat<RecordTable>] =
    &[ExportFormat { ending: "csv", write: table::csv }, ExportFormat { ending: "json", write: table::json }];

/// The formats in which robots of RoFI modules can be exported: RoFI's text and JSON.
pub const ROBOT_FORMATS: &[ExportFormat<rofi::World>] = &[
    ExportFormat { ending: "rofi", write: rofi::write },
    ExportFormat { ending: "json", write: rofi_json::write },
];

impl<T> ExportFormat<T> {
    /// Returns the format of a table whose files have this ending, without the dot; `None` if none has.
    pub fn of_ending<'f>(table: &'f [ExportFormat<T>], ending: &str) -> Option<&'f ExportFormat<T>> {
        table.iter().find(|format| format.ending == ending)
    }

    /// Returns the endings of a table as text for messages: each with its dot in backquotes, joined by " or ".
    pub fn endings(table: &[ExportFormat<T>]) -> String {
        let endings: Vec<String> = table.iter().map(|format| format!("`.{}`", format.ending)).collect();
        endings.join(" or ")
    }
}

impl Format {
    /// Reads a mesh in this format, in the file's own unit of length: at least one face, each of three corners or
    /// more among the vertices, and finite coordinates. It need not be closed.
    ///
    /// # Errors
    /// The first [`FormatFault`] of the bytes, or of the mesh that they hold.
    pub fn read_mesh(&self, bytes: &[u8]) -> Result<Content, FormatFault> {
        checked_mesh((self.read)(bytes)?)
    }

    /// Reads a point cloud in this format, in the file's own unit of length: at least one point, and finite
    /// coordinates. Faces of the file, if any, are kept.
    ///
    /// # Errors
    /// The first [`FormatFault`] of the bytes, or of the cloud that they hold.
    pub fn read_cloud(&self, bytes: &[u8]) -> Result<Content, FormatFault> {
        checked_cloud((self.read)(bytes)?)
    }
}

/// Checks the conditions on a cloud of any format.
fn checked_cloud(read: Content) -> Result<Content, FormatFault> {
    if read.vertices.is_empty() {
        return Err(FormatFault::Nothing { what: "points" });
    }
    finite(&read)?;
    Ok(read)
}

/// Checks that all coordinates are finite.
fn finite(read: &Content) -> Result<(), FormatFault> {
    match read.vertices.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(FormatFault::NotFinite { vertex }),
        None => Ok(()),
    }
}

/// Checks the conditions on a mesh of any format.
fn checked_mesh(read: Content) -> Result<Content, FormatFault> {
    if read.faces.is_empty() {
        return Err(FormatFault::Nothing { what: "faces" });
    }
    finite(&read)?;
    for (number, corners) in read.faces.iter().enumerate() {
        if corners.len() < 3 {
            return Err(FormatFault::FewCorners { face: number });
        }
        if let Some(&corner) = corners.iter().find(|corner| **corner >= read.vertices.len()) {
            let count = read.vertices.len();
            return Err(FormatFault::NoVertex { face: number, corner, count });
        }
    }
    Ok(read)
}
