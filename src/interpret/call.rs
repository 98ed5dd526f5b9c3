//! Calls: of functions, built-ins, function values and behaviours.

use super::design::Instance;
use super::eval::Frame;
use super::host::Mode;
use super::interpreter::Interpreter;
use super::stop::{Eval, Stop, fault};
use super::value::{Behavior, Callable, Value};
use crate::check::typed::{BehaviorDef, DefId, DefKind, Expr, FnDef, NativeDef, Param};
use crate::natives::{self, Effect};
use crate::plan::{Node, Target};
use crate::source::{ReadError, Span, Symbol, code};
use std::rc::Rc;
use std::sync::Arc;

/// Arguments in the order of the parameters; `None`: the default is wanted.
pub struct Args {
    pub values: Vec<Option<Value>>,
    /// Where each argument stands; the whole call for those left out.
    pub spans: Vec<Span>,
}

/// A call of a built-in with all arguments evaluated.
pub struct Call<'c> {
    pub span: Span,
    pub args: &'c [Value],
    pub spans: &'c [Span],
}

impl Args {
    fn plain(values: Vec<Value>, span: Span) -> Args {
        let spans = vec![span; values.len()];
        Args { values: values.into_iter().map(Some).collect(), spans }
    }
}

impl Interpreter<'_> {
    pub fn eval_args(&mut self, args: &[Option<Expr>], span: Span, frame: &mut Frame) -> Eval<Args> {
        let mut values = Vec::with_capacity(args.len());
        let mut spans = Vec::with_capacity(args.len());
        for arg in args {
            values.push(self.eval_optional(arg.as_ref(), frame)?);
            spans.push(arg.as_ref().map_or(span, |a| a.span));
        }
        Ok(Args { values, spans })
    }

    pub fn call_def(
        &mut self,
        def: DefId,
        args: &[Option<Expr>],
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let args = self.eval_args(args, span, frame)?;
        self.apply_def(def, args, span)
    }

    pub fn eval_call_value(
        &mut self,
        callee: &Expr,
        args: &[Expr],
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let callee = self.eval(callee, frame)?;
        let values = args.iter().map(|a| self.eval(a, frame)).collect::<Eval<Vec<_>>>()?;
        match callee {
            Value::Fn(callable) => self.apply(&callable, values, span),
            _ => Ok(Value::Unknown),
        }
    }

    /// Calls a function value.
    pub fn apply(&mut self, callable: &Callable, values: Vec<Value>, span: Span) -> Eval<Value> {
        match callable {
            Callable::Lambda { body, captured, frame, this } => {
                let mut inner = Frame::new(*frame, this.clone());
                for (slot, value) in values.into_iter().enumerate() {
                    inner.set_slot(slot, value);
                }
                for (slot, value) in captured {
                    inner.set(*slot, value.clone());
                }
                self.called(span, Symbol::new("=>"), |this| this.eval(body, &mut inner))
            }
            Callable::Def(def) => self.apply_def(*def, Args::plain(values, span), span),
            Callable::Behavior { object, behavior } => {
                self.apply_behavior(object, *behavior, Args::plain(values, span), span)
            }
        }
    }

    fn apply_def(&mut self, def: DefId, args: Args, span: Span) -> Eval<Value> {
        let program = self.program;
        match &program.def(def).kind {
            DefKind::Fn(function) => self.call_fn(function, program.def(def).name, args, span),
            DefKind::Native(native) => self.call_native(native, args, span),
            _ => Ok(Value::Unknown),
        }
    }

    fn call_fn(&mut self, function: &FnDef, name: Symbol, args: Args, span: Span) -> Eval<Value> {
        self.called(span, name, |this| {
            let mut frame = Frame::new(function.frame, None);
            this.fill(&function.params, args, &mut frame)?;
            this.eval(&function.body, &mut frame)
        })
    }

    /// Puts arguments and defaults into the first slots of a callee's frame.
    fn fill(&mut self, params: &[Param], args: Args, frame: &mut Frame) -> Eval<()> {
        let mut values = args.values.into_iter();
        for (slot, param) in params.iter().enumerate() {
            let value = match values.next().flatten() {
                Some(value) => value,
                None => self.default(param, frame)?,
            };
            frame.set_slot(slot, value);
        }
        Ok(())
    }

    fn default(&mut self, param: &Param, frame: &mut Frame) -> Eval<Value> {
        match &param.default {
            Some(default) => self.eval(default, frame),
            None if param.variadic => Ok(Value::list(Vec::new())),
            None => Ok(Value::Missing),
        }
    }

    fn call_native(&mut self, native: &NativeDef, args: Args, span: Span) -> Eval<Value> {
        let spans =
            (0..native.params.len()).map(|i| args.spans.get(i).copied().unwrap_or(span)).collect::<Vec<_>>();
        let mut frame = Frame::new(native.frame.max(native.params.len()), None);
        self.fill(&native.params, args, &mut frame)?;
        let values = &frame.slots[..native.params.len()];
        let entry = natives::find(native.key).expect("a test holds bodies to declarations");
        if self.mode == Mode::Check && entry.effect == Effect::OnRun {
            self.check_arguments(values)?;
            return Ok(Value::Unknown);
        }
        if values.iter().any(Value::is_unknown) {
            return Ok(Value::Unknown);
        }
        (entry.body)(self, &Call { span, args: values, spans: &spans })
    }

    /// What can be said without a run about behaviours that a statement hands on.
    fn check_arguments(&mut self, values: &[Value]) -> Eval<()> {
        for value in values {
            if let Value::Behavior(behavior) = value {
                self.check_behavior(behavior)?;
            }
        }
        Ok(())
    }

    pub fn call_behavior(
        &mut self,
        object: &Rc<Instance>,
        behavior: usize,
        args: &[Option<Expr>],
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let args = self.eval_args(args, span, frame)?;
        self.apply_behavior(object, behavior, args, span)
    }

    fn apply_behavior(
        &mut self,
        object: &Rc<Instance>,
        behavior: usize,
        args: Args,
        span: Span,
    ) -> Eval<Value> {
        let program = self.program;
        let DefKind::Config(config) = &program.def(object.design.def).kind else {
            return Ok(Value::Unknown);
        };
        let Some(declared) = config.behaviors.get(behavior) else { return Ok(Value::Unknown) };
        self.called(span, declared.name, |this| this.run_behavior(declared, object, args))
    }

    fn run_behavior(&mut self, declared: &BehaviorDef, object: &Rc<Instance>, args: Args) -> Eval<Value> {
        let mut frame = Frame::new(declared.frame, Some(object.clone()));
        self.fill(&declared.params, args, &mut frame)?;
        let body = self.eval(&declared.body, &mut frame)?;
        let Value::Behavior(behavior) = body else { return Ok(Value::Unknown) };
        // One that only waits still is a behaviour of this robot.
        let robot = Some(behavior.robot.clone().unwrap_or_else(|| object.robot.clone()));
        let behavior = Rc::new(Behavior { robot, node: behavior.node.clone() });
        self.exempt(&behavior, &declared.allows, &mut frame)
    }

    /// The behaviour that a declaration gives with all its defaults; `None` where a parameter has none.
    pub fn default_behavior(&mut self, object: &Rc<Instance>, behavior: &BehaviorDef) -> Eval<Option<Value>> {
        if behavior.params.iter().any(|p| p.default.is_none() && !p.variadic) {
            return Ok(None);
        }
        let args = Args { values: vec![None; behavior.params.len()], spans: Vec::new() };
        self.called(behavior.span, behavior.name, |this| this.run_behavior(behavior, object, args)).map(Some)
    }

    /// `action else b`: what follows the timeout of an action.
    pub fn timeout_else(&mut self, action: &Value, otherwise: &Value, span: Span) -> Eval<Value> {
        let (Value::Behavior(action), Value::Behavior(otherwise)) = (action, otherwise) else {
            return Ok(Value::Unknown);
        };
        let robot = self.common_robot(action.robot.as_ref(), otherwise.robot.as_ref(), span)?;
        let node = natives::with_otherwise(&action.node, &otherwise.node).ok_or_else(|| {
            fault(code::BAD_ACTION, span, "only an action with a timeout has an `else`", "no single action")
        })?;
        Ok(Value::Behavior(Rc::new(Behavior { robot, node: Arc::new(node) })))
    }
}

