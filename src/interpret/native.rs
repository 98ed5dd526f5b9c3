//! Built-ins as the evaluator sees them: a key, parameters, and a body to call.

use super::argument::{Argument, Misfit, Parameter, Positive};
use super::interpreter::Interpreter;
use super::stop::{Eval, Stop, fault};
use super::value::{Callable, Value};
use crate::check::typed::Param;
use crate::source::{ReadError, Span, code};
use std::rc::Rc;

/// The modes in which a built-in does its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Whenever it is called.
    None,
    /// Only when the program is run: `modl check` evaluates its arguments and no more.
    OnRun,
}

/// The body of an `extern fn`.
pub type NativeBody = fn(&mut Interpreter, &Call) -> Eval<Value>;

/// A built-in function.
#[derive(Clone, Copy)]
pub struct Native {
    /// `move`, or `Plan.at` for a method, which takes its object first.
    pub key: &'static str,
    /// The parameters in any order; a test compares them with the declaration.
    pub parameters: &'static [Parameter],
    /// The number of parameters of a native that reads its arguments by number.
    pub numbered: Option<usize>,
    /// The modes in which it does its work.
    pub effect: Effect,
    /// The Rust function.
    pub body: NativeBody,
}

impl Native {
    /// Returns a built-in that does its work whenever it is called.
    pub const fn pure(key: &'static str, parameters: &'static [Parameter], body: NativeBody) -> Native {
        Native { key, parameters, numbered: None, effect: Effect::None, body }
    }

    /// Returns a built-in that only a run carries out.
    pub const fn on_run(key: &'static str, parameters: &'static [Parameter], body: NativeBody) -> Native {
        Native { key, parameters, numbered: None, effect: Effect::OnRun, body }
    }
}

/// A call of a built-in with all arguments evaluated.
pub struct Call<'c> {
    /// The whole call.
    pub span: Span,
    /// The function that is called.
    pub native: &'static Native,
    /// The declared parameters.
    pub params: &'c [Param],
    /// The arguments, in the order of the declaration.
    pub args: &'c [Value],
    /// The places of the arguments; the whole call for those left out.
    pub spans: &'c [Span],
}

/// The name of a parameter, or its number for natives that still count.
pub trait Key: Copy {
    /// Returns the place of the parameter in the declaration.
    fn index(self, call: &Call) -> usize;

    /// Checks that the parameter is listed with the Rust type that is read.
    fn check_type(self, call: &Call, rust_type: &'static str);
}

impl Key for usize {
    fn index(self, _: &Call) -> usize {
        self
    }

    fn check_type(self, _: &Call, _: &'static str) {}
}

impl Key for &str {
    fn index(self, call: &Call) -> usize {
        let found = call.params.iter().position(|param| param.name.as_str() == self);
        found.unwrap_or_else(|| unreachable!("`{}` declares no parameter `{self}`", call.native.key))
    }

    fn check_type(self, call: &Call, rust_type: &'static str) {
        let listed = call.native.parameters.iter().find(|parameter| parameter.name == self);
        let listed = listed.map(|parameter| (parameter.rust_type)());
        assert_eq!(listed, Some(rust_type), "`{}` reads `{self}` as its table says", call.native.key);
    }
}

impl<'c> Call<'c> {
    /// Reads an argument.
    ///
    /// # Errors
    /// A fault where the value is out of range.
    pub fn get<T: Argument<'c>>(&self, key: &str) -> Eval<T> {
        self.get_named(key, &format!("`{key}`"))
    }

    /// Reads an argument that a message calls `what`: "the edge", "a number of cells".
    ///
    /// # Errors
    /// A fault where the value is out of range.
    pub fn get_named<T: Argument<'c>>(&self, key: impl Key, what: &str) -> Eval<T> {
        key.check_type(self, std::any::type_name::<T>());
        match T::read(self.arg(key)) {
            Ok(value) => Ok(value),
            Err(Misfit::Range(bound)) => Err(self.refuse(key, format!("{what} {bound}"))),
            Err(Misfit::Type) => {
                unreachable!("`check` lets only fitting arguments through to {what} of `{}`", self.native.key)
            }
        }
    }

