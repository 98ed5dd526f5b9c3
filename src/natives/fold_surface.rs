//! The surface that `fold` and `refold` are given.

use crate::geometry::{Placed, Shape, Vec3};
use crate::interpret::native::Call;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::planners::fold::{Target, Unfoldable};
use crate::source::{Diagnostic, code};

/// Returns the shape in argument `key`, a mesh, as the target of a folding; lengths in m.
///
/// # Errors
/// A fault where it is not a surface of polygons, or one that does not fold.
pub(super) fn target(call: &Call, key: &'static str, shape: &Value) -> Eval<Target> {
    let (vertices, faces) = surface(call, key, shape)?;
    Target::new(vertices, &faces).map_err(|why| unfoldable(call, key, &why).into())
}

/// Returns the diagnostic for a shape in the argument `key` that does not fold, for the reason `why`.
pub(super) fn unfoldable(call: &Call, key: &'static str, why: &Unfoldable) -> Diagnostic {
    Diagnostic::error(code::UNFOLDABLE, why.to_string())
        .label(call.at(key), "does not fold")
        .hint(why.remedy())
}

/// Returns the vertices (m) and faces (indices of vertices) of a mesh, or of a shape that is one mesh.
///
/// # Errors
/// A fault for other values.
fn surface(call: &Call, key: &'static str, shape: &Value) -> Eval<(Vec<Vec3>, Vec<Vec<usize>>)> {
    match shape {
        Value::Mesh(mesh) => return Ok((mesh.vertices.clone(), mesh.faces.clone())),
        Value::Shape(solid) => {
            if let [Placed { pose, shape: Shape::Mesh { vertices, triangles, .. } }] = &solid.parts[..] {
                let place = |p: &Vec3| pose.transform_point(&(*p).into()).coords;
                let corners = |t: &[u32; 3]| t.iter().map(|corner| *corner as usize).collect();
                return Ok((vertices.iter().map(place).collect(), triangles.iter().map(corners).collect()));
            }
        }
        _ => {}
    }
    Err(call.refuse(key, "a surface of polygons is wanted: a mesh, or a shape from a mesh file"))
}
