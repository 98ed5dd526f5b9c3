//! `fastest`: a plan along its path in least time, as it is called.

use super::Native;
use crate::behavior::ContractInterval;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::plan::{CheckKind, retimed};
use crate::planners::fastest::{Problem, Refusal, Settings, plan};
use crate::planners::{RequestedProgress, Solution};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

/// The built-in `fastest`, which retimes a plan: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] =
    &[Native::on_run("fastest", parameters![plan: &Value, reserve: f64], fastest)];

/// Runs `fastest`: the plan of the same path in least time.
///
/// # Errors
/// A fault where the plan is not of a robot with joints or is not sound, the reserve is not from 0 to below 1, a joint
/// states no greatest acceleration or moves along a curve of too high a degree, a load is too great at any speed, or
/// the new plan would last too long.
fn fastest(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = interpreter.plan_of(call.arg("plan"), call.at("plan"))? else {
        return Ok(Value::Unknown);
    };
    let settings = Settings { reserve: call.get("reserve")?, ..Settings::default() };
    crate::interrupt::start_task(format!("timing {}", planned.robot.name));
    let old = &planned.plan;
    let Solution { body, report, .. } = plan(&Problem { plan: old }, &settings, &mut RequestedProgress)
        .map_err(|refusal| refused(&refusal, call))?;
    let Some(tracks) = body.tracks() else { return Ok(Value::Unknown) };
    let new = retimed(old, tracks.clone(), &|time| report.clock.at(time), settings.reserve);
    let (robot, body) = (planned.robot.clone(), planned.body.clone());
    // Behaviours begin and end at the same places of the path.
    let clock = |time| report.clock.at(time);
    let later =
        |use_: &ContractInterval| ContractInterval { from: clock(use_.from), to: clock(use_.to), ..*use_ };
    let uses = planned.contracts().iter().map(later).collect();
    let new = PlanValue::new(robot, body, new, planned.causes.clone(), planned.actions)
        .with_uses(uses, planned.drops_contracts());
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(new)))))
}

/// Returns what mends a load that is too great at any speed.
fn held(refusal: &Refusal) -> &'static str {
    match refusal {
        Refusal::Unholdable { failure } if failure.kind == CheckKind::Balance => {
            "the robot tips at rest, too: keep its centre of mass over what it stands on"
        }
        Refusal::Unholdable { failure } if failure.kind == CheckKind::BondLoad => {
            "the bond bears too much at rest, too: hold less, or hold it nearer to the bond"
        }
        _ => "the share at rest is too great: hold less, hold it nearer, or state a stronger motor",
    }
}

/// Returns the fault of a refusal, at the argument that it is about.
fn refused(refusal: &Refusal, call: &Call) -> Stop {
    let at = call.at("plan");
    let message = refusal.to_string();
    match refusal {
        Refusal::Reserve => call.refuse("reserve", message),
        Refusal::NoAcceleration { joint, .. } => Diagnostic::error(code::BAD_VALUE, message)
            .label(at, format!("least time needs a limit of acceleration of {joint}"))
            .hint("state `max_accel` where the joint, or a motor that drives it, is declared: `max_accel: 20rad/s^2`")
            .into(),
        Refusal::Degree { .. } => Diagnostic::error(code::BAD_VALUE, message)
            .label(at, "this has polynomials of too high a degree, as retimed plans have")
            .hint("if so, retime the plan that it was made of: `fastest(a ++ b)` instead of `fastest(fastest(a) ++ b)`")
            .into(),
        Refusal::Overloaded { .. } | Refusal::Unholdable { .. } => {
            Diagnostic::error(code::TOO_HEAVY, message)
                .label(at, "no time is long enough for this")
                .hint(held(refusal))
                .into()
        }
        Refusal::Unsound(_) | Refusal::Family | Refusal::TooLong | Refusal::Stopped => {
            call.refuse("plan", message)
        }
    }
}
