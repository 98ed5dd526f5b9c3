//! The shapes of links in URDF: primitives in the text, hulls and meshes as STL files beside it.

use super::export::ExportFile;
use super::names::plain_file_name;
use super::urdf::origin;
use crate::formats::xml::{Xml, number, vector};
use crate::geometry::{Placed, Pose, Vec3};
use crate::view::{Primitive, primitives};
use std::collections::BTreeMap;

/// The meshes of the links of an export, each written once for all modules of a type.
pub(super) struct Shapes {
    /// The folder of the meshes.
    folder: String,
    /// The files by their names.
    files: BTreeMap<String, Vec<u8>>,
}

/// The shapes of a link, with the place of its meshes.
pub(super) struct OfLink<'a> {
    shapes: &'a mut Shapes,
    kind: usize,
    link: usize,
}

impl Shapes {
    /// Returns no meshes. `stem`: that of the files of the export.
    pub(super) fn new(stem: &str) -> Shapes {
        Shapes { folder: format!("{}.meshes", plain_file_name(stem)), files: BTreeMap::new() }
    }

    /// Returns the shapes of a link, given by its index in a module type, given by its own.
    pub(super) fn of(&mut self, kind: usize, link: usize) -> OfLink<'_> {
        OfLink { shapes: self, kind, link }
    }

    /// Returns the files of the meshes.
    pub(super) fn into_files(self) -> Vec<ExportFile> {
        self.files.into_iter().map(|(name, bytes)| ExportFile { name, bytes }).collect()
    }
}

impl OfLink<'_> {
    /// Adds an element of this name, `visual` or `collision`, for each primitive of shapes. `X_UL`: the pose of the link's
    /// own frame in that of its description.
    pub(super) fn write(&mut self, xml: &mut Xml, element: &str, shapes: &[Placed], X_UL: &Pose) {
        let mut piece = 0;
        primitives(shapes, &mut |X_LS, primitive| {
            xml.open(element, &[]);
            xml.leaf("origin", &origin(&(X_UL * X_LS)));
            xml.open("geometry", &[]);
            match primitive {
                Primitive::Box { size } => xml.leaf("box", &[("size", vector(&size))]),
                Primitive::Tube { radius, length } => {
                    xml.leaf("cylinder", &[("radius", number(radius)), ("length", number(length))]);
                }
                Primitive::Ball { radius } => xml.leaf("sphere", &[("radius", number(radius))]),
                Primitive::Surface { points, triangles } => {
                    let Shapes { folder, files } = &mut *self.shapes;
                    let name = format!("{folder}/{}-{}-{element}-{piece}.stl", self.kind, self.link);
                    files.entry(name.clone()).or_insert_with(|| stl(points, triangles));
                    xml.leaf("mesh", &[("filename", name)]);
                    piece += 1;
                }
            }
            xml.close("geometry");
            xml.close(element);
        });
    }
}

/// Returns triangles as a binary STL file, in metres.
fn stl(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut bytes = b"modl, in metres".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| points[corner as usize]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        for coordinate in [normal, a, b, c].iter().flat_map(|v| v.iter()) {
            bytes.extend((*coordinate as f32).to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}
