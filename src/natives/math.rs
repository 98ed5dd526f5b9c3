//! Built-ins about numbers, vectors and poses.

use super::Native;
use crate::geometry::{Pose, Vec3};
use crate::interpret::argument::{Positive, parameters};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{Measure, SignalValue, Value};
use crate::source::code;
use crate::units::Dimension;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{FromPrimitive, Signed, Zero};
use std::cmp::Ordering;
use std::rc::Rc;

/// The built-ins for numbers and vectors, such as `abs`, `atan2` and `cross`: the key of each with its parameters and
/// its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("abs", parameters![x: &Value], abs),
    Native::pure("sign", parameters![x: f64], sign),
    Native::pure("min", parameters![values: &[Value]], |_, call| extreme(call, Ordering::Less)),
    Native::pure("max", parameters![values: &[Value]], |_, call| extreme(call, Ordering::Greater)),
    Native::pure("clamp", parameters![x: f64, to: (f64, f64)], clamp),
    Native::pure("sqrt", parameters![x: f64], sqrt),
    Native::pure("sin", parameters![x: f64], |_, call| to_number(call, libm::sin)),
    Native::pure("cos", parameters![x: f64], |_, call| to_number(call, libm::cos)),
    Native::pure("tan", parameters![x: f64], |_, call| to_number(call, libm::tan)),
    Native::pure("asin", parameters![x: f64], |_, call| from_ratio(call, libm::asin)),
    Native::pure("acos", parameters![x: f64], |_, call| from_ratio(call, libm::acos)),
    Native::pure("atan", parameters![x: f64], |_, call| Ok(angle(libm::atan(call.get::<f64>("x")?)))),
    Native::pure("atan2", parameters![y: f64, x: f64], |_, call| {
        Ok(angle(libm::atan2(call.get::<f64>("y")?, call.get::<f64>("x")?)))
    }),
    Native::pure("exp", parameters![x: f64], |_, call| finite(call, libm::exp(call.get::<f64>("x")?))),
    Native::pure("ln", parameters![x: Positive], |_, call| {
        Ok(Value::number(libm::log(call.positive("x", "what `ln` takes")?)))
    }),
    Native::pure("floor", parameters![x: f64], |_, call| whole(call, libm::floor)),
    Native::pure("ceil", parameters![x: f64], |_, call| whole(call, libm::ceil)),
    Native::pure("round", parameters![x: f64], |_, call| whole(call, libm::round)),
    Native::pure("div", parameters![a: &Value, b: &Value], div),
    Native::pure("sum", parameters![list: &[Value]], sum),
    Native::pure("norm", parameters![v: Vec3], norm),
    Native::pure("dot", parameters![a: Vec3, b: Vec3], dot),
    Native::pure("cross", parameters![a: Vec3, b: Vec3], cross),
    Native::pure("position", parameters![pose: &Value], position),
    Native::pure("direction", parameters![pose: Pose, axis: Vec3], |_, call| {
        Ok(Value::Vec3(call.get::<Pose>("pose")?.rotation * call.get::<Vec3>("axis")?, Dimension::NUMBER))
    }),
];

fn position(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(match call.get::<&Value>("pose")? {
        Value::Pose(pose) => Value::Vec3(pose.translation.vector, Dimension::LENGTH),
        Value::Signal(signal) => {
            let Measure::Pose(frame) = signal.measure else {
                unreachable!("no other signal is one of poses")
            };
            let (robot, measure) = (signal.robot.clone(), Measure::Position(frame));
            Value::Signal(Rc::new(SignalValue { robot, measure }))
        }
        _ => unreachable!("`check` lets only poses and their signals through"),
    })
}

fn angle(x: f64) -> Value {
    Value::Quantity(x, Dimension::ANGLE)
}

fn finite(call: &Call, x: f64) -> Eval<Value> {
    if x.is_finite() { Ok(Value::number(x)) } else { Err(call.refuse("x", "the result is no finite number")) }
}

fn to_number(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    finite(call, function(call.get("x")?))
}

/// Returns the angle that `function` gives for the argument `x`.
///
/// # Errors
/// A fault where `x` is outside -1..1.
fn from_ratio(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    let x: f64 = call.get("x")?;
    if (-1.0..=1.0).contains(&x) { Ok(angle(function(x))) } else { Err(call.refuse("x", "outside -1..1")) }
}

