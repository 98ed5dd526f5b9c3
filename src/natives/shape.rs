//! Built-ins that make shapes and kinds of joints.

use super::Native;
use super::mesh_file;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Placed, Pose, Shape, Vec3, soundness};
use crate::interpret::argument::{Positive, parameters};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{JointSpec, Solid, Value};
use crate::robot::{JointKind, Limits, Servo, Surface};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

/// The greatest number of shapes of one solid.
const SHAPES_MAX: usize = 1000;

/// Lists the parameters of a solid: its own, and those that all solids have.
macro_rules! solid_parameters {
    ($($name:ident: $type:ty),*) => {
        parameters![$($name: $type,)* mass: Option<Positive>, com: Option<Vec3>, inertia: Option<Vec3>, friction: f64, static_friction: Option<f64>, contact_stiffness: Option<Positive>]
    };
}

/// The built-ins for shapes and kinds of joints, such as `box`, `hull` and `revolute`: the key of each with its
/// parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("box", solid_parameters![x: f64, y: f64, z: f64], cuboid),
    Native::pure("cylinder", solid_parameters![radius: f64, length: f64, axis: Vec3], cylinder),
    Native::pure("sphere", solid_parameters![radius: f64], sphere),
    Native::pure("capsule", solid_parameters![radius: f64, length: f64, axis: Vec3], capsule),
    Native::pure("prism", solid_parameters![outline: &[Value], height: Positive], prism),
    Native::pure("hull", solid_parameters![points: &[Value]], hull),
    Native::pure("mesh", solid_parameters![file: &str, scale: Positive], mesh),
    Native::pure("union", solid_parameters![shapes: &[Value]], union),
    Native::pure("placed", parameters![shape: &Solid, at: Vec3, axis: Vec3, turn: f64], placed),
    Native::pure(
        "revolute",
        parameters![axis: Vec3, range: Option<(f64, f64)>, max_speed: Option<Positive>, max_accel: Option<Positive>, max_torque: Option<Positive>, stiffness: Option<Positive>, armature: Option<Positive>, damping: Option<Positive>, no_load_speed: Option<Positive>, passive: bool],
        revolute,
    ),
    Native::pure(
        "prismatic",
        parameters![axis: Vec3, range: Option<(f64, f64)>, max_speed: Option<Positive>, max_accel: Option<Positive>, max_force: Option<Positive>, stiffness: Option<Positive>, armature: Option<Positive>, damping: Option<Positive>, no_load_speed: Option<Positive>, passive: bool],
        prismatic,
    ),
    Native::pure("fixed", parameters![], fixed),
];

fn cuboid(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let size = Vec3::new(call.get::<f64>("x")?, call.get::<f64>("y")?, call.get::<f64>("z")?);
    solid(call, Shape::Box { size })
}

fn cylinder(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (radius, length) = (call.get::<f64>("radius")?, call.get::<f64>("length")?);
    solid(call, Shape::Cylinder { radius, length, axis: axis(call, "axis")? })
}

fn sphere(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    solid(call, Shape::Sphere { radius: call.get::<f64>("radius")? })
}

fn capsule(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (radius, length) = (call.get::<f64>("radius")?, call.get::<f64>("length")?);
    solid(call, Shape::Capsule { radius, length, axis: axis(call, "axis")? })
}

fn prism(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let height = call.positive("height", "the height of a prism")?;
    let outline = points(call, "outline")?;
    if !convex(&outline) {
        let label = "the outline turns both ways, or crosses itself";
        return Err(Diagnostic::error(code::BAD_SHAPE, "the outline of a prism must be convex")
            .label(call.at("outline"), label)
            .hint("make it a `union` of convex prisms")
            .into());
    }
    let end = |z: f64| outline.iter().map(move |p| Vec3::new(p.x, p.y, z));
    solid(call, Shape::Hull { points: end(-height / 2.0).chain(end(height / 2.0)).collect() })
}

/// Returns true if a closed outline (x and y of its corners) turns in one direction only, and once.
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

/// Threshold: corners that turn by less than this (rad) are straight: rounding.
const TOL_TURN: f64 = 1e-9;

fn hull(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    solid(call, Shape::Hull { points: points(call, "points")? })
}

fn union(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut parts = Vec::new();
    for shape in call.get::<&[Value]>("shapes")?.iter() {
        if let Value::Shape(shape) = shape {
            parts.extend(shape.parts.iter().cloned());
        }
        if parts.len() > SHAPES_MAX {
            let message = format!("a union of more than {SHAPES_MAX} shapes");
            return Err(fault(code::SIZE_LIMIT, call.span, message, "the limit is passed here"));
        }
    }
    if parts.is_empty() {
        return Err(fault(code::BAD_SHAPE, call.span, "a union of no shapes is no solid", "no shapes"));
    }
    with_options(call, parts)
}

fn mesh(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let scale = call.positive("scale", "the scale of a mesh")?;
    let (path, read) = mesh_file::read(interpreter, call, "file", scale)?;
    let (vertices, triangles) = (read.vertices, crate::formats::triangles(&read.faces));
    solid(call, Shape::Mesh { name: path, vertices, triangles })
}

