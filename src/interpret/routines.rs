//! The functions of the rooms above the evaluator, as it is given them.
//!
//! Evaluating an expression needs what lies above: declarations are elaborated to designs, built-ins are
//! called, values are printed. The evaluator does not know these rooms; whoever runs a program hands them in
//! as functions ([`crate::execute`]).

use super::capability::Capabilities;
use super::design::{Design, Instance};
use super::interpreter::Interpreter;
use super::native::Native;
use super::printed::{PrintedValue, TypedValue};
use super::robot::Robot;
use super::stop::Eval;
use super::value::{PortValue, Value};
use crate::check::typed::DefId;
use crate::source::{Span, Symbol};
use std::rc::Rc;

/// The greatest size of the values of one run that are told besides their text, as JSON, in bytes.
const VALUES_BYTES_MAX: usize = 1 << 24;

/// The arguments of a call with their spans, in the order of the parameters.
pub struct Args {
    /// The arguments, in the order of the parameters; `None` where the default is wanted.
    pub values: Vec<Option<Value>>,
    /// The span of each argument, in the order of `values`; that of the whole call for those left out.
    pub spans: Vec<Span>,
}

impl Args {
    /// Returns arguments that all have one span. `values`: the arguments in the order of the parameters.
    pub fn plain(values: Vec<Value>, span: Span) -> Args {
        let spans = vec![span; values.len()];
        Args { values: values.into_iter().map(Some).collect(), spans }
    }
}

/// The result of assembling the robot of a design; `None` where the design is broken or describes no robot.
pub type Assembled = Eval<Option<Rc<Robot>>>;

/// The functions that modules above the evaluator (elaboration, built-ins, display) lend it, so that it need not depend
/// on them. Those that return [`Eval`] fail as the evaluator does.
pub struct Routines {
    /// The function that finds a built-in by its key, such as `move` or `Plan.at`; `None` if there is none.
    pub native: fn(Symbol) -> Option<&'static Native>,
    /// The function that elaborates a declaration with arguments to an instance; `Value::Unknown` where it is broken.
    pub instantiate: fn(&mut Interpreter, DefId, Args, Span) -> Eval<Value>,
    /// The function that assembles the robot of a design, once; `None` where the design is broken or no robot.
    pub robot_of: fn(&mut Interpreter, &Rc<Design>, Span) -> Assembled,
    /// The function that finds the joint of the connection at a port; a fault at the span where there is none.
    pub hinge_of: fn(&mut Interpreter, &PortValue, Span) -> Eval<Value>,
    /// The function that elaborates a declaration with its defaults and checks all that its body declares; faults are
    /// reported.
    pub check_declaration: fn(&mut Interpreter, DefId) -> Eval<()>,
    /// The function that writes a value on one line.
    pub show: fn(&Interpreter, &Value) -> String,
    /// The function that tells a value by its kind, in as many bytes as are left.
    pub typed: fn(&Interpreter, &Value, &mut usize) -> TypedValue,
    /// The function that writes a value on as many lines as it needs, the first of which can stand alone.
    pub display: fn(&mut Interpreter, &Value) -> Eval<String>,
    /// The function that writes a line about what a declaration declares, with its defaults; a halt ends its
    /// elaboration.
    pub describe_declaration: fn(&mut Interpreter, DefId) -> Eval<String>,
    /// The function that finds what the standard library can do with a robot, asked for at the span; `None` where it
    /// can't be assembled.
    pub capabilities: fn(&mut Interpreter, &Rc<Instance>, Span) -> Eval<Option<Capabilities>>,
    /// The function that draws every robot, lattice and truss that the program declares, through the host.
    pub draw_declared: fn(&mut Interpreter) -> Eval<()>,
}

impl Interpreter<'_> {
    /// Returns the robot of a design that is complete, asked for at `span`; `None` where it is broken or no
    /// robot.
    ///
    /// # Errors
    /// A fault for a configuration without modules, a fault of a declaration that the robot needs, or `Stop::Halt` if a
    /// limit is reached or the user cancels.
    pub fn robot_of(&mut self, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<Robot>>> {
        (self.shared.routines.robot_of)(self, design, span)
    }

    /// Returns a value as text on one line, as a program could write it, with units that suit its size.
    pub fn show(&self, value: &Value) -> String {
        (self.shared.routines.show)(self, value)
    }

    /// Sends the host the value that is printed next as `text`, if the options ask for values. Values beyond
    /// `VALUES_BYTES_MAX` in one run are left out.
    pub fn print_value(&mut self, value: &Value, text: &str) {
        if !self.shared.options.values {
            return;
        }
        let mut left = VALUES_BYTES_MAX.saturating_sub(self.reported.values_bytes);
        let before = left;
        let value = (self.shared.routines.typed)(self, value, &mut left);
        self.reported.values_bytes += before - left;
        self.shared.host.print_value(PrintedValue { text: text.to_string(), value });
    }

    /// Returns a value as text on as many lines as it needs, the first of which can stand alone.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while the value is judged or planned.
    pub fn display(&mut self, value: &Value) -> Eval<String> {
        (self.shared.routines.display)(self, value)
    }

    /// Elaborates a declaration with its defaults and checks all that its body declares.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels; faults are reported.
    pub fn check_declaration(&mut self, def: DefId) -> Eval<()> {
        (self.shared.routines.check_declaration)(self, def)
    }
}
