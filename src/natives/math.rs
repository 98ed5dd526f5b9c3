//! Built-ins about numbers, vectors and poses.

use super::{Native, pure};
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::source::code;
use crate::units::Dimension;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{FromPrimitive, Signed, Zero};
use std::cmp::Ordering;

pub const TABLE: &[Native] = &[
    pure("abs", 1, abs),
    pure("sign", 1, sign),
    pure("min", 1, |_, call| extreme(call, Ordering::Less)),
    pure("max", 1, |_, call| extreme(call, Ordering::Greater)),
    pure("clamp", 2, clamp),
    pure("sqrt", 1, sqrt),
    pure("sin", 1, |_, call| to_number(call, libm::sin)),
    pure("cos", 1, |_, call| to_number(call, libm::cos)),
    pure("tan", 1, |_, call| to_number(call, libm::tan)),
    pure("asin", 1, |_, call| from_ratio(call, libm::asin)),
    pure("acos", 1, |_, call| from_ratio(call, libm::acos)),
    pure("atan", 1, |_, call| Ok(angle(libm::atan(call.number(0)?)))),
    pure("atan2", 2, |_, call| Ok(angle(libm::atan2(call.number(0)?, call.number(1)?)))),
    pure("exp", 1, |_, call| finite(call, libm::exp(call.number(0)?))),
    pure("ln", 1, |_, call| Ok(Value::number(libm::log(call.positive(0, "what `ln` takes")?)))),
    pure("floor", 1, |_, call| whole(call, libm::floor)),
    pure("ceil", 1, |_, call| whole(call, libm::ceil)),
    pure("round", 1, |_, call| whole(call, libm::round)),
    pure("div", 2, div),
    pure("sum", 1, sum),
    pure("norm", 1, norm),
    pure("dot", 2, dot),
    pure("cross", 2, cross),
    pure("position", 1, |_, call| Ok(Value::Vec3(pose(call)?.translation.vector, Dimension::LENGTH))),
    pure("direction", 2, |_, call| Ok(Value::Vec3(pose(call)?.rotation * call.vec3(1)?, Dimension::NUMBER))),
];

fn angle(x: f64) -> Value {
    Value::Quantity(x, Dimension::ANGLE)
}

fn finite(call: &Call, x: f64) -> Eval<Value> {
    if x.is_finite() { Ok(Value::number(x)) } else { Err(call.refuse(0, "the result is no finite number")) }
}

fn to_number(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    finite(call, function(call.number(0)?))
}

/// Of a number in -1..1, an angle.
fn from_ratio(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    let x = call.number(0)?;
    if (-1.0..=1.0).contains(&x) { Ok(angle(function(x))) } else { Err(call.refuse(0, "outside -1..1")) }
}

fn whole(call: &Call, function: fn(f64) -> f64) -> Eval<Value> {
    match call.arg(0) {
        Value::Int(_) | Value::Big(_) => Ok(call.arg(0).clone()),
        _ => {
            let x = function(call.number(0)?);
            BigInt::from_f64(x).map(Value::whole).ok_or_else(|| call.refuse(0, "no finite number"))
        }
    }
}

fn abs(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    match call.arg(0) {
        Value::Quantity(x, d) => Ok(Value::Quantity(x.abs(), *d)),
        other => {
            other.as_big().map(|n| Value::whole(n.abs())).ok_or_else(|| call.refuse(0, "a number is wanted"))
        }
    }
}

fn sign(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let x = call.number(0)?;
    Ok(Value::Int(if x > 0.0 { 1 } else { -i64::from(x < 0.0) }))
}

fn extreme(call: &Call, wanted: Ordering) -> Eval<Value> {
    let list = call.list(0)?;
    let mut best: Option<&Value> = None;
    for value in list.iter() {
        if best.is_none_or(|b| order(value, b) == Some(wanted)) {
            best = Some(value);
        }
    }
    best.cloned().ok_or_else(|| call.refuse(0, "an empty list has neither least nor greatest"))
}

/// Exact among whole numbers.
pub fn order(a: &Value, b: &Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Int(x), Value::Int(y)) => Some(x.cmp(y)),
        (Value::Int(_) | Value::Big(_), Value::Int(_) | Value::Big(_)) => Some(a.as_big()?.cmp(&b.as_big()?)),
        _ => a.as_number()?.partial_cmp(&b.as_number()?),
    }
}

fn clamp(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (low, high) = call.range(1)?;
    if low > high {
        return Err(call.refuse(1, "the range ends before it begins"));
    }
    let dimension = call.arg(0).as_dimension().unwrap_or(Dimension::NUMBER);
    Ok(Value::Quantity(call.number(0)?.clamp(low, high), dimension))
}

fn sqrt(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let x = call.number(0)?;
    let dimension = call.arg(0).as_dimension().and_then(Dimension::root);
    match dimension {
        Some(dimension) if x >= 0.0 => Ok(Value::Quantity(libm::sqrt(x), dimension)),
        Some(_) => Err(call.refuse(0, "a negative number has no square root")),
        None => Err(call.refuse(0, "the square root has no dimension")),
    }
}

fn div(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (Some(a), Some(b)) = (call.arg(0).as_big(), call.arg(1).as_big()) else {
        return Err(call.refuse(0, "whole numbers are wanted"));
    };
    if b.is_zero() {
        return Err(fault(code::DIVISION_BY_ZERO, call.at(1), "division by zero", "this is zero"));
    }
    // Euclidean: the remainder is never negative.
    let quotient = a.div_floor(&b);
    let remainder = &a - &quotient * &b;
    Ok(Value::whole(if remainder.is_negative() { quotient + 1 } else { quotient }))
}

fn sum(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let list = call.list(0)?;
    if list.iter().all(|v| v.as_big().is_some()) {
        return Ok(Value::whole(list.iter().filter_map(Value::as_big).sum()));
    }
    let dimension = list.iter().find_map(|v| match v {
        Value::Quantity(_, d) => Some(*d),
        _ => None,
    });
    let total = list.iter().map(|v| v.as_number().ok_or_else(|| call.refuse(0, "numbers are wanted")));
    let total = total.sum::<Result<f64, Stop>>()?;
    Ok(Value::Quantity(total, dimension.unwrap_or(Dimension::NUMBER)))
}

fn vector_dimension(call: &Call, index: usize) -> Dimension {
    call.arg(index).as_dimension().unwrap_or(Dimension::NUMBER)
}

fn norm(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Quantity(call.vec3(0)?.norm(), vector_dimension(call, 0)))
}

fn product_dimension(call: &Call) -> Eval<Dimension> {
    let product = vector_dimension(call, 0).times(vector_dimension(call, 1));
    product.ok_or_else(|| call.refuse(0, "the product has no dimension"))
}

fn dot(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Quantity(call.vec3(0)?.dot(&call.vec3(1)?), product_dimension(call)?))
}

fn cross(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    Ok(Value::Vec3(call.vec3(0)?.cross(&call.vec3(1)?), product_dimension(call)?))
}

fn pose(call: &Call) -> Eval<crate::geometry::Pose> {
    match call.arg(0) {
        Value::Pose(pose) => Ok(**pose),
        _ => Err(call.refuse(0, "a pose is wanted")),
    }
}
