//! The display of values: on one line, as `print` shows them (`value`), and as a session shows a result,
//! on several lines (`pretty`), and by their kind for other programs (`typed`).

mod motion;
mod pretty;
mod robot;
mod shape;
mod truss;
mod typed;
mod value;

use crate::check::typed::DefId;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::printed::TypedValue;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;

/// Returns a value as text, as `print` shows it: as it could be written in a program, with units that suit its size,
/// or in a few words. A text stays as it is, and a report of the judge has several lines. `interpreter`: the run that
/// the value belongs to.
pub fn show(interpreter: &Interpreter, value: &Value) -> String {
    interpreter.show_value(value)
}

/// Returns a value in the form in which it is written as JSON for programs in other languages. The bytes that it takes
/// are subtracted from `bytes_left`; what does not fit is left out. `interpreter`: the run that the value belongs to.
pub fn typed(interpreter: &Interpreter, value: &Value, bytes_left: &mut usize) -> TypedValue {
    interpreter.typed_value(value, 0, bytes_left)
}

/// Returns a value as text, as a session shows it, on as many lines as it needs, the first of which can stand alone;
/// texts are in quotes. A long text is cut. `interpreter`: the run that the value belongs to.
///
/// # Errors
/// `Stop::Halt` if a limit is reached or the user cancels while the value is judged or planned.
pub fn display(interpreter: &mut Interpreter, value: &Value) -> Eval<String> {
    interpreter.display_value(value)
}

/// Returns a line about what a declaration declares, with its defaults, such as `config Walker: order 1, 4 modules,
/// 600g`. `interpreter`: the run, which elaborates the declaration `def`.
///
/// # Errors
/// `Stop::Halt` if a limit is reached or the user cancels while the declaration is elaborated.
pub fn describe_declaration(interpreter: &mut Interpreter, def: DefId) -> Eval<String> {
    interpreter.describe_declaration_line(def)
}
