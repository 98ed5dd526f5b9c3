//! Built-ins that carry a value along, and that make lists of numbers: steps, ranks, pseudorandom numbers.

use super::Native;
use super::math::order;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::nesting;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{Callable, Value};
use crate::optimize::random::SplitMix64;
use crate::source::{Diagnostic, code};
use std::cmp::Ordering;
use std::rc::Rc;

/// The built-ins that repeat a function or make lists of numbers, such as `reduce`, `iterate`, `steps` and `random`:
/// the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::pure("reduce", parameters![list: &[Value], f: &Rc<Callable>, from: &Value], reduce),
    Native::pure("scan", parameters![list: &[Value], f: &Rc<Callable>, from: &Value], scan),
    Native::pure(
        "iterate",
        parameters![f: &Rc<Callable>, from: &Value, until: &Rc<Callable>, max: usize],
        iterate,
    ),
    Native::pure("ranking", parameters![list: &[Value]], ranking),
    Native::pure("steps", parameters![range: (&Value, &Value), by: &Value], steps),
    Native::pure("random", parameters![seed: usize, count: usize], random),
];

/// The fraction of a step by which the last of several steps may pass the end of a range, or fall short of that of a
/// plan, by rounding.
pub(super) const STEP_ROUNDING: f64 = 1e-9;

/// Runs `reduce(list, f, from)`: carries a value through a list.
fn reduce(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let f = call.get::<&Rc<Callable>>("f")?;
    let mut carried = call.get::<&Value>("from")?.clone();
    for (step, element) in call.get::<&[Value]>("list")?.iter().enumerate() {
        carried = carried_on(interpreter, call, f, vec![carried, element.clone()], step)?;
        if carried.is_unknown() {
            break;
        }
    }
    Ok(carried)
}

/// Runs `iterate(f, from, until)`: carries a value on until `until` holds.
///
/// # Errors
/// A fault where it does not hold after `max` steps.
fn iterate(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (f, until) = (call.get::<&Rc<Callable>>("f")?, call.get::<&Rc<Callable>>("until")?);
    let max = call.count("max", "a number of steps")?;
    let mut carried = call.get::<&Value>("from")?.clone();
    for step in 0.. {
        match interpreter.apply(until, vec![carried.clone()], call.at("until"))? {
            Value::Bool(true) => break,
            Value::Bool(false) if step < max => {}
            Value::Bool(false) => {
                let message = format!("`until` does not hold after {max} steps");
                return Err(Diagnostic::error(code::BAD_VALUE, message)
                    .label(call.at("until"), "this stays false")
                    .hint("`max:` allows more steps, if it gets nearer with each")
                    .into());
            }
            _ => return Ok(Value::Unknown),
        }
        carried = carried_on(interpreter, call, f, vec![carried], step)?;
        if carried.is_unknown() {
            break;
        }
    }
    Ok(carried)
}

/// Returns what a function makes of the value that a native carries along; refuses one that has become too deep,
/// which is looked at after 1, 2, 4, ... steps, so that all looks together cost little.
fn carried_on(
    interpreter: &mut Interpreter,
    call: &Call,
    f: &Callable,
    values: Vec<Value>,
    step: usize,
) -> Eval<Value> {
    interpreter.step(call.span)?;
    let carried = interpreter.apply(f, values, call.at("f"))?;
    if (step + 1).is_power_of_two() && nesting::depth(&carried) > nesting::DEPTH_MAX {
        let message =
            format!("a value of more than {} values within each other is not allowed", nesting::DEPTH_MAX);
        return Err(Diagnostic::error(code::SIZE_LIMIT, message)
            .label(call.at("f"), format!("each step adds to it; these were {}", step + 1))
            .hint("a list holds many values side by side")
            .into());
    }
    Ok(carried)
}

/// Runs `scan(list, f, from)`: `reduce` with what came of each element.
fn scan(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let f = call.get::<&Rc<Callable>>("f")?;
    let mut carried = call.get::<&Value>("from")?.clone();
    let mut all = Vec::new();
    for (step, element) in call.get::<&[Value]>("list")?.iter().enumerate() {
        carried = carried_on(interpreter, call, f, vec![carried, element.clone()], step)?;
        if carried.is_unknown() {
            return Ok(Value::Unknown);
        }
        all.push(carried.clone());
    }
    Ok(Value::list(all))
}

/// Runs `ranking(list)`: the indices in rising order of their elements, of equal ones the first first.
fn ranking(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let list = call.get::<&[Value]>("list")?;
    let mut places: Vec<usize> = (0..list.len()).collect();
    places.sort_by(|&a, &b| order(&list[a], &list[b]).unwrap_or(Ordering::Equal));
    Ok(Value::list(places.into_iter().map(Value::count).collect()))
}

/// Runs `steps(range, by)`.
///
/// # Errors
/// A fault where the step is zero or leads away from the end of the range.
fn steps(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (from, to) = call.get::<(&Value, &Value)>("range")?;
    let by = call.get::<&Value>("by")?;
    if let (Value::Int(from), Value::Int(to), Value::Int(by)) = (from, to, by) {
        return whole_steps(interpreter, call, (*from, *to), *by);
    }
    let (Some(a), Some(b), Some(step)) = (from.as_number(), to.as_number(), by.as_number()) else {
        return Ok(Value::Unknown);
    };
    let count = (b - a) / step;
    if step == 0.0 || count < 0.0 {
        return Err(leads_away(call));
    }
    let count = libm::floor(count + STEP_ROUNDING) + 1.0;
    let limit = interpreter.limits().list;
    if count > limit as f64 {
        return interpreter.check_list(limit + 1, call.span).map(|()| Value::Unknown);
    }
    let dimension = from.as_dimension().zip(by.as_dimension()).and_then(|(a, b)| a.common(b));
    let dimension = dimension.unwrap_or(crate::units::Dimension::NUMBER);
    let element = |i: usize| Value::Quantity(a + i as f64 * step, dimension);
    Ok(Value::list((0..count as usize).map(element).collect()))
}

/// Returns the steps of a range of whole numbers, which is without its end.
fn whole_steps(interpreter: &mut Interpreter, call: &Call, ends: (i64, i64), by: i64) -> Eval<Value> {
    let (from, to) = (i128::from(ends.0), i128::from(ends.1));
    let step = i128::from(by);
    if step == 0 || (to - from).signum() * step.signum() < 0 {
        return Err(leads_away(call));
    }
    let count = ((to - from).abs() + step.abs() - 1) / step.abs();
    interpreter.check_list(usize::try_from(count).unwrap_or(usize::MAX), call.span)?;
    let element = |i: i128| Value::Int(i64::try_from(from + i * step).expect("it lies between the ends"));
    Ok(Value::list((0..count).map(element).collect()))
}

/// Returns the fault of a step that never comes to the end of its range.
fn leads_away(call: &Call) -> crate::interpret::stop::Stop {
    let message = "this step does not lead from the beginning of the range to its end";
    fault(code::BAD_VALUE, call.at("by"), message, "zero, or of the wrong sign")
}

/// Runs `random(seed, count)`: numbers of SplitMix64, uniform in [0, 1).
fn random(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let count = call.count("count", "a count of numbers")?;
    interpreter.check_list(count, call.span)?;
    let mut generator = SplitMix64(call.count("seed", "a seed")? as u64);
    Ok(Value::list((0..count).map(|_| Value::number(generator.next_f64())).collect()))
}
