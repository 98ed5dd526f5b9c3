//! Built-ins as the evaluator sees them: a key, parameters, and a body to call.

use super::argument::{Argument, ArgumentError, Parameter, Positive};
use super::interpreter::Interpreter;
use super::stop::{Eval, Stop, fault};
use super::value::Value;
use crate::check::typed::{Expr, Param};
use crate::source::{ReadError, Span, code};

/// The modes of a run in which a built-in does its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// The built-in does its work whenever it is called.
    None,
    /// The built-in does its work only when the program is run: `modl check` evaluates its arguments and no more.
    OnRun,
}

/// The body of an `extern fn`: it gets a call none of whose arguments is unknown, and returns the result.
pub type NativeBody = fn(&mut Interpreter, &Call) -> Eval<Value>;

/// A built-in function: the declaration that it belongs to, by its key, and its body in Rust.
#[derive(Clone, Copy)]
pub struct Native {
    /// The key of the declaration: `move`, or `Plan.at` for a method, which takes its object first.
    pub key: &'static str,
    /// The parameters in any order, the object of a method included; a test compares them with the declaration.
    pub parameters: &'static [Parameter],
    /// The modes of a run in which the built-in does its work.
    pub effect: Effect,
    /// The Rust function that does the work.
    pub body: NativeBody,
}

impl Native {
    /// Returns a built-in with this key that does its work in every mode of a run ([`Effect`]). `parameters`: the table
    /// of its parameters; `body`: its Rust function.
    pub const fn pure(key: &'static str, parameters: &'static [Parameter], body: NativeBody) -> Native {
        Native { key, parameters, effect: Effect::None, body }
    }

    /// Returns a built-in with this key that does its work only when the program is run. `parameters`: the table of
    /// its parameters; `body`: its Rust function.
    pub const fn on_run(key: &'static str, parameters: &'static [Parameter], body: NativeBody) -> Native {
        Native { key, parameters, effect: Effect::OnRun, body }
    }
}

/// A call of a built-in with all arguments evaluated.
pub struct Call<'c> {
    /// The span of the whole call.
    pub span: Span,
    /// The built-in that is called, with its table of parameters.
    pub native: &'static Native,
    /// The declared parameters of the built-in, in order.
    pub params: &'c [Param],
    /// The arguments, one for each of `params`; defaults are filled in, and none is unknown.
    pub args: &'c [Value],
    /// The spans of the arguments, in the order of `params`; that of the whole call for those left out.
    pub spans: &'c [Span],
    /// The arguments as expressions, in the order of the declaration; `None` for one that is left out. Empty if the
    /// built-in is called as a value.
    pub exprs: &'c [Option<Expr>],
    /// True if a built-in that gives a value or a signal is to give the signal.
    pub signal: bool,
}

