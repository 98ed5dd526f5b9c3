//! Meshes and point clouds in every format that is read, written here, and damaged.

use super::damage::{damaged, damaged_bytes};
use super::dice::Dice;
use std::fmt::Write;

/// A mesh, as its file states it.
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<[f64; 3]>,
    /// The corners of each face, as indices.
    pub faces: Vec<Vec<usize>>,
}

/// Returns a mesh of a few faces, whose coordinates are short decimal numbers.
pub fn mesh(dice: &mut Dice) -> Mesh {
    let coordinate = |dice: &mut Dice| dice.below(2001) as f64 / 8.0 - 125.0;
    let vertices: Vec<[f64; 3]> = (0..3 + dice.below(12)).map(|_| [0; 3].map(|_| coordinate(dice))).collect();
    let face = |dice: &mut Dice| (0..3 + dice.below(3)).map(|_| dice.below(vertices.len())).collect();
    let faces = (0..1 + dice.below(10)).map(|_| face(dice)).collect();
    Mesh { vertices, faces }
}

fn row<T: ToString>(numbers: &[T]) -> String {
    numbers.iter().map(T::to_string).collect::<Vec<_>>().join(" ")
}

/// Returns a mesh as Wavefront OBJ.
pub fn obj(mesh: &Mesh) -> String {
    let mut text = String::from("# a mesh\no it\n");
    mesh.vertices.iter().for_each(|v| {
        let _ = writeln!(text, "v {}", row(v));
    });
    for (number, face) in mesh.faces.iter().enumerate() {
        let corner =
            |c: &usize| if number % 3 == 1 { format!("{}//{}", c + 1, c + 1) } else { (c + 1).to_string() };
        let _ = writeln!(text, "f {}", face.iter().map(corner).collect::<Vec<_>>().join(" "));
    }
    text
}

/// Returns a mesh as OFF.
pub fn off(mesh: &Mesh) -> String {
    let mut text = format!("OFF\n{} {} 0\n", mesh.vertices.len(), mesh.faces.len());
    mesh.vertices.iter().for_each(|v| {
        let _ = writeln!(text, "{}", row(v));
    });
    mesh.faces.iter().for_each(|f| {
        let _ = writeln!(text, "{} {}", f.len(), row(f));
    });
    text
}

/// Returns a mesh as PLY, in text.
pub fn ply(mesh: &Mesh) -> String {
    let mut text = ply_header(mesh, "ascii");
    mesh.vertices.iter().for_each(|v| {
        let _ = writeln!(text, "{}", row(v));
    });
    mesh.faces.iter().for_each(|f| {
        let _ = writeln!(text, "{} {}", f.len(), row(f));
    });
    text
}

fn ply_header(mesh: &Mesh, format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment it\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.faces.len()
    )
}

/// Returns a mesh as binary PLY.
pub fn binary_ply(mesh: &Mesh, big: bool) -> Vec<u8> {
    let mut bytes =
        ply_header(mesh, if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    for x in mesh.vertices.iter().flatten() {
        bytes.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
    }
    for face in &mesh.faces {
        bytes.push(face.len() as u8);
        for corner in face {
            let corner = *corner as i32;
            bytes.extend(if big { corner.to_be_bytes() } else { corner.to_le_bytes() });
        }
    }
    bytes
}

/// Returns the triangles of a mesh as STL, in text.
pub fn stl(mesh: &Mesh) -> String {
    let mut text = String::from("solid it\n");
    for [a, b, c] in corners(mesh) {
        let _ = writeln!(text, "facet normal 0 0 1\nouter loop");
        [a, b, c].iter().for_each(|v| {
            let _ = writeln!(text, "vertex {}", row(v));
        });
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid it\n"
}

/// Returns the triangles of a mesh as binary STL.
pub fn binary_stl(mesh: &Mesh) -> Vec<u8> {
    let corners = corners(mesh);
    let mut bytes = vec![b' '; 80];
    bytes.extend((corners.len() as u32).to_le_bytes());
    for triangle in corners {
        bytes.extend([0; 12]);
        for x in triangle.iter().flatten() {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// Returns the corners of the triangles that faces are split into.
fn corners(mesh: &Mesh) -> Vec<[[f64; 3]; 3]> {
    let triangles = modl::formats::triangles(&mesh.faces);
    triangles.iter().map(|t| t.map(|corner| mesh.vertices[corner as usize])).collect()
}

/// Returns the vertices of a mesh as XYZ.
pub fn xyz(mesh: &Mesh) -> String {
    mesh.vertices.iter().map(|v| format!("{} 0.5\n", row(v))).collect()
}

/// Returns a mesh as FOLD.
pub fn fold(mesh: &Mesh) -> String {
    serde_json::json!({
        "file_spec": 1.2,
        "vertices_coords": mesh.vertices,
        "faces_vertices": mesh.faces,
        "file_frames": [{ "frame_inherit": true, "vertices_coords": mesh.vertices }],
    })
    .to_string()
}

/// Returns a file as its ending, a line break and its bytes: right, or damaged.
pub fn file(dice: &mut Dice) -> Vec<u8> {
    let mesh = mesh(dice);
    let (ending, bytes) = match dice.below(8) {
        0 => ("obj", obj(&mesh).into_bytes()),
        1 => ("off", off(&mesh).into_bytes()),
        2 => ("ply", ply(&mesh).into_bytes()),
        3 => ("ply", binary_ply(&mesh, dice.below(2) == 1)),
        4 => ("stl", stl(&mesh).into_bytes()),
        5 => ("stl", binary_stl(&mesh)),
        6 => ("fold", fold(&mesh).into_bytes()),
        _ => ("xyz", xyz(&mesh).into_bytes()),
    };
    let bytes = match (dice.below(4), std::str::from_utf8(&bytes)) {
        (0, _) => bytes,
        (1 | 2, Ok(text)) => damaged(dice, text).into_bytes(),
        _ => damaged_bytes(dice, &bytes),
    };
    [ending.as_bytes(), b"\n", &bytes].concat()
}
