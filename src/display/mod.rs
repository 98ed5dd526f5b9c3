//! The display of values: on one line, as `print` shows them (`value`), and as a session shows a result,
//! on several lines (`pretty`).

mod motion;
mod pretty;
mod robot;
mod shape;
mod truss;
mod value;

use crate::check::typed::DefId;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;

/// Returns a value on one line: as it could be written, with units that suit its size.
pub fn show(interpreter: &Interpreter, value: &Value) -> String {
    interpreter.show_value(value)
}

/// Returns a value on as many lines as it needs, the first of which can stand alone.
///
/// # Errors
/// A halt while the value is judged or planned.
pub fn display(interpreter: &mut Interpreter, value: &Value) -> Eval<String> {
    interpreter.display_value(value)
}

/// Returns what a declaration declares on one line.
///
/// # Errors
/// A halt while it is elaborated.
pub fn describe_declaration(interpreter: &mut Interpreter, def: DefId) -> Eval<String> {
    interpreter.describe_declaration_line(def)
}
