//! A crease pattern as a file of the FOLD format, version 1.2: the flat net as key frame, which stands
//! alone for programs that know no frames, and what is folded after every step as further frames.

use serde_json::{Map, Value, json};

/// What the file says of its lengths.
const MILLIMETRES: f64 = 1e3;

/// Angles smaller than this are no fold, rad.
const ANGLE_MIN: f64 = 1e-9;

/// A sheet with its creases.
#[derive(Clone, Debug, Default)]
pub struct CreasePattern {
    pub title: String,
    /// In the plane, m; the sheet is seen from what will be outside.
    pub vertices: Vec<[f64; 2]>,
    /// Counterclockwise.
    pub faces: Vec<[usize; 3]>,
    /// By face: the module that it is.
    pub modules: Vec<String>,
    pub edges: Vec<Crease>,
    /// Where the vertices are after each step, m.
    pub folded: Vec<Vec<[f64; 3]>>,
}

#[derive(Clone, Debug)]
pub struct Crease {
    pub vertices: [usize; 2],
    /// One for outline, two for a hinge.
    pub faces: Vec<usize>,
    /// Of a hinge, rad: positive where it becomes convex, seen from outside. `None` for outline.
    pub angle: Option<f64>,
    /// The step in which it folds, from 1.
    pub step: Option<usize>,
    /// The edge that meets this one when all is folded.
    pub glued: Option<usize>,
}

impl Crease {
    /// Seen from outside a convex hinge is a mountain; outline is a boundary.
    fn assignment(&self) -> &'static str {
        match self.angle {
            None => "B",
            Some(angle) if angle.abs() < ANGLE_MIN => "F",
            Some(angle) if angle > 0.0 => "M",
            Some(_) => "V",
        }
    }

    /// Degrees; the format counts valleys positive.
    fn fold_angle(&self) -> Value {
        // Adding zero leaves no negative one.
        self.angle.map_or(Value::Null, |angle| json!(-angle.to_degrees() + 0.0))
    }
}

/// The text of the file.
pub fn fold_file(pattern: &CreasePattern) -> String {
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
