//! The depth of values: how many values lie within each other.
//!
//! Types bound the depth of lists, but a record may hold its own kind, a function what it captures, and a behaviour
//! other behaviours. Values are compared, shown and dropped by recursion, so natives that carry a value along refuse
//! one that is too deep.

use super::record::Record;
use super::value::{Callable, Value};
use crate::plan::Condition;
use crate::plan::visit::Graph;
use std::collections::HashMap;

/// The greatest depth of nested values that a run keeps, in values from the outermost to the innermost.
pub const DEPTH_MAX: usize = 10_000;

/// Returns the depth of a value: the number of values on the longest path into nested ones, this one included. Shared
/// values are visited once; the stack of the traversal is on the heap.
pub fn depth(value: &Value) -> usize {
    let mut known: HashMap<usize, usize> = HashMap::new();
    let mut stack = vec![Visit { value, held: holding(value), below: 0 }];
    loop {
        let top = stack.last_mut().expect("the root is left last");
        if let Some(next) = top.held.pop() {
            match address(next).and_then(|at| known.get(&at)) {
                Some(below) => top.below = top.below.max(*below),
                None => stack.push(Visit { value: next, held: holding(next), below: 0 }),
            }
            continue;
        }
        let done = stack.pop().expect("there is a top");
        let depth = done.below + own_depth(done.value);
        if let Some(at) = address(done.value) {
            known.insert(at, depth);
        }
        match stack.last_mut() {
            Some(above) => above.below = above.below.max(depth),
            None => return depth,
        }
    }
}

/// A value on the way down.
struct Visit<'v> {
    value: &'v Value,
    /// The values in it that are not visited yet.
    held: Vec<&'v Value>,
    /// The greatest depth of those that are.
    below: usize,
}

/// Returns the values that a value holds and that may hold others themselves.
fn holding(value: &Value) -> Vec<&Value> {
    let nested = |value: &&Value| {
        matches!(
            value,
            Value::List(_) | Value::Record(_) | Value::Fn(_) | Value::Behavior(_) | Value::Condition(_)
        )
    };
    match value {
        Value::List(elements) => elements.iter().filter(nested).collect(),
        Value::Record(record) => match &**record {
            Record::Declared(record) => record.fields.iter().filter(nested).collect(),
            _ => Vec::new(),
        },
        Value::Fn(callable) => match &**callable {
            Callable::Lambda { captured, .. } => {
                captured.iter().map(|(_, value)| value).filter(nested).collect()
            }
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// Returns the depth of a value without what [`holding`] lists.
fn own_depth(value: &Value) -> usize {
    match value {
        Value::Behavior(behavior) => Graph::of(&behavior.node).depth,
        Value::Condition(condition) => condition_depth(&condition.condition),
        _ => 1,
    }
}

fn condition_depth(condition: &Condition) -> usize {
    1 + match condition {
        Condition::And(a, b) | Condition::Or(a, b) => condition_depth(a).max(condition_depth(b)),
        Condition::Not(inner) => condition_depth(inner),
        _ => 0,
    }
}

/// Returns the address of a shared value; `None` for one that holds nothing.
fn address(value: &Value) -> Option<usize> {
    use std::rc::Rc;
    Some(match value {
        Value::List(list) => Rc::as_ptr(list).addr(),
        Value::Record(record) => Rc::as_ptr(record).addr(),
        Value::Fn(callable) => Rc::as_ptr(callable).addr(),
        Value::Behavior(behavior) => Rc::as_ptr(behavior).addr(),
        _ => return None,
    })
}
