//! Calls: of functions, built-ins, function values and behaviours.

use super::behavior::with_otherwise;
use super::design::Instance;
use super::frame::Frame;
use super::host::Mode;
use super::identity::Name;
use super::interpreter::Interpreter;
use super::native::{Call, Effect};
use super::record::{DeclaredRecord, Record};
use super::routines::Args;
use super::stop::{Eval, fault};
use super::value::{Behavior, BehaviorCall, Callable, Value};
use crate::check::Type;
use crate::check::typed::{BehaviorDef, DefId, DefKind, Expr, FnDef, NativeDef, Param, RecordDef};
use crate::plan::CauseId;
use crate::source::{Span, Symbol, code};
use std::rc::Rc;
use std::sync::Arc;

/// A call of a declaration as it is written; empty where the declaration is called as a value.
#[derive(Default)]
struct Written<'e> {
    /// The arguments, in the order of the parameters.
    exprs: &'e [Option<Expr>],
    /// True if the type of the call is that of a signal.
    signal: bool,
}

impl Interpreter<'_> {
    /// Evaluates the arguments of a call, which are in the order of the parameters; `None` (the default is wanted)
    /// stays `None`. `span`: the span of the call, which stands for the arguments left out. `args`: the arguments as
    /// written; `frame`: the variables of the body in which the call stands.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`](super::stop::Stop::Halt).
    pub fn eval_args(&mut self, args: &[Option<Expr>], span: Span, frame: &mut Frame) -> Eval<Args> {
        let mut values = Vec::with_capacity(args.len());
        let mut spans = Vec::with_capacity(args.len());
        for arg in args {
            values.push(self.eval_optional(arg.as_ref(), frame)?);
            spans.push(arg.as_ref().map_or(span, |a| a.span));
        }
        Ok(Args { values, spans })
    }

    /// Calls a declared function or a built-in with arguments in the order of the parameters, `None` where the
    /// default is wanted; [`Value::Unknown`] for other declarations. `ty` is the type of the call. `def`: the
    /// function; `args`: the arguments as written; `span`: the span of the call; `frame`: the variables of the body
    /// in which it stands.
    ///
    /// # Errors
    /// A fault of the function or of the built-in, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn call_def(
        &mut self,
        def: DefId,
        args: &[Option<Expr>],
        ty: &Type,
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let values = self.eval_args(args, span, frame)?;
        self.apply_def(def, values, Written { exprs: args, signal: matches!(ty, Type::Signal(_)) }, span)
    }

    /// Builds a record of its fields, in the order of the declaration, `None` where the default is wanted;
    /// [`Value::Unknown`] where one of them is. `def`: the record; `span`: the span of the expression; `frame`: the
    /// variables of the body in which it stands.
    ///
    /// # Errors
    /// A fault of a default, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn build_record(
        &mut self,
        def: DefId,
        fields: &[Option<Expr>],
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let args = self.eval_args(fields, span, frame)?;
        let program = self.shared.program;
        let DefKind::Record(RecordDef { build: Some(build), .. }) = &program.def(def).kind else {
            return Ok(Value::Unknown);
        };
        self.with_call(span, program.def(def).name, |this| {
            let mut inner = Frame::new(build.frame, None);
            this.fill(&build.params, args, &mut inner)?;
            inner.slots.truncate(build.params.len());
            Ok(declared_record(def, inner.slots))
        })
    }

    /// Returns a copy of a record with other values for some of its fields, given by their indices in the
    /// declaration; [`Value::Unknown`] where `object` or one of the values is. `changed`: the indices of the fields
    /// with their new values; `frame`: the variables of the body in which the expression stands.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`](super::stop::Stop::Halt).
    pub fn changed_record(
        &mut self,
        object: &Expr,
        changed: &[(usize, Expr)],
        frame: &mut Frame,
    ) -> Eval<Value> {
        let object = self.eval(object, frame)?;
        let values = changed.iter().map(|(_, value)| self.eval(value, frame)).collect::<Eval<Vec<_>>>()?;
        let Value::Record(record) = object else { return Ok(Value::Unknown) };
        let Record::Declared(DeclaredRecord { def, fields }) = &*record else { return Ok(Value::Unknown) };
        let mut fields = fields.clone();
        for ((index, _), value) in changed.iter().zip(values) {
            if let DefKind::Record(RecordDef { build: Some(build), .. }) = &self.shared.program.def(*def).kind
            {
                value.bind(Name { span: build.params[*index].span, index: None });
            }
            fields[*index] = value;
        }
        Ok(declared_record(*def, fields))
    }

    /// Evaluates a function value and its arguments, and calls it; [`Value::Unknown`] where the function is.
    /// `callee`: the function value; `args`: the arguments in order; `span`: the span of the call; `frame`: the
    /// variables of the body in which it stands.
    ///
    /// # Errors
    /// As [`apply`](Self::apply).
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

    /// Calls a function value with its arguments, in the order of the parameters and one for each; returns its
    /// result. `callable`: the function value; `values`: the arguments; `span`: the span of the call.
    ///
    /// # Errors
    /// A fault of the function or of the built-in, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn apply(&mut self, callable: &Callable, values: Vec<Value>, span: Span) -> Eval<Value> {
        match callable {
            Callable::Lambda { body, captured, frame, this } => {
                let mut inner = Frame::new(*frame, this.clone());
                for (slot, value) in values.into_iter().enumerate() {
                    value.bind(Name { span: body.span, index: Some(slot) });
                    inner.set_slot(slot, value);
                }
                for (slot, value) in captured {
                    inner.set(*slot, value.clone());
                }
                self.with_call(span, Symbol::new("=>"), |this| this.eval(body, &mut inner))
            }
            Callable::Def(def) => self.apply_def(*def, Args::plain(values, span), Written::default(), span),
            Callable::Behavior { object, behavior } => {
                self.apply_behavior(object, *behavior, Args::plain(values, span), span)
            }
        }
    }

    /// Calls a declared function or a built-in.
    fn apply_def(&mut self, def: DefId, args: Args, written: Written, span: Span) -> Eval<Value> {
        let program = self.shared.program;
        match &program.def(def).kind {
            DefKind::Fn(function) => self.call_fn(function, program.def(def).name, args, span),
            DefKind::Native(native) => self.call_native(native, args, written, span),
            _ => Ok(Value::Unknown),
        }
    }

    fn call_fn(&mut self, function: &FnDef, name: Symbol, args: Args, span: Span) -> Eval<Value> {
        self.with_call(span, name, |this| {
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
            value.bind(Name { span: param.span, index: None });
            frame.set_slot(slot, value);
        }
        Ok(())
    }

    /// Returns the default of a parameter: its expression's value, an empty list, or the missing value.
    fn default(&mut self, param: &Param, frame: &mut Frame) -> Eval<Value> {
        match &param.default {
            Some(default) => self.eval(default, frame),
            None if param.variadic => Ok(Value::list(Vec::new())),
            None => Ok(Value::Missing),
        }
    }

    fn call_native(&mut self, native: &NativeDef, args: Args, written: Written, span: Span) -> Eval<Value> {
        let spans =
            (0..native.params.len()).map(|i| args.spans.get(i).copied().unwrap_or(span)).collect::<Vec<_>>();
        let mut frame = Frame::new(native.frame.max(native.params.len()), None);
        self.fill(&native.params, args, &mut frame)?;
        let values = &frame.slots[..native.params.len()];
        let entry = (self.shared.routines.native)(native.key).expect("a test holds bodies to declarations");
        self.stack.effects += u64::from(entry.effect == Effect::OnRun);
        if self.shared.mode == Mode::Check && entry.effect == Effect::OnRun {
            self.check_arguments(values, span)?;
            self.check_robots(&native.params, values, &spans)?;
            return Ok(Value::Unknown);
        }
        if values.iter().any(Value::is_unknown) {
            return Ok(Value::Unknown);
        }
        let (params, spans) = (&native.params, &spans);
        let Written { exprs, signal } = written;
        (entry.body)(self, &Call { span, native: entry, params, args: values, spans, exprs, signal })
    }

    /// Checks that the configurations that stand for a plan have modules.
    fn check_robots(&mut self, params: &[Param], values: &[Value], spans: &[Span]) -> Eval<()> {
        let is_planned =
            |ty: &Type| matches!(ty, Type::Choice(choice) if choice.types.contains(&Type::Behavior));
        for ((param, value), span) in params.iter().zip(values).zip(spans) {
            if let Value::Instance(instance) = value
                && is_planned(&param.ty)
                && instance.robot.module_count() == 0
            {
                self.robot_of(&instance.robot, *span)?;
            }
        }
        Ok(())
    }

    /// Checks the behaviours among the arguments, as far as that is possible without a run.
    fn check_arguments(&mut self, values: &[Value], span: Span) -> Eval<()> {
        for value in values {
            if let Value::Behavior(behavior) = value {
                self.check_behavior(behavior, span)?;
            }
        }
        Ok(())
    }

    /// Calls a behaviour of an instance, by its index in the declaration, with arguments in the order of the
    /// parameters, `None` where the default is wanted; [`Value::Unknown`] if the instance is of no configuration or
    /// has no such behaviour. `object`: the instance; `behavior`: the index; `args`: the arguments as written;
    /// `span`: the span of the call; `frame`: the variables of the body in which it stands.
    ///
    /// # Errors
    /// A fault of the behaviour, or `Stop::Halt` if a limit is reached or the user cancels.
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
        let program = self.shared.program;
        let DefKind::Config(config) = &program.def(object.design.def).kind else {
            return Ok(Value::Unknown);
        };
        let Some(declared) = config.behaviors.get(behavior) else { return Ok(Value::Unknown) };
        let name = declared.name;
        // Blame for contracts falls on the call, with the loop variables of the caller.
        let judged = declared.contracts.iter().any(|(_, judged)| *judged);
        let called = judged.then(|| (span, self.cause(span, Vec::new(), "")));
        self.with_call(span, name, |this| this.recall_behavior(declared, behavior, object, args, called))
    }

    /// Returns the behaviour that the same call gave before, or makes it. A call that prints, or fails, is made
    /// anew.
    fn recall_behavior(
        &mut self,
        declared: &BehaviorDef,
        behavior: usize,
        object: &Rc<Instance>,
        args: Args,
        called: Option<(Span, CauseId)>,
    ) -> Eval<Value> {
        let in_library = self.is_library(declared.span);
        let caller = if in_library { self.user_call().map(|call| call.span) } else { None };
        let caller = called.map(|(span, _)| span).or(caller);
        let call = BehaviorCall { object: object.clone(), behavior, args: args.values.clone(), caller };
        if let Some(known) = self.memory.recalled.find(call.key(), |other| call.is_same(other)) {
            return Ok(Value::Behavior(known));
        }
        let (errors, effects, steps) = (self.reported.errors, self.stack.effects, self.stack.steps);
        let value = self.run_behavior(declared, object, args, called.map(|(_, cause)| cause))?;
        let clean = errors == self.reported.errors && effects == self.stack.effects;
        if let Value::Behavior(made) = &value
            && clean
        {
            self.memory.recalled.keep(call.key(), call, made.clone(), self.stack.steps - steps);
        }
        Ok(value)
    }

    /// Returns the behaviour that the body of a declaration gives, with its contracts and exemptions. `called`: the cause of
    /// the call, if the declaration has contracts.
    fn run_behavior(
        &mut self,
        declared: &BehaviorDef,
        object: &Rc<Instance>,
        args: Args,
        called: Option<CauseId>,
    ) -> Eval<Value> {
        let mut frame = Frame::new(declared.frame, Some(object.clone()));
        self.fill(&declared.params, args, &mut frame)?;
        let body = self.eval(&declared.body, &mut frame)?;
        let Value::Behavior(behavior) = body else { return Ok(Value::Unknown) };
        // One that only waits still is a behaviour of this robot.
        let robot = Some(behavior.robot.clone().unwrap_or_else(|| object.robot.clone()));
        let stated = std::mem::take(&mut frame.contracts);
        let node = self.with_contracts(&behavior.node, declared.name, stated, called);
        let behavior = Rc::new(Behavior { robot, node });
        self.exempt(&behavior, &declared.allows, &mut frame)
    }

    /// Returns the behaviour that a declaration gives with all its defaults; `None` where a parameter has none.
    /// `object`: the instance whose behaviour it is; `behavior`: the declaration of the behaviour.
    ///
    /// # Errors
    /// A fault of the behaviour, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn default_behavior(&mut self, object: &Rc<Instance>, behavior: &BehaviorDef) -> Eval<Option<Value>> {
        if behavior.params.iter().any(|p| p.default.is_none() && !p.variadic) {
            return Ok(None);
        }
        let args = Args { values: vec![None; behavior.params.len()], spans: Vec::new() };
        self.with_call(behavior.span, behavior.name, |this| {
            let called = this.cause(behavior.span, Vec::new(), "");
            this.run_behavior(behavior, object, args, Some(called))
        })
        .map(Some)
    }

    /// Returns the behaviour `action else b`, in which `b` follows the timeout of an action; `Value::Unknown` where one
    /// of them is. `otherwise`: the behaviour `b`; `span`: the span of the whole expression.
    ///
    /// # Errors
    /// A fault where the two move different robots, or `action` is not a single action with a timeout.
    pub fn timeout_else(&mut self, action: &Value, otherwise: &Value, span: Span) -> Eval<Value> {
        let (Value::Behavior(action), Value::Behavior(otherwise)) = (action, otherwise) else {
            return Ok(Value::Unknown);
        };
        let robot = self.common_subject(action.robot.as_ref(), otherwise.robot.as_ref(), span)?;
        let node = with_otherwise(&action.node, &otherwise.node).ok_or_else(|| {
            fault(code::BAD_ACTION, span, "only an action with a timeout has an `else`", "no single action")
        })?;
        Ok(Value::Behavior(Rc::new(Behavior { robot, node: Arc::new(node) })))
    }
}

/// Returns a record of a declaration with the values of its fields; `Value::Unknown` where one is.
fn declared_record(def: DefId, fields: Vec<Value>) -> Value {
    if fields.iter().any(Value::is_unknown) {
        return Value::Unknown;
    }
    Value::Record(Rc::new(Record::Declared(DeclaredRecord { def, fields })))
}