fn whole(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    match call.arg("x") {
        whole @ (Value::Int(_) | Value::Big(_)) => Ok(whole.clone()),
        _ => {
            let x = function(call.get("x")?);
            BigInt::from_f64(x).map(Value::whole).ok_or_else(|| call.refuse("x", "no finite number"))
        }
    }
}

fn abs(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    match call.arg("x") {
        Value::Quantity(x, d) => Ok(Value::Quantity(x.abs(), *d)),
        other => other
            .as_big()
            .map(|n| Value::whole(n.abs()))
            .ok_or_else(|| call.refuse("x", "a number is wanted")),
    }
}

fn sign(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let x = call.get::<f64>("x")?;
    Ok(Value::Int(if x > 0.0 { 1 } else { -i64::from(x < 0.0) }))
}

fn extreme(call: &Call, wanted: Ordering) -> Eval<Value> {
    let list: &[Value] = call.get("values")?;
    let mut best: Option<&Value> = None;
    for value in list.iter() {
        if best.is_none_or(|b| order(value, b) == Some(wanted)) {
            best = Some(value);
        }
    }
    best.cloned().ok_or_else(|| call.refuse("values", "an empty list has neither least nor greatest"))
}

/// Returns the order of two numbers, in SI units if they are quantities, exactly among whole numbers; `None` for other
/// values, and for NaN.
pub(super) fn order(a: &Value, b: &Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Int(x), Value::Int(y)) => Some(x.cmp(y)),
        (Value::Int(_) | Value::Big(_), Value::Int(_) | Value::Big(_)) => Some(a.as_big()?.cmp(&b.as_big()?)),
        _ => a.as_number()?.partial_cmp(&b.as_number()?),
    }
}

fn clamp(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (low, high) = call.get::<(f64, f64)>("to")?;
    if low > high {
        return Err(call.refuse("to", "the range ends before it begins"));
    }
    let dimension = call.arg("x").as_dimension().unwrap_or(Dimension::NUMBER);
    Ok(Value::Quantity(call.get::<f64>("x")?.clamp(low, high), dimension))
}

fn sqrt(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let x = call.get::<f64>("x")?;
    let dimension = call.arg("x").as_dimension().and_then(|d| d.root(2));
    match dimension {
        Some(dimension) if x >= 0.0 => Ok(Value::Quantity(libm::sqrt(x), dimension)),
        Some(_) => Err(call.refuse("x", "a negative number has no square root")),
        None => Err(call.refuse("x", "the square root has no dimension")),
    }
}

fn div(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (Some(a), Some(b)) = (call.arg("a").as_big(), call.arg("b").as_big()) else {
        return Err(call.refuse("a", "whole numbers are wanted"));
    };
    if b.is_zero() {
        return Err(fault(code::DIVISION_BY_ZERO, call.at("b"), "division by zero", "this is zero"));
    }
    // Euclidean: the remainder is never negative.
    let quotient = a.div_floor(&b);
    let remainder = &a - &quotient * &b;
    Ok(Value::whole(if remainder.is_negative() { quotient + 1 } else { quotient }))
}

fn sum(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let list = call.get::<&[Value]>("list")?;
    if list.iter().all(|v| v.as_big().is_some()) {
        return Ok(Value::whole(list.iter().filter_map(Value::as_big).sum()));
    }
    let dimension = list.iter().find_map(|v| match v {
        Value::Quantity(_, d) => Some(*d),
        _ => None,
    });
    let total = list.iter().map(|v| v.as_number().ok_or_else(|| call.refuse("list", "numbers are wanted")));
    let total = total.sum::<Result<f64, Stop>>()?;
    Ok(Value::Quantity(total, dimension.unwrap_or(Dimension::NUMBER)))
}

fn vector_dimension(call: &Call, vector: &str) -> Dimension {
    call.arg(vector).as_dimension().unwrap_or(Dimension::NUMBER)
}

fn norm(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Quantity(call.get::<Vec3>("v")?.norm(), vector_dimension(call, "v")))
}

fn product_dimension(call: &Call) -> Eval<Dimension> {
    let product = vector_dimension(call, "a").times(vector_dimension(call, "b"));
    product.ok_or_else(|| call.refuse("a", "the product has no dimension"))
}

fn dot(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Quantity(call.get::<Vec3>("a")?.dot(&call.get::<Vec3>("b")?), product_dimension(call)?))
}

fn cross(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Vec3(call.get::<Vec3>("a")?.cross(&call.get::<Vec3>("b")?), product_dimension(call)?))
}
