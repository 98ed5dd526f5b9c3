//! Built-ins about lists and texts.

use super::math::order;
use super::{Native, pure};
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use std::cmp::Ordering;

pub const TABLE: &[Native] = &[
    pure("len", 1, |_, call| Ok(Value::count(call.list(0)?.len()))),
    pure("first", 1, |_, call| Ok(Value::optional(call.list(0)?.first().cloned()))),
    pure("last", 1, |_, call| Ok(Value::optional(call.list(0)?.last().cloned()))),
    pure("slice", 2, slice),
    pure("reversed", 1, |_, call| Ok(Value::list(call.list(0)?.iter().rev().cloned().collect()))),
    pure("sorted", 1, sorted),
    pure("flatten", 1, flatten),
    pure("contains", 2, contains),
    pure("any", 1, |_, call| Ok(Value::Bool(call.list(0)?.iter().any(is_true)))),
    pure("all", 1, |_, call| Ok(Value::Bool(call.list(0)?.iter().all(is_true)))),
    pure("join", 2, join),
    pure("split", 2, split),
    pure("characters", 1, characters),
];

fn is_true(value: &Value) -> bool {
    matches!(value, Value::Bool(true))
}

fn slice(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let list = call.list(0)?;
    let (from, to) = call.range(1)?;
    if !(0.0 <= from && from <= to && to <= list.len() as f64) {
        let count = list.len();
        return Err(call.refuse(1, format!("this range leads out of the list, which has {count} elements")));
    }
    Ok(Value::list(list[from as usize..to as usize].to_vec()))
}

fn sorted(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut list = call.list(0)?.to_vec();
    list.sort_by(|a, b| order(a, b).unwrap_or(Ordering::Equal));
    Ok(Value::list(list))
}

fn flatten(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut all = Vec::new();
    for inner in call.list(0)?.iter() {
        if let Value::List(inner) = inner {
            interpreter.check_list(all.len() + inner.len(), call.span)?;
            all.extend(inner.iter().cloned());
        }
    }
    Ok(Value::list(all))
}

fn contains(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let item = call.arg(1);
    Ok(Value::Bool(call.list(0)?.iter().any(|value| value.same(item) == Some(true))))
}

fn join(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut text = String::new();
    let between = call.text(1)?;
    for (index, piece) in call.list(0)?.iter().enumerate() {
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
    let on = call.text(1)?;
    if on.is_empty() {
        return Err(call.refuse(1, "the text to split at must not be empty"));
    }
    let pieces: Vec<Value> = call.text(0)?.split(on).map(Value::text).collect();
    interpreter.check_list(pieces.len(), call.span)?;
    Ok(Value::list(pieces))
}

fn characters(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let text = call.text(0)?;
    interpreter.check_list(text.chars().count(), call.span)?;
    Ok(Value::list(text.chars().map(|c| Value::text(c.to_string())).collect()))
}
