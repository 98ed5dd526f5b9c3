//! The rows of a study, computed where a program asks for them.

use super::Native;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::study::{RowFault, Study};
use crate::interpret::value::Value;
use crate::source::code;
use crate::study::{Coordinate, Goal, Search};

/// The built-ins about studies, each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("rows", parameters![study: &Value], rows),
    Native::on_run("best", parameters![study: &Value], best),
];

/// The rows of a study that were computed, each with what a search seeks.
struct Computed {
    rows: Vec<(Value, Option<f64>)>,
    /// The number and the fault of the first row that has no values.
    first_fault: Option<(u64, RowFault)>,
}

/// Runs `rows(study)`: computes all rows of a study, and lists those that have values, in order.
fn rows(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some((study, computed)) = computed(interpreter, call)? else { return Ok(Value::Unknown) };
    if computed.rows.is_empty() {
        return Err(no_rows(interpreter, call, &study, computed.first_fault));
    }
    Ok(Value::list(computed.rows.into_iter().map(|(row, _)| row).collect()))
}

/// Runs `best(study)`: computes a search, and gives its best row; of equal ones the first.
fn best(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some((study, computed)) = computed(interpreter, call)? else { return Ok(Value::Unknown) };
    let Some((_, goal)) = study.objective else {
        let name = interpreter.name(study.def);
        let message = format!("`{name}` seeks nothing: the best row is that of a study by `cmaes`");
        let stop = fault(code::BAD_VALUE, call.at("study"), message, "no search");
        return Err(with_hint(stop, "`rows(..)` gives the rows of every study, as a list"));
    };
    let better = |new: f64, old: f64| match goal {
        Goal::Greatest => new > old,
        Goal::Least => new < old,
    };
    let mut found: Option<(Value, f64)> = None;
    for (row, sought) in computed.rows {
        if let Some(x) = sought.filter(|x| !x.is_nan())
            && found.as_ref().is_none_or(|(_, old)| better(x, *old))
        {
            found = Some((row, x));
        }
    }
    found.map(|(row, _)| row).ok_or_else(|| no_rows(interpreter, call, &study, computed.first_fault))
}

/// Computes the rows of the study that a call names; `None` if it is unknown.
///
/// # Errors
/// A fault where the study can't be computed, and a halt where the user cancels.
fn computed(interpreter: &mut Interpreter, call: &Call) -> Eval<Option<(Study, Computed)>> {
    let Value::Study(def) = *call.arg("study") else { return Ok(None) };
    let Some(study) = interpreter.study(def)? else { return Ok(None) };
    let limit = interpreter.limits().list;
    if study.rows > limit as u64 {
        let message = format!("a study of more than {limit} rows is not computed within a program");
        let stop = fault(code::SIZE_LIMIT, call.at("study"), message, format!("{} rows", study.rows));
        return Err(with_hint(stop, "`modl study FILE --out DIR` computes it, on all processors"));
    }
    let mut computed = Computed { rows: Vec::new(), first_fault: None };
    match study.objective {
        Some((_, goal)) => {
            let Some(mut search) = Search::new(&study.design, goal) else { return Ok(None) };
            let mut first = 0;
            loop {
                let points = search.ask();
                if points.is_empty() {
                    break;
                }
                let mut values = Vec::with_capacity(points.len());
                for (point, number) in points.iter().zip(first..) {
                    values.push(point_rows(interpreter, &study, number, point, &mut computed)?);
                }
                first += points.len() as u64;
                search.tell(&values);
            }
        }
        None => {
            for number in 0..study.rows / study.design.rows_of_point() {
                let Some(point) = study.design.point(number) else { return Ok(None) };
                point_rows(interpreter, &study, number, &point, &mut computed)?;
            }
        }
    }
    Ok(Some((study, computed)))
}

/// Computes the rows of a point, and returns the mean of what is sought; `None` where a row lacks it.
fn point_rows(
    interpreter: &mut Interpreter,
    study: &Study,
    number: u64,
    point: &[Coordinate],
    computed: &mut Computed,
) -> Eval<Option<f64>> {
    let count = study.design.rows_of_point();
    let mut sum = Some(0.0);
    for row in number * count..(number + 1) * count {
        let before = interpreter.memory.clone();
        let found = interpreter.study_row(study, point, &study.design.each_of(row), &before);
        match found.ok_or(Stop::Halt)?.outcome {
            Ok(value) => {
                let sought = study.sought(&value);
                sum = sum.zip(sought).map(|(sum, x)| sum + x);
                computed.rows.push((value, sought));
            }
            Err(fault) => {
                sum = None;
                computed.first_fault.get_or_insert((row, fault));
            }
        }
    }
    Ok(sum.map(|sum| sum / count as f64))
}

/// Returns the fault of a study none of whose rows has a value that can be chosen.
fn no_rows(interpreter: &Interpreter, call: &Call, study: &Study, first: Option<(u64, RowFault)>) -> Stop {
    let name = interpreter.name(study.def);
    let message = match first {
        Some((row, fault)) => {
            format!(
                "no row of `{name}` has values; that of number {row} ends with {}: {}",
                fault.code, fault.message
            )
        }
        None => format!("no row of `{name}` has a number to compare"),
    };
    fault(code::NO_ROW, call.at("study"), message, "no rows")
}

/// Returns a fault with a hint.
fn with_hint(stop: Stop, hint: &str) -> Stop {
    match stop {
        Stop::Fault(diagnostic) => Stop::Fault(Box::new(diagnostic.hint(hint))),
        Stop::Halt => Stop::Halt,
    }
}