impl<'c> Call<'c> {
    /// Returns the argument of a parameter as a `T`, the type in the table of the native. Panics if the native has no
    /// parameter `name` of this type.
    ///
    /// # Errors
    /// A fault at the argument where the value is out of range.
    pub fn get<T: Argument<'c>>(&self, name: &str) -> Eval<T> {
        self.get_named(name, name)
    }

    /// Returns an argument as [`get`](Self::get) does, and panics as it does; messages call it `what`: "the edge", "a
    /// number of cells". `name`: the parameter.
    ///
    /// # Errors
    /// A fault at the argument where the value is out of range.
    pub fn get_named<T: Argument<'c>>(&self, name: &str, what: &str) -> Eval<T> {
        self.check_type(name, std::any::type_name::<T>());
        match T::read(self.arg(name)) {
            Ok(value) => Ok(value),
            Err(ArgumentError::Range(bound)) => Err(self.refuse(name, format!("{what} {bound}"))),
            Err(ArgumentError::Type) => {
                unreachable!("`check` lets only fitting arguments through to {what} of `{}`", self.native.key)
            }
        }
    }

    /// Returns the span of an argument; that of the call where it was left out. Panics if the declaration has
    /// no parameter `name`.
    pub fn at(&self, name: &str) -> Span {
        self.spans.get(self.index(name)).copied().unwrap_or(self.span)
    }

    /// Returns the value of an argument; [`Value::Missing`] where it was left out and has no default. Panics if
    /// the declaration has no parameter `name`.
    pub fn arg(&self, name: &str) -> &'c Value {
        self.args.get(self.index(name)).unwrap_or(&Value::Missing)
    }

    /// Returns an argument as it is written; `None` where it was left out, or the built-in is called as a value.
    pub fn expr(&self, name: &str) -> Option<&'c Expr> {
        self.exprs.get(self.index(name))?.as_ref()
    }

    /// Returns a fault (E0506) with this message at an argument. Panics if the declaration has no parameter `name`.
    pub fn refuse(&self, name: &str, message: impl Into<String>) -> Stop {
        let message = message.into();
        fault(code::BAD_VALUE, self.at(name), message.clone(), message)
    }

    /// Returns the argument of a parameter as a number above zero, in SI units; messages call it `what`. `name`: the
    /// parameter. Panics as [`get`](Self::get) does.
    ///
    /// # Errors
    /// A fault at the argument where the number is not above zero.
    pub fn positive(&self, name: &str, what: &str) -> Eval<f64> {
        self.get_named(name, what).map(|Positive(x)| x)
    }

    /// Returns the argument of a parameter as a number above zero, in SI units; `None` if it is missing. Messages call
    /// it `what`. `name`: the parameter. Panics as [`get`](Self::get) does.
    ///
    /// # Errors
    /// A fault at the argument where there is a number that is not above zero.
    pub fn positive_if(&self, name: &str, what: &str) -> Eval<Option<f64>> {
        Ok(self.get_named::<Option<Positive>>(name, what)?.map(|Positive(x)| x))
    }

    /// Returns the argument of a parameter as a whole number of at least zero; messages call it `what`. `name`: the
    /// parameter. Panics as [`get`](Self::get) does.
    ///
    /// # Errors
    /// A fault at the argument where the number is negative or too large.
    pub fn count(&self, name: &str, what: &str) -> Eval<usize> {
        self.get_named(name, what)
    }

    /// Returns a whole number that must not be negative; `None` where it was left out. `what`: its name in words, for the
    /// fault.
    ///
    /// # Errors
    /// A fault at the argument where the number is negative or too large.
    pub fn optional_count(&self, name: &str, what: &str) -> Eval<Option<usize>> {
        self.get_named(name, what)
    }

    /// Returns the index of a parameter in the declaration.
    fn index(&self, name: &str) -> usize {
        let found = self.params.iter().position(|param| param.name.as_str() == name);
        found.unwrap_or_else(|| unreachable!("`{}` declares no parameter `{name}`", self.native.key))
    }

    /// Checks that a parameter is listed with the Rust type that is read. The table is compared with the
    /// declaration by a test, and this with the table in every build, so the examples of the library, which call
    /// every native, show a native that reads otherwise than it is declared.
    fn check_type(&self, name: &str, rust_type: &'static str) {
        let listed = self.native.parameters.iter().find(|parameter| parameter.name == name);
        let listed = listed.map(|parameter| (parameter.rust_type)());
        assert_eq!(listed, Some(rust_type), "`{}` reads `{name}` as its table says", self.native.key);
    }
}

impl Interpreter<'_> {
    /// Reads the file of the project that the argument `name` names, relative to the file in which the argument
    /// stands. Returns (path, bytes): its path from the project's root, and its contents. `call`: the call of the
    /// built-in.
    ///
    /// # Errors
    /// A fault where the name leads out of the project or the file can't be read.
    pub fn project_file(&mut self, call: &Call, name: &str) -> Eval<(String, Vec<u8>)> {
        let at = call.at(name);
        let name: &str = call.get(name)?;
        let from = &self.shared.sources.file(at.file).name;
        let Some(path) = crate::source::files::join(from, name) else {
            let message = format!("`{name}` leads out of the project");
            return Err(fault(code::OUTSIDE_PROJECT, at, message, "outside of the project"));
        };
        let bytes = self.shared.host.read(&path).map_err(|error| {
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