impl Call<'_> {
    /// The span of an argument; of the call where it was left out.
    pub fn at(&self, index: usize) -> Span {
        self.spans.get(index).copied().unwrap_or(self.span)
    }

    pub fn arg(&self, index: usize) -> &Value {
        self.args.get(index).unwrap_or(&Value::Missing)
    }

    /// A fault about an argument.
    pub fn refuse(&self, index: usize, message: impl Into<String>) -> Stop {
        let message = message.into();
        fault(code::BAD_VALUE, self.at(index), message.clone(), message)
    }

    /// `check` lets through only arguments that fit; this is the net under it.
    fn unfit(&self, index: usize, wanted: &str) -> Stop {
        self.refuse(index, format!("{wanted} is wanted here"))
    }

    pub fn number(&self, index: usize) -> Eval<f64> {
        self.arg(index).as_number().ok_or_else(|| self.unfit(index, "a number"))
    }

    /// A number, or nothing.
    pub fn number_if(&self, index: usize) -> Eval<Option<f64>> {
        match self.arg(index) {
            Value::Missing => Ok(None),
            _ => self.number(index).map(Some),
        }
    }

    /// A number above zero.
    pub fn positive(&self, index: usize, what: &str) -> Eval<f64> {
        let x = self.number(index)?;
        if x > 0.0 { Ok(x) } else { Err(self.refuse(index, format!("{what} must be positive"))) }
    }

    pub fn positive_if(&self, index: usize, what: &str) -> Eval<Option<f64>> {
        match self.arg(index) {
            Value::Missing => Ok(None),
            _ => self.positive(index, what).map(Some),
        }
    }

    /// A whole number of at least zero that a machine word holds.
    pub fn count(&self, index: usize, what: &str) -> Eval<usize> {
        match self.arg(index) {
            Value::Int(n) => {
                usize::try_from(*n).map_err(|_| self.refuse(index, format!("{what} must not be negative")))
            }
            Value::Big(_) => Err(self.refuse(index, format!("{what} is too large"))),
            _ => Err(self.unfit(index, "a whole number")),
        }
    }

    pub fn text(&self, index: usize) -> Eval<&str> {
        match self.arg(index) {
            Value::Text(text) => Ok(text),
            _ => Err(self.unfit(index, "a text")),
        }
    }

    pub fn truth(&self, index: usize) -> Eval<bool> {
        match self.arg(index) {
            Value::Bool(b) => Ok(*b),
            Value::Missing => Ok(false),
            _ => Err(self.unfit(index, "`true` or `false`")),
        }
    }

    pub fn word(&self, index: usize) -> Option<&'static str> {
        match self.arg(index) {
            Value::Word(word) => Some(word.as_str()),
            _ => None,
        }
    }

    pub fn list(&self, index: usize) -> Eval<&Rc<Vec<Value>>> {
        match self.arg(index) {
            Value::List(list) => Ok(list),
            _ => Err(self.unfit(index, "a list")),
        }
    }

    pub fn vec3(&self, index: usize) -> Eval<crate::geometry::Vec3> {
        match self.arg(index) {
            Value::Vec3(v, _) => Ok(*v),
            _ => Err(self.unfit(index, "a vector")),
        }
    }

    pub fn function(&self, index: usize) -> Eval<&Rc<Callable>> {
        match self.arg(index) {
            Value::Fn(function) => Ok(function),
            _ => Err(self.unfit(index, "a function")),
        }
    }

    pub fn instance(&self, index: usize) -> Eval<&Rc<Instance>> {
        match self.arg(index) {
            Value::Instance(instance) => Ok(instance),
            _ => Err(self.unfit(index, "a robot or a part")),
        }
    }

    pub fn joint(&self, index: usize) -> Eval<&super::value::JointValue> {
        match self.arg(index) {
            Value::Joint(joint) => Ok(joint),
            _ => Err(self.unfit(index, "a joint")),
        }
    }

    pub fn port(&self, index: usize) -> Eval<&super::value::PortValue> {
        match self.arg(index) {
            Value::Port(port) => Ok(port),
            _ => Err(self.unfit(index, "a port")),
        }
    }

    pub fn behavior(&self, index: usize) -> Eval<&Rc<Behavior>> {
        match self.arg(index) {
            Value::Behavior(behavior) => Ok(behavior),
            _ => Err(self.unfit(index, "a behaviour")),
        }
    }

    /// A range of quantities, low to high.
    pub fn range(&self, index: usize) -> Eval<(f64, f64)> {
        match self.arg(index) {
            Value::Range(ends) => match (ends.0.as_number(), ends.1.as_number()) {
                (Some(a), Some(b)) => Ok((a, b)),
                _ => Err(self.unfit(index, "a range")),
            },
            _ => Err(self.unfit(index, "a range")),
        }
    }

    pub fn range_if(&self, index: usize) -> Eval<Option<(f64, f64)>> {
        match self.arg(index) {
            Value::Missing => Ok(None),
            _ => self.range(index).map(Some),
        }
    }

    pub fn is_missing(&self, index: usize) -> bool {
        matches!(self.arg(index), Value::Missing)
    }
}

