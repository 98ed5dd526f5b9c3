//! Built-ins about lists and texts.

use super::Native;
use super::math::order;
use crate::interpret::argument::{Choice, parameters};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use std::cmp::Ordering;

/// The built-ins for lists and texts, such as `len`, `sorted` and `join`: the key of each with its parameters and its
/// Rust function.
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
    Native::pure("pad", parameters![text: &str, width: usize, align: Align], pad),
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

/// The side on which a text stands in a wider one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Align {
    /// Blanks follow the text.
    Left,
    /// Blanks come before the text.
    Right,
    /// Blanks stand on both sides; an odd one follows.
    Centre,
}

impl Choice for Align {
    const WORDS: &'static [(&'static str, Align)] =
        &[("left", Align::Left), ("right", Align::Right), ("centre", Align::Centre)];
}

/// Runs `pad`: fills a text up with blanks to a width, in characters.
fn pad(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (text, width) = (call.get::<&str>("text")?, call.count("width", "a width")?);
    interpreter.check_text(width, call.at("width"))?;
    let blanks = width.saturating_sub(text.chars().count());
    let before = match call.get("align")? {
        Align::Left => 0,
        Align::Right => blanks,
        Align::Centre => blanks / 2,
    };
    Ok(Value::text(format!("{}{text}{}", " ".repeat(before), " ".repeat(blanks - before))))
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
