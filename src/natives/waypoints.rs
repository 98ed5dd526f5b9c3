//! `waypoints`: the shortest way over the ground among the obstacles of a scene, as it is called.

use super::Native;
use crate::geometry::Vec3;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::planners::RequestedProgress;
use crate::planners::planar_path::{Problem, Refusal, Settings, plan};
use crate::source::{Diagnostic, code};
use crate::units::Dimension;

/// The built-in `waypoints`: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] =
    &[Native::pure("waypoints", parameters![scene: &Value, from: Vec3, to: Vec3, clearance: f64], waypoints)];

/// Runs `waypoints`: the points at which the shortest way turns, at the height of `from`.
///
/// # Errors
/// A fault where the clearance is negative, an end of the way is too close to an obstacle, there is no way, or the
/// obstacles have too many corners.
fn waypoints(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (from, to) = (call.get::<Vec3>("from")?, call.get::<Vec3>("to")?);
    let clearance: f64 = call.get("clearance")?;
    if clearance < 0.0 {
        return Err(call.refuse("clearance", "the clearance must not be negative"));
    }
    // A part of a scene, or one of its ports, stands for the scene that it belongs to.
    let scene = match call.arg("scene") {
        Value::Instance(instance) => &instance.robot,
        Value::Port(port) => &port.robot,
        _ => return Ok(Value::Unknown),
    };
    let obstacles = scene.design.obstacles();
    let problem = Problem { obstacles: &obstacles, from: [from.x, from.y], to: [to.x, to.y], clearance };
    let path = plan(&problem, &Settings::default(), &mut RequestedProgress)
        .map_err(|refusal| refused(&refusal, call))?;
    let point = |[x, y]: [f64; 2]| Value::Vec3(Vec3::new(x, y, from.z), Dimension::LENGTH);
    Ok(Value::list(path.points.into_iter().map(point).collect()))
}

/// Returns the fault of a refusal, at the argument that it is about.
fn refused(refusal: &Refusal, call: &Call) -> Stop {
    let message = refusal.to_string();
    let at = match refusal {
        Refusal::Start { .. } => "from",
        Refusal::Goal { .. } | Refusal::Enclosed { .. } => "to",
        Refusal::Corners { .. } => {
            return fault(code::SIZE_LIMIT, call.at("scene"), message, "too many corners");
        }
        Refusal::Stopped => return call.refuse("scene", message),
    };
    let label = match refusal {
        Refusal::Enclosed { .. } => "no way leads here",
        _ => "this is closer than the clearance",
    };
    Diagnostic::error(code::BAD_VALUE, message)
        .label(call.at(at), label)
        .hint("with a smaller `clearance` there may be a way; it is measured from the middle of what moves")
        .into()
}