impl Node {
    /// The single action that this is.
    pub fn as_action(&self) -> Option<&crate::plan::Action> {
        match self {
            Node::Action(action) => Some(action),
            _ => None,
        }
    }
}

impl Target {
    pub fn amount(self) -> f64 {
        match self {
            Target::To(x) | Target::By(x) => x,
        }
    }
}

impl Interpreter<'_> {
    /// The file of the project that an argument names, relative to the file of the call: its path from
    /// the project's root, and its bytes.
    pub fn project_file(&mut self, call: &Call, index: usize) -> Eval<(String, Vec<u8>)> {
        let name = call.text(index)?;
        let from = &self.sources.file(call.at(index).file).name;
        let Some(path) = crate::source::files::join(from, name) else {
            let message = format!("`{name}` leads out of the project");
            return Err(fault(code::OUTSIDE_PROJECT, call.at(index), message, "outside of the project"));
        };
        let bytes = self.stage.read(&path).map_err(|error| {
            let why = match error {
                ReadError::NotFound => "there is no such file".to_string(),
                ReadError::Outside => "it leads out of the project".to_string(),
                ReadError::TooLarge(limit) => format!("it is larger than {limit} bytes"),
                ReadError::Failed(why) => why,
            };
            fault(code::CANNOT_READ, call.at(index), format!("`{path}` can't be read: {why}"), why)
        })?;
        Ok((path, bytes))
    }
}