    /// Returns the span of an argument; of the call where it was left out.
    pub fn at(&self, key: impl Key) -> Span {
        self.spans.get(key.index(self)).copied().unwrap_or(self.span)
    }

    /// Returns an argument as it is.
    pub fn arg(&self, key: impl Key) -> &'c Value {
        self.args.get(key.index(self)).unwrap_or(&Value::Missing)
    }

    /// Returns a fault about an argument.
    pub fn refuse(&self, key: impl Key, message: impl Into<String>) -> Stop {
        let message = message.into();
        fault(code::BAD_VALUE, self.at(key), message.clone(), message)
    }

    /// Reads a number above zero that a message calls `what`.
    ///
    /// # Errors
    /// A fault where the number is not above zero.
    pub fn positive(&self, key: impl Key, what: &str) -> Eval<f64> {
        self.get_named(key, what).map(|Positive(x)| x)
    }

    /// Reads a number above zero that may be missing.
    ///
    /// # Errors
    /// A fault where there is a number that is not above zero.
    pub fn positive_if(&self, key: impl Key, what: &str) -> Eval<Option<f64>> {
        Ok(self.get_named::<Option<Positive>>(key, what)?.map(|Positive(x)| x))
    }

    /// Reads a whole number of at least zero that a machine word holds.
    ///
    /// # Errors
    /// A fault where the number is negative or too large.
    pub fn count(&self, key: impl Key, what: &str) -> Eval<usize> {
        self.get_named(key, what)
    }

    pub fn number(&self, key: usize) -> Eval<f64> {
        self.get_named(key, "")
    }

    pub fn text(&self, key: impl Key) -> Eval<&'c str> {
        self.get_named(key, "")
    }

    pub fn truth(&self, key: usize) -> Eval<bool> {
        self.get_named(key, "")
    }

    pub fn word(&self, key: usize) -> Option<&'static str> {
        match self.arg(key) {
            Value::Word(word) => Some(word.as_str()),
            _ => None,
        }
    }

    pub fn list(&self, key: usize) -> Eval<&'c Rc<Vec<Value>>> {
        match self.arg(key) {
            Value::List(list) => Ok(list),
            _ => Err(self.refuse(key, "a list is wanted here")),
        }
    }

    pub fn function(&self, key: usize) -> Eval<&'c Rc<Callable>> {
        self.get_named(key, "")
    }

    pub fn instance(&self, key: usize) -> Eval<&'c Rc<super::design::Instance>> {
        self.get_named(key, "")
    }

    pub fn is_missing(&self, key: impl Key) -> bool {
        matches!(self.arg(key), Value::Missing)
    }
}

impl Interpreter<'_> {
    /// Reads the file of the project that an argument names, relative to the file of the call. Returns its
    /// path from the project's root, and its bytes.
    ///
    /// # Errors
    /// A fault where the name leads out of the project or the file can't be read.
    pub fn project_file(&mut self, call: &Call, key: impl Key) -> Eval<(String, Vec<u8>)> {
        let name = call.text(key)?;
        let at = call.at(key);
        let from = &self.sources.file(at.file).name;
        let Some(path) = crate::source::files::join(from, name) else {
            let message = format!("`{name}` leads out of the project");
            return Err(fault(code::OUTSIDE_PROJECT, at, message, "outside of the project"));
        };
        let bytes = self.stage.read(&path).map_err(|error| {
            let why = match error {
                ReadError::NotFound => "there is no such file".to_string(),
                ReadError::Outside => "it leads out of the project".to_string(),
                ReadError::TooLarge(limit) => format!("it is larger than {limit} bytes"),
                ReadError::Failed(why) => why,
            };
            fault(code::CANNOT_READ, at, format!("`{path}` can't be read: {why}"), why)
        })?;
        Ok((path, bytes))
    }
}