fn placed(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let shape: &Solid = call.get("shape")?;
    let pose = shifted(call.get::<Vec3>("at")?) * turned(axis(call, "axis")?, call.get::<f64>("turn")?);
    let parts = shape.parts.iter().map(|p| Placed { pose: pose * p.pose, shape: p.shape.clone() });
    Ok(Value::Shape(Rc::new(Solid { parts: parts.collect(), ..Solid::default() })))
}

/// Returns the argument `name` as a unit vector.
///
/// # Errors
/// A fault where it is zero.
fn axis(call: &Call, name: &str) -> Eval<Vec3> {
    let axis: Vec3 = call.get(name)?;
    axis.try_normalize(0.0).ok_or_else(|| call.refuse(name, "the axis must not be zero"))
}

/// Returns the points of the list in the argument `name`, in its order, m.
///
/// # Errors
/// A fault where something else is in the list.
pub(super) fn points(call: &Call, name: &str) -> Eval<Vec<Vec3>> {
    let point = |value: &Value| match value {
        Value::Vec3(p, _) => Ok(*p),
        _ => Err(call.refuse(name, "points are wanted")),
    };
    call.get::<&[Value]>(name)?.iter().map(point).collect()
}

/// Returns a solid of one shape, with the options of the call.
///
/// # Errors
/// A fault where the shape is not sound, or an option is out of range.
fn solid(call: &Call, shape: Shape) -> Eval<Value> {
    soundness::check(&shape)
        .map_err(|unsound| fault(code::BAD_SHAPE, call.span, unsound.to_string(), "this is no solid"))?;
    with_options(call, vec![Placed { pose: Pose::identity(), shape }])
}

/// Returns a solid of these parts with the mass, centre of mass, moments of inertia and friction of the call.
///
/// # Errors
/// A fault where a moment of inertia is not positive, friction is negative, or static friction is below it.
fn with_options(call: &Call, parts: Vec<Placed>) -> Eval<Value> {
    let inertia: Option<Vec3> = call.get("inertia")?;
    if let Some(moments) = inertia
        && moments.iter().any(|m| *m <= 0.0)
    {
        return Err(call.refuse("inertia", "moments of inertia must be positive"));
    }
    let friction: f64 = call.get("friction")?;
    if friction < 0.0 {
        return Err(call.refuse("friction", "friction must not be negative"));
    }
    let static_friction: Option<f64> = call.get("static_friction")?;
    if static_friction.is_some_and(|sticking| sticking < friction) {
        let message = "static friction must not be below `friction`";
        return Err(call.refuse("static_friction", message));
    }
    let stiffness = call.positive_if("contact_stiffness", "a stiffness")?;
    Ok(Value::Shape(Rc::new(Solid {
        parts,
        surface: Surface { static_friction, stiffness },
        mass: call.positive_if("mass", "a mass")?,
        com: call.get("com")?,
        inertia: inertia.map(|m| [m.x, m.y, m.z, 0.0, 0.0, 0.0]),
        friction: Some(friction),
    })))
}

fn revolute(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    joint(call, JointKind::Revolute, "max_torque")
}

fn prismatic(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    joint(call, JointKind::Prismatic, "max_force")
}

/// Returns a kind of joint with its axis and limits; `max_effort`: the parameter of its greatest force or
/// torque.
fn joint(call: &Call, kind: JointKind, max_effort: &str) -> Eval<Value> {
    let limits = Limits {
        range: call.get("range")?,
        speed: call.positive_if("max_speed", "a greatest speed")?,
        acceleration: call.positive_if("max_accel", "a greatest acceleration")?,
        effort: call.positive_if(max_effort, "a greatest torque or force")?,
    };
    if let Some((low, high)) = limits.range
        && low > high
    {
        let label = "write the lower end first";
        return Err(fault(code::BAD_MODULE, call.at("range"), "the range ends before it begins", label));
    }
    let servo = Servo {
        stiffness: call.positive_if("stiffness", "a stiffness")?,
        armature: call.positive_if("armature", "an inertia of the rotor")?,
        damping: call.positive_if("damping", "a damping")?,
        no_load_speed: call.positive_if("no_load_speed", "a speed without load")?,
    };
    let (axis, passive) = (axis(call, "axis")?, call.get("passive")?);
    Ok(Value::JointKind(Rc::new(JointSpec { kind, axis, limits, passive, servo })))
}

fn fixed(_: &mut Interpreter, _: &Call) -> Eval<Value> {
    let spec = JointSpec::fixed();
    Ok(Value::JointKind(Rc::new(spec)))
}

/// Returns the shapes of each obstacle in the argument `around`, placed in the world's frame (m).
///
/// # Errors
/// A fault where one of them is no shape.
pub(super) fn obstacles(call: &Call, around: &[Value]) -> Eval<Vec<Vec<Placed>>> {
    let shape = |value: &Value| match value {
        Value::Shape(shape) => Ok(shape.parts.clone()),
        _ => Err(call.refuse("obstacles", "shapes are wanted")),
    };
    around.iter().map(shape).collect()
}
