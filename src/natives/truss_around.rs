//! The surroundings that a call of `morph` or `locomote` names: obstacles and terrain.

use crate::geometry::{HeightField, Placed};
use crate::interpret::native::Call;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;

/// The shapes of each obstacle, in the world's frame.
pub fn obstacles(call: &Call, index: usize) -> Eval<Vec<Vec<Placed>>> {
    let shape = |value: &Value| match value {
        Value::Shape(shape) => Ok(shape.parts.clone()),
        _ => Err(call.refuse(index, "shapes are wanted")),
    };
    call.list(index)?.iter().map(shape).collect()
}

/// The ground, where it is not flat.
pub fn terrain(call: &Call, index: usize) -> Eval<Option<HeightField>> {
    match call.arg(index) {
        Value::Missing => Ok(None),
        Value::Terrain(field) => Ok(Some((**field).clone())),
        _ => Err(call.refuse(index, "a terrain is wanted")),
    }
}
