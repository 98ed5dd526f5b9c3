//! Crease patterns in the FOLD file format, version 1.2. The flat net is the key frame, which stands alone
//! for programs that ignore frames; the folded state after each step is a further frame.

use serde_json::{Map, Value, json};

/// Millimetres per metre; the file states its unit as mm.
const MILLIMETRES: f64 = 1e3;

/// Angles smaller than this are flat creases, in radians.
const ANGLE_MIN: f64 = 1e-9;

/// A crease pattern, as a FOLD file (Demaine, Ku and Lang 2016) holds it: a sheet of polygons with its creases and its
/// folded states.
#[derive(Clone, Debug, Default)]
pub struct CreasePattern {
    /// The title of the FOLD file.
    pub title: String,
    /// The vertices in the plane of the sheet, in metres, seen from the side that becomes the outside.
    pub vertices: Vec<[f64; 2]>,
    /// The faces as indices into `vertices`, from 0, counterclockwise.
    pub faces: Vec<Vec<usize>>,
    /// The name of the module of each face, one for each of `faces`.
    pub modules: Vec<String>,
    /// The hinges that fold and the edges of the outline, in any order.
    pub edges: Vec<Crease>,
    /// The positions (x, y, z) of all vertices after each step, in metres; one list for each step, without the flat
    /// state, in the order of `vertices`. The face that keeps its pose lies in the plane z = 0, as in the flat sheet.
    pub folded: Vec<Vec<[f64; 3]>>,
}

/// An edge of a crease pattern: a hinge between two faces, or a boundary edge.
#[derive(Clone, Debug)]
pub struct Crease {
    /// The indices of the two ends in [`CreasePattern::vertices`], from 0.
    pub vertices: [usize; 2],
    /// The adjacent faces as indices in [`CreasePattern::faces`], from 0: one for a boundary edge, two for a hinge.
    pub faces: Vec<usize>,
    /// The fold angle of a hinge at the end, in radians: positive where the fold is convex as seen from
    /// outside. `None` for a boundary edge.
    pub angle: Option<f64>,
    /// The step in which the hinge folds, from 1; `None` if it never folds.
    pub step: Option<usize>,
    /// The index, from 0, in [`CreasePattern::edges`] of the boundary edge that coincides with this one in the folded
    /// state; `None` for a hinge, and for a boundary edge of the folded surface.
    pub glued: Option<usize>,
}

impl Crease {
    /// Returns the assignment of the FOLD format: `B` boundary, `F` flat, `M` mountain (convex as seen from outside),
    /// `V` valley.
    fn assignment(&self) -> &'static str {
        match self.angle {
            None => "B",
            Some(angle) if angle.abs() < ANGLE_MIN => "F",
            Some(angle) if angle > 0.0 => "M",
            Some(_) => "V",
        }
    }

    /// Returns the fold angle in degrees. FOLD counts valleys positive.
    fn fold_angle(&self) -> Value {
        // Adding zero leaves no negative one.
        self.angle.map_or(Value::Null, |angle| json!(-angle.to_degrees() + 0.0))
    }
}

/// Returns a crease pattern as the text of a FOLD file, with lengths in millimetres and angles in degrees as the format
/// has them.
pub(super) fn write(pattern: &CreasePattern) -> String {
    let edges = &pattern.edges;
    let by_edge = |value: &dyn Fn(&Crease) -> Value| Value::Array(edges.iter().map(value).collect());
    let mut file = Map::new();
    let mut put = |key: &str, value: Value| file.insert(key.to_owned(), value);
    put("file_spec", json!(1.2));
    put("file_creator", json!(concat!("modl ", env!("CARGO_PKG_VERSION"))));
    put("file_classes", json!(["singleModel", "animation"]));
    put("frame_title", json!(pattern.title));
    put("frame_classes", json!(["creasePattern"]));
    put("frame_attributes", json!(["2D", "manifold", "orientable"]));
    put("frame_unit", json!("mm"));
    put("vertices_coords", json!(pattern.vertices.iter().map(|v| v.map(millimetres)).collect::<Vec<_>>()));
    put("edges_vertices", by_edge(&|e| json!(e.vertices)));
    put("edges_faces", by_edge(&|e| json!([Some(e.faces[0]), e.faces.get(1).copied()])));
    put("edges_assignment", by_edge(&|e| json!(e.assignment())));
    put("edges_foldAngle", by_edge(&|e| e.fold_angle()));
    put("edges_modl:step", by_edge(&|e| json!(e.step)));
    put("edges_modl:gluedTo", by_edge(&|e| json!(e.glued)));
    put("faces_vertices", json!(pattern.faces));
    put("faces_modl:module", json!(pattern.modules));
    let frames = pattern.folded.iter().enumerate().map(|(step, vertices)| {
        json!({
            "frame_title": format!("after step {}", step + 1),
            "frame_classes": ["foldedForm"],
            "frame_attributes": ["3D"],
            "frame_parent": 0,
            "frame_inherit": true,
            "vertices_coords": vertices.iter().map(|v| v.map(millimetres)).collect::<Vec<_>>(),
        })
    });
    put("file_frames", Value::Array(frames.collect()));
    serde_json::to_string_pretty(&Value::Object(file)).expect("numbers and texts are JSON") + "\n"
}

fn millimetres(x: f64) -> f64 {
    x * MILLIMETRES + 0.0
}
