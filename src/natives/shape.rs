//! Built-ins that make shapes and kinds of joints.

use super::{Native, pure};
use crate::formats::mesh_file;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Placed, Pose, Shape, Vec3, soundness};
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{JointSpec, Solid, Value};
use crate::robot::{JointKind, Limits};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

pub const TABLE: &[Native] = &[
    pure("box", 7, cuboid),
    pure("cylinder", 7, cylinder),
    pure("sphere", 5, sphere),
    pure("capsule", 7, capsule),
    pure("prism", 6, prism),
    pure("hull", 5, hull),
    pure("mesh", 6, mesh),
    pure("union", 5, union),
    pure("placed", 4, placed),
    pure("revolute", 6, revolute),
    pure("prismatic", 6, prismatic),
    pure("fixed", 0, fixed),
];

fn cuboid(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let size = Vec3::new(call.number(0)?, call.number(1)?, call.number(2)?);
    solid(call, 3, Shape::Box { size })
}

fn cylinder(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (radius, length) = (call.number(0)?, call.number(1)?);
    solid(call, 3, Shape::Cylinder { radius, length, axis: axis(call, 2)? })
}

fn sphere(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    solid(call, 1, Shape::Sphere { radius: call.number(0)? })
}

fn capsule(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (radius, length) = (call.number(0)?, call.number(1)?);
    solid(call, 3, Shape::Capsule { radius, length, axis: axis(call, 2)? })
}

fn prism(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let height = call.positive(1, "the height of a prism")?;
    let outline = points(call, 0)?;
    if !convex(&outline) {
        let label = "the outline turns both ways, or crosses itself";
        return Err(Diagnostic::error(code::BAD_SHAPE, "the outline of a prism must be convex")
            .label(call.at(0), label)
            .hint("make it a `union` of convex prisms")
            .into());
    }
    let end = |z: f64| outline.iter().map(move |p| Vec3::new(p.x, p.y, z));
    solid(call, 2, Shape::Hull { points: end(-height / 2.0).chain(end(height / 2.0)).collect() })
}

/// Whether a closed outline turns one way round, and once.
fn convex(outline: &[Vec3]) -> bool {
    let n = outline.len();
    let side = |i: usize| outline[(i + 1) % n].xy() - outline[i % n].xy();
    let turn = |i: usize| {
        let (a, b) = (side(i), side(i + 1));
        libm::atan2(a.x * b.y - a.y * b.x, a.dot(&b))
    };
    let turns: Vec<f64> = (0..n).filter(|&i| side(i).norm() > 0.0).map(turn).collect();
    let (least, greatest) = turns.iter().fold((0.0, 0.0), |(l, g): (f64, f64), t| (l.min(*t), g.max(*t)));
    let whole: f64 = turns.iter().sum();
    (least >= -TOL_TURN || greatest <= TOL_TURN) && whole.abs() < std::f64::consts::TAU + TOL_TURN
}

/// Corners that turn by less than this (rad) are straight.
const TOL_TURN: f64 = 1e-9;

fn hull(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    solid(call, 1, Shape::Hull { points: points(call, 0)? })
}

fn union(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut parts = Vec::new();
    for shape in call.list(0)?.iter() {
        if let Value::Shape(shape) = shape {
            parts.extend(shape.parts.iter().cloned());
        }
    }
    if parts.is_empty() {
        return Err(fault(code::BAD_SHAPE, call.span, "a union of no shapes is no solid", "no shapes"));
    }
    with_options(call, 1, parts)
}

fn mesh(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let scale = call.positive(1, "the scale of a mesh")?;
    let (path, read) = mesh_file::read(interpreter, call, 0, scale)?;
    let (vertices, triangles) = (read.vertices, mesh_file::triangles(&read.faces));
    solid(call, 2, Shape::Mesh { name: path, vertices, triangles })
}

fn placed(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Value::Shape(shape) = call.arg(0) else { return Err(call.refuse(0, "a shape is wanted")) };
    let pose = shifted(call.vec3(1)?) * turned(axis(call, 2)?, call.number(3)?);
    let parts = shape.parts.iter().map(|p| Placed { pose: pose * p.pose, shape: p.shape.clone() });
    Ok(Value::Shape(Rc::new(Solid { parts: parts.collect(), ..Solid::default() })))
}

/// A unit vector.
fn axis(call: &Call, index: usize) -> Eval<Vec3> {
    let axis = call.vec3(index)?;
    axis.try_normalize(0.0).ok_or_else(|| call.refuse(index, "the axis must not be zero"))
}

/// A list of points.
pub fn points(call: &Call, index: usize) -> Eval<Vec<Vec3>> {
    let point = |value: &Value| match value {
        Value::Vec3(p, _) => Ok(*p),
        _ => Err(call.refuse(index, "points are wanted")),
    };
    call.list(index)?.iter().map(point).collect()
}

fn solid(call: &Call, options: usize, shape: Shape) -> Eval<Value> {
    soundness::check(&shape)
        .map_err(|unsound| fault(code::BAD_SHAPE, call.span, unsound.to_string(), "this is no solid"))?;
    with_options(call, options, vec![Placed { pose: Pose::identity(), shape }])
}

/// `mass:`, `com:`, `inertia:`, `friction:`, which begin at parameter `first`.
fn with_options(call: &Call, first: usize, parts: Vec<Placed>) -> Eval<Value> {
    let vector = |index: usize| if call.is_missing(index) { Ok(None) } else { call.vec3(index).map(Some) };
    let inertia = vector(first + 2)?;
    if let Some(moments) = inertia
        && moments.iter().any(|m| *m <= 0.0)
    {
        return Err(call.refuse(first + 2, "moments of inertia must be positive"));
    }
    let friction = call.number(first + 3)?;
    if friction < 0.0 {
        return Err(call.refuse(first + 3, "friction must not be negative"));
    }
    Ok(Value::Shape(Rc::new(Solid {
        parts,
        mass: call.positive_if(first, "a mass")?,
        com: vector(first + 1)?,
        inertia: inertia.map(|m| [m.x, m.y, m.z, 0.0, 0.0, 0.0]),
        friction: Some(friction),
    })))
}

fn revolute(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    joint(call, JointKind::Revolute)
}

fn prismatic(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    joint(call, JointKind::Prismatic)
}

fn joint(call: &Call, kind: JointKind) -> Eval<Value> {
    let limits = Limits {
        range: call.range_if(1)?,
        speed: call.positive_if(2, "a greatest speed")?,
        acceleration: call.positive_if(3, "a greatest acceleration")?,
        effort: call.positive_if(4, "a greatest torque or force")?,
    };
    if let Some((low, high)) = limits.range
        && low > high
    {
        let label = "write the lower end first";
        return Err(fault(code::BAD_MODULE, call.at(1), "the range ends before it begins", label));
    }
    Ok(Value::JointKind(Rc::new(JointSpec { kind, axis: axis(call, 0)?, limits, passive: call.truth(5)? })))
}

fn fixed(_: &mut Interpreter, _: &Call) -> Eval<Value> {
    let spec =
        JointSpec { kind: JointKind::Fixed, axis: Vec3::z(), limits: Limits::default(), passive: true };
    Ok(Value::JointKind(Rc::new(spec)))
}
