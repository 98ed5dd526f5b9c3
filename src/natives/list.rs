//! Built-ins about lists and texts.

use super::Native;
use super::math::order;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::nesting;
use crate::interpret::stop::Eval;
use crate::interpret::value::{Callable, Value};
use crate::source::{Diagnostic, code};
use std::cmp::Ordering;
use std::rc::Rc;

/// The natives of this file.
pub(super) const TABLE: &[Native] = &[
    Native::pure("len", parameters![list: &[Value]], |_, call| {
        Ok(Value::count(call.get::<&[Value]>("list")?.len()))
    }),
    Native::pure("first", parameters![list: &[Value]], |_, call| {
        Ok(Value::optional(call.get::<&[Value]>("list")?.first().cloned()))
    }),
    Native::pure("last", parameters![list: &[Value]], |_, call| {
        Ok(Value::optional(call.get::<&[Value]>("list")?.last().cloned()))
    }),
    Native::pure("slice", parameters![list: &[Value], places: (f64, f64)], slice),
    Native::pure("reversed", parameters![list: &[Value]], |_, call| {
        Ok(Value::list(call.get::<&[Value]>("list")?.iter().rev().cloned().collect()))
    }),
    Native::pure("sorted", parameters![list: &[Value]], sorted),
    Native::pure("flatten", parameters![lists: &[Value]], flatten),
    Native::pure("contains", parameters![list: &[Value], item: &Value], contains),
    Native::pure("any", parameters![list: &[Value]], |_, call| {
        Ok(Value::Bool(call.get::<&[Value]>("list")?.iter().any(is_true)))
    }),
    Native::pure("all", parameters![list: &[Value]], |_, call| {
        Ok(Value::Bool(call.get::<&[Value]>("list")?.iter().all(is_true)))
    }),
    Native::pure("reduce", parameters![list: &[Value], f: &Rc<Callable>, from: &Value], reduce),
    Native::pure(
        "iterate",
        parameters![f: &Rc<Callable>, from: &Value, until: &Rc<Callable>, max: usize],
        iterate,
    ),
    Native::pure("join", parameters![list: &[Value], with: &str], join),
    Native::pure("split", parameters![text: &str, on: &str], split),
    Native::pure("characters", parameters![text: &str], characters),
];

fn is_true(value: &Value) -> bool {
    matches!(value, Value::Bool(true))
}

fn slice(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let list = call.get::<&[Value]>("list")?;
    let (from, to) = call.get::<(f64, f64)>("places")?;
    if !(0.0 <= from && from <= to && to <= list.len() as f64) {
        let count = list.len();
        return Err(
            call.refuse("places", format!("this range leads out of the list, which has {count} elements"))
        );
    }
    Ok(Value::list(list[from as usize..to as usize].to_vec()))
}

fn sorted(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut list = call.get::<&[Value]>("list")?.to_vec();
    list.sort_by(|a, b| order(a, b).unwrap_or(Ordering::Equal));
    Ok(Value::list(list))
}

fn flatten(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut all = Vec::new();
    for inner in call.get::<&[Value]>("lists")?.iter() {
        if let Value::List(inner) = inner {
            interpreter.check_list(all.len() + inner.len(), call.span)?;
            all.extend(inner.iter().cloned());
        }
    }
    Ok(Value::list(all))
}

fn contains(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let item = call.arg("item");
    Ok(Value::Bool(call.get::<&[Value]>("list")?.iter().any(|value| value.same(item) == Some(true))))
}

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

fn join(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut text = String::new();
    let between = call.get::<&str>("with")?;
    for (index, piece) in call.get::<&[Value]>("list")?.iter().enumerate() {
        if index > 0 {
            text.push_str(between);
        }
        if let Value::Text(piece) = piece {
            text.push_str(piece);
        }
        interpreter.check_text(text.len(), call.span)?;
    }
    Ok(Value::text(text))
}

fn split(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let on = call.get::<&str>("on")?;
    if on.is_empty() {
        return Err(call.refuse("on", "the text to split at must not be empty"));
    }
    let pieces: Vec<Value> = call.get::<&str>("text")?.split(on).map(Value::text).collect();
    interpreter.check_list(pieces.len(), call.span)?;
    Ok(Value::list(pieces))
}

fn characters(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let text = call.get::<&str>("text")?;
    interpreter.check_list(text.chars().count(), call.span)?;
    Ok(Value::list(text.chars().map(|c| Value::text(c.to_string())).collect()))
}
