//! The evaluation of expressions to values.

use super::design::{DesignKind, Instance};
use super::frame::Frame;
use super::identity::Name;
use super::interpreter::Interpreter;
use super::scene_design::obstacle_value;
use super::stop::{Eval, Stop, fault};
use super::study::study_value;
use super::value::{Callable, Lazy, Value};
use crate::check::Type;
use crate::check::family::Instantiable;
use crate::check::typed::{Clause, DefId, DefKind, Expr, ExprKind, Local, MemberId, StmtKind};
use crate::source::{Diagnostic, Span, code};
use crate::units::quantity_in;
use std::rc::Rc;
use std::sync::Arc;

impl Interpreter<'_> {
    /// Returns the value of an expression. A fault is reported, and the value is then `Value::Unknown`.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn eval(&mut self, expr: &Expr, frame: &mut Frame) -> Eval<Value> {
        self.step(expr.span)?;
        let result = self.with_depth(expr.span, |this| this.eval_kind(expr, frame));
        let value = self.recover(result)?;
        if value.is_unknown() {
            self.reported.unknown_at.get_or_insert(expr.span);
        }
        Ok(value)
    }

    /// Returns the value of the expression of a `let`; a robot in it gets its name. A fault is reported and leaves
    /// `Value::Unknown`.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn eval_bound(&mut self, expr: &Expr, frame: &mut Frame) -> Eval<Value> {
        let value = self.eval(expr, frame)?;
        value.bind(Name { span: expr.span, index: None });
        Ok(value)
    }

    /// Returns the value of an expression that may be left out; `None` if it is. A fault is reported and leaves
    /// `Value::Unknown`.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn eval_optional(&mut self, expr: Option<&Expr>, frame: &mut Frame) -> Eval<Option<Value>> {
        expr.map(|e| self.eval(e, frame)).transpose()
    }

    /// Returns the value of an expression by its kind; [`eval`](Self::eval) reports its fault.
    fn eval_kind(&mut self, expr: &Expr, frame: &mut Frame) -> Eval<Value> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Error => Ok(Value::Unknown),
            ExprKind::Number(x) => {
                Ok(Value::Quantity(*x, expr.ty.dimension().unwrap_or(crate::units::Dimension::NUMBER)))
            }
            ExprKind::Int(n) => Ok(Value::Int(*n)),
            ExprKind::BigInt(digits) => self.big_literal(digits.as_str(), span),
            ExprKind::Bool(b) => Ok(Value::Bool(*b)),
            ExprKind::Text(text) => Ok(Value::text(text)),
            ExprKind::Interpolation(pieces) => self.eval_interpolation(pieces, span, frame),
            ExprKind::Shown { value, unit, decimals } => {
                let value = self.eval(value, frame)?;
                let unit = unit.as_ref().map(|(name, factor)| (&**name, *factor));
                Ok(shown(&value, unit, *decimals).map_or(Value::Unknown, Value::text))
            }
            ExprKind::Word(word) => Ok(Value::Word(*word)),
            ExprKind::Missing => Ok(Value::Missing),
            ExprKind::Local(local) => Ok(frame.get(*local)),
            ExprKind::Global(def) => self.global(*def, span),
            ExprKind::FnValue(def) => Ok(Value::Fn(Rc::new(Callable::Def(*def)))),
            ExprKind::BehaviorValue { object, behavior } => {
                self.eval_behavior_value(object, *behavior, frame)
            }
            ExprKind::This => Ok(frame.this.clone().map_or(Value::Unknown, Value::Instance)),
            ExprKind::Member { object, member } => match self.eval(object, frame)? {
                Value::Instance(instance) => self.member(&instance, *member, span),
                _ => Ok(Value::Unknown),
            },
            ExprKind::Joint { object, joint } => {
                Ok(on_instance(&self.eval(object, frame)?, |instance| instance.joint(*joint)))
            }
            ExprKind::Port { object, port } => self.eval_port(object, *port, frame),
            ExprKind::Hinge(port) => match self.eval(port, frame)? {
                Value::Port(port) => (self.shared.routines.hinge_of)(self, &port, span),
                _ => Ok(Value::Unknown),
            },
            ExprKind::Field { object, field } => match self.eval(object, frame)? {
                Value::Unknown => Ok(Value::Unknown),
                value => self.field(&value, *field, span),
            },
            ExprKind::Record { def, fields } => self.build_record(*def, fields, span, frame),
            ExprKind::With { object, fields } => self.changed_record(object, fields, frame),
            ExprKind::List(elements) => self.eval_list(elements, frame),
            ExprKind::Comprehension { body, clauses } => self.eval_comprehension(body, clauses, span, frame),
            ExprKind::Vec3(coordinates) => self.eval_vec3(coordinates, frame),
            ExprKind::Range { from, to } => {
                let ends = (self.eval(from, frame)?, self.eval(to, frame)?);
                let unknown = ends.0.is_unknown() || ends.1.is_unknown();
                Ok(if unknown { Value::Unknown } else { Value::Range(Rc::new(ends)) })
            }
            ExprKind::Unary { op, operand } => {
                let value = self.eval(operand, frame)?;
                self.unary(*op, &value, span)
            }
            ExprKind::Binary { op, left, right } => self.eval_binary(*op, left, right, span, frame),
            ExprKind::OrElse { value, otherwise } => match self.eval(value, frame)? {
                Value::Missing => self.eval(otherwise, frame),
                value => Ok(value),
            },
            ExprKind::TimeoutElse { action, otherwise } => {
                let action = self.eval(action, frame)?;
                let otherwise = self.eval(otherwise, frame)?;
                self.timeout_else(&action, &otherwise, span)
            }
            ExprKind::SetDimension(inner) => Ok(in_dimensions(self.eval(inner, frame)?, &expr.ty)),
            ExprKind::Index { object, index } => self.eval_index(object, index, span, frame),
            ExprKind::If { condition, then, otherwise } => match self.eval(condition, frame)? {
                Value::Bool(true) => self.eval(then, frame),
                Value::Bool(false) => {
                    Ok(self.eval_optional(otherwise.as_deref(), frame)?.unwrap_or(Value::Nothing))
                }
                _ => Ok(Value::Unknown),
            },
            ExprKind::Block { statements, value } => {
                for statement in statements {
                    let errors = self.reported.errors;
                    self.execute(statement, frame)?;
                    // Nothing is computed for which a requirement that failed was to make sure.
                    if matches!(statement.kind, StmtKind::Expect { .. }) && self.failed_since(errors) {
                        return Ok(Value::Unknown);
                    }
                }
                Ok(self.eval_optional(value.as_deref(), frame)?.unwrap_or(Value::Nothing))
            }
            ExprKind::Lambda { captures, body, frame: size, .. } => {
                Ok(Value::Fn(Rc::new(Callable::Lambda {
                    body: Arc::clone(body),
                    captured: captures.iter().map(|(from, to)| (*to, frame.get(*from))).collect(),
                    frame: *size,
                    this: frame.this.clone(),
                })))
            }
            ExprKind::Call { def, args } => self.call_def(*def, args, &expr.ty, span, frame),
            ExprKind::CallValue { callee, args } => self.eval_call_value(callee, args, span, frame),
            ExprKind::CallBehavior { object, behavior, args } => {
                match self.eval(object, frame)? {
                    Value::Instance(instance) => self.call_behavior(&instance, *behavior, args, span, frame),
                    _ => {
                        // The arguments may hold mistakes of their own.
                        for arg in args.iter().flatten() {
                            self.eval(arg, frame)?;
                        }
                        Ok(Value::Unknown)
                    }
                }
            }
            ExprKind::Instance { def, args } => {
                let args = self.eval_args(args, span, frame)?;
                (self.shared.routines.instantiate)(self, *def, args, span)
            }
        }
    }

    fn eval_list(&mut self, elements: &[Expr], frame: &mut Frame) -> Eval<Value> {
        let values = elements.iter().map(|e| self.eval(e, frame)).collect::<Eval<Vec<_>>>()?;
        Ok(Value::list(values))
    }

    fn eval_vec3(&mut self, coordinates: &[Expr; 3], frame: &mut Frame) -> Eval<Value> {
        let mut point = crate::geometry::Vec3::zeros();
        let mut dimension = None;
        let mut known = true;
        for (i, coordinate) in coordinates.iter().enumerate() {
            let value = self.eval(coordinate, frame)?;
            known &= !value.is_unknown();
            point[i] = value.as_number().unwrap_or(0.0);
            dimension = dimension.or(value.as_dimension());
        }
        let dimension = dimension.unwrap_or(crate::units::Dimension::NUMBER);
        Ok(if known { Value::Vec3(point, dimension) } else { Value::Unknown })
    }

    fn eval_port(&mut self, object: &Expr, port: usize, frame: &mut Frame) -> Eval<Value> {
        let value = self.eval(object, frame)?;
        let program = self.shared.program;
        Ok(on_instance(&value, |instance| {
            let DefKind::Module(module) = &program.def(instance.design.def).kind else { return None };
            instance.port(port, module.ports.get(port)?.array)
        }))
    }

    fn eval_behavior_value(&mut self, object: &Expr, behavior: usize, frame: &mut Frame) -> Eval<Value> {
        Ok(match self.eval(object, frame)? {
            Value::Instance(object) => Value::Fn(Rc::new(Callable::Behavior { object, behavior })),
            _ => Value::Unknown,
        })
    }

    fn eval_interpolation(&mut self, pieces: &[Expr], span: Span, frame: &mut Frame) -> Eval<Value> {
        let mut text = String::new();
        let mut known = true;
        for piece in pieces {
            let value = self.eval(piece, frame)?;
            known &= !value.is_unknown();
            text.push_str(&self.show(&value));
            self.check_text(text.len(), span)?;
        }
        Ok(if known { Value::text(text) } else { Value::Unknown })
    }

    fn eval_comprehension(
        &mut self,
        body: &Expr,
        clauses: &[Clause],
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let mut out = Vec::new();
        let mut known = true;
        self.comprehend(body, clauses, span, frame, &mut out, &mut known)?;
        Ok(if known { Value::list(out) } else { Value::Unknown })
    }

    /// Adds the elements that the clauses give, from the first of them on, to `out`; `known` becomes false if a
    /// condition or a list is unknown.
    fn comprehend(
        &mut self,
        body: &Expr,
        clauses: &[Clause],
        span: Span,
        frame: &mut Frame,
        out: &mut Vec<Value>,
        known: &mut bool,
    ) -> Eval<()> {
        match clauses.split_first() {
            None => {
                out.push(self.eval(body, frame)?);
                self.check_list(out.len(), span)
            }
            Some((Clause::If(condition), rest)) => match self.eval(condition, frame)? {
                Value::Bool(true) => self.comprehend(body, rest, span, frame, out, known),
                Value::Bool(false) => Ok(()),
                _ => {
                    *known = false;
                    Ok(())
                }
            },
            Some((Clause::For { binder, iterable }, rest)) => {
                let values = self.eval(iterable, frame)?;
                let complete = self.for_each(&values, *binder, iterable.span, frame, |this, frame| {
                    this.comprehend(body, rest, span, frame, out, known)
                })?;
                *known &= complete;
                Ok(())
            }
        }
    }

    /// Runs `body` for every element of a list, or for the whole numbers of a range without its upper end, each in
    /// the variable `binder`. Returns false if `values` is neither, because it is unknown. `frame`: the variables of
    /// the body in which the loop stands.
    ///
    /// # Errors
    /// A fault at `span` where an end of the range is not a whole number of 64 bits, besides the errors of `body`.
    pub fn for_each(
        &mut self,
        values: &Value,
        binder: Local,
        span: Span,
        frame: &mut Frame,
        mut body: impl FnMut(&mut Self, &mut Frame) -> Eval<()>,
    ) -> Eval<bool> {
        let name = self.binder_name(span);
        let mut once = |this: &mut Self, frame: &mut Frame, value: Value, index: Option<usize>| {
            value.bind(Name { span, index });
            frame.set(binder, value.clone());
            this.with_binding(name, &value, |this| body(this, frame))
        };
        match values {
            Value::List(elements) => {
                for (index, value) in elements.iter().enumerate() {
                    once(self, frame, value.clone(), Some(index))?;
                }
            }
            Value::Range(ends) => {
                let (Value::Int(from), Value::Int(to)) = (&ends.0, &ends.1) else {
                    return Err(fault(
                        code::SIZE_LIMIT,
                        span,
                        "a loop over a range with such ends does not end",
                        "whole numbers below 2^63 are wanted",
                    ));
                };
                for i in *from..*to {
                    self.step(span)?;
                    once(self, frame, Value::Int(i), None)?;
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Returns the name of the loop variable, which stands before `in` and the expression at `span`.
    fn binder_name(&self, span: Span) -> crate::source::Symbol {
        let text = &self.shared.sources.file(span.file).text[..span.start as usize];
        let before = text.trim_end().strip_suffix("in").unwrap_or("").trim_end();
        let start = before.rfind(|c: char| !c.is_alphanumeric() && c != '_').map_or(0, |i| i + 1);
        before[start..].into()
    }

    /// Returns an element of a list or a vector; `Value::Unknown` where an operand is.
    ///
    /// # Errors
    /// A fault at `span` where the index is outside.
    fn eval_index(&mut self, object: &Expr, index: &Expr, span: Span, frame: &mut Frame) -> Eval<Value> {
        let list = self.eval(object, frame)?;
        let index = self.eval(index, frame)?;
        let list = match list {
            Value::Vec3(vector, dimension) => {
                Value::list(vector.iter().map(|x| Value::Quantity(*x, dimension)).collect())
            }
            list => list,
        };
        let (Value::List(elements), Some(at)) = (&list, index.as_big()) else { return Ok(Value::Unknown) };
        let found = usize::try_from(&at).ok().and_then(|at| elements.get(at));
        found.cloned().ok_or_else(|| {
            let name = self.shared.sources.text(object.span);
            let elements = match elements.len() {
                0 => "no elements".to_string(),
                1 => "1 element".to_string(),
                n => format!("{n} elements"),
            };
            let mut diagnostic = Diagnostic::error(
                code::INDEX,
                format!("index {at} is outside `{name}`, which has {elements}"),
            )
            .label(span, format!("index {at} of {elements}"));
            if !list_is_empty(&list) {
                diagnostic = diagnostic.hint("elements are counted from 0");
                if at.sign() == num_bigint::Sign::Minus {
                    diagnostic = diagnostic.hint(format!("the last one is `{name}[len({name}) - 1]`"));
                }
            }
            Stop::from(diagnostic)
        })
    }

    /// Returns the value of a top-level `let`; it is evaluated once. [`Value::Unknown`] for other declarations.
    /// `def`: the declaration of the `let`.
    ///
    /// # Errors
    /// A fault at `span` where the value needs itself, or `Stop::Halt` if a limit is reached or the user cancels.
    pub fn global(&mut self, def: DefId, span: Span) -> Eval<Value> {
        let index = def.0 as usize;
        match &self.memory.globals[index] {
            Lazy::Done(value) => return Ok(value.clone()),
            Lazy::Running => return Err(self.cycle(def, span)),
            Lazy::Waiting => {}
        }
        let program = self.shared.program;
        let DefKind::Let(binding) = &program.def(def).kind else { return Ok(study_value(program, def)) };
        self.memory.globals[index] = Lazy::Running;
        let name = self.name(def);
        let result = self.with_call(span, name, |this| {
            this.eval_bound(&binding.value, &mut Frame::new(binding.frame, None))
        });
        self.memory.globals[index] = Lazy::Done(result.as_ref().map_or(Value::Unknown, Value::clone));
        result
    }

    fn cycle(&self, def: DefId, span: Span) -> Stop {
        let declared = self.shared.program.def(def);
        Diagnostic::error(code::DECLARATION_CYCLE, format!("the value of `{}` needs itself", declared.name))
            .label(span, "needed here, before it has a value")
            .label(declared.span, "declared here")
            .into()
    }

    /// Returns a member of an instance; a `let` or a port is evaluated once. Panics if its declaration has no
    /// such member.
    ///
    /// # Errors
    /// A fault where the member needs itself, or parts that are still being elaborated.
    pub fn member(&mut self, instance: &Rc<Instance>, member: MemberId, span: Span) -> Eval<Value> {
        use crate::check::typed::MemberKind;
        let program = self.shared.program;
        let body = program.def(instance.design.def).kind.instantiable();
        let Instantiable { members, frame, .. } = body.expect("only such declarations have designs");
        let declared = &members[member.0 as usize];
        match &declared.kind {
            MemberKind::Param(index) => {
                Ok(instance.design.args.get(*index).cloned().unwrap_or(Value::Unknown))
            }
            MemberKind::Part(index) => match instance.parts() {
                Some(parts) => Ok(parts.get(*index).cloned().unwrap_or(Value::Unknown)),
                None if instance.design.broken.get() => Ok(Value::Unknown),
                None => Err(fault(
                    code::DECLARATION_CYCLE,
                    span,
                    format!(
                        "the parts of `{}` need `{}`, which is one of them",
                        instance.design.name, declared.name
                    ),
                    "needed before the parts exist",
                )),
            },
            MemberKind::Let(value) => self.lazy_member(instance, member, span, |this| {
                this.eval_bound(value, &mut Frame::new(frame, Some(instance.clone())))
            }),
            MemberKind::Port { count, value } => self.lazy_member(instance, member, span, |this| {
                let mut frame = Frame::new(frame, Some(instance.clone()));
                let ports = this.eval(value, &mut frame)?;
                this.check_port_count(count.as_ref(), &ports, value.span, &mut frame)?;
                Ok(ports)
            }),
            MemberKind::Node => {
                let DesignKind::Truss(truss) = &instance.design.kind else { return Ok(Value::Unknown) };
                Ok(truss.position_of(declared.name).unwrap_or(Value::Unknown))
            }
            MemberKind::Obstacle => {
                obstacle_value(instance, declared.name, matches!(declared.ty, Type::List(_)), span)
            }
            MemberKind::Behavior(behavior) => {
                Ok(Value::Fn(Rc::new(Callable::Behavior { object: instance.clone(), behavior: *behavior })))
            }
        }
    }

    /// Returns the value of a member that is computed when it is first needed.
    ///
    /// # Errors
    /// A fault at `span` where the member is being computed.
    fn lazy_member(
        &mut self,
        instance: &Rc<Instance>,
        member: MemberId,
        span: Span,
        compute: impl FnOnce(&mut Self) -> Eval<Value>,
    ) -> Eval<Value> {
        let key = member.0 as usize;
        let known = instance.lazy.borrow().get(&key).cloned().unwrap_or_default();
        match known {
            Lazy::Done(value) => return Ok(value),
            Lazy::Running => {
                let name = self.shared.sources.text(span);
                return Err(fault(
                    code::DECLARATION_CYCLE,
                    span,
                    format!("the value of `{name}` needs itself"),
                    "needed here, before it has a value",
                ));
            }
            Lazy::Waiting => {}
        }
        instance.lazy.borrow_mut().insert(key, Lazy::Running);
        self.computed.push((instance.clone(), key));
        let result = compute(self);
        let value = result.as_ref().map_or(Value::Unknown, Value::clone);
        instance.lazy.borrow_mut().insert(key, Lazy::Done(value));
        result
    }

    /// Refuses a list of ports of another length than the declared one, if one is declared.
    ///
    /// # Errors
    /// A fault at `span` where they differ.
    fn check_port_count(
        &mut self,
        count: Option<&Expr>,
        ports: &Value,
        span: Span,
        frame: &mut Frame,
    ) -> Eval<()> {
        let (Some(count), Value::List(ports)) = (count, ports) else { return Ok(()) };
        let Some(wanted) = self.eval(count, frame)?.as_big() else { return Ok(()) };
        if wanted == num_bigint::BigInt::from(ports.len()) {
            return Ok(());
        }
        let message = format!("{wanted} ports are declared, and the list has {}", ports.len());
        Err(Diagnostic::error(code::BAD_VALUE, message)
            .label(span, format!("{} ports", ports.len()))
            .label(count.span, "declared here")
            .into())
    }

    /// Refuses a list whose length, in elements, is over the limit of the run.
    ///
    /// # Errors
    /// A fault where it is longer.
    pub fn check_list(&mut self, length: usize, span: Span) -> Eval<()> {
        let limit = self.limits().list;
        if length <= limit {
            return Ok(());
        }
        self.too_large(span, format!("a list of more than {limit} elements"))
    }

    /// Refuses a text whose length, in bytes, is over the limit of the run.
    ///
    /// # Errors
    /// A fault where it is longer.
    pub fn check_text(&mut self, length: usize, span: Span) -> Eval<()> {
        let limit = self.limits().text;
        if length <= limit {
            return Ok(());
        }
        self.too_large(span, format!("a text of more than {limit} bytes"))
    }

    fn too_large(&mut self, span: Span, what: String) -> Eval<()> {
        Err(fault(code::SIZE_LIMIT, span, format!("{what} is not allowed"), what.clone()))
    }
}

/// Returns the result of `ask` for an instance; unknown for other values, and where `ask` gives none.
fn on_instance(value: &Value, ask: impl FnOnce(&Rc<Instance>) -> Option<Value>) -> Value {
    match value {
        Value::Instance(instance) => ask(instance).unwrap_or(Value::Unknown),
        _ => Value::Unknown,
    }
}

/// Returns a value with its quantities in the dimensions of a type.
fn in_dimensions(value: Value, ty: &Type) -> Value {
    match (value, ty) {
        (value, Type::Optional(inner)) => in_dimensions(value, inner),
        (Value::Quantity(x, own), Type::Quantity(dimension)) if own.fits(*dimension) => {
            Value::Quantity(x, *dimension)
        }
        (Value::Vec3(v, d), Type::Vec3(inner)) => Value::Vec3(v, inner.dimension().unwrap_or(d)),
        (Value::List(elements), Type::List(inner)) => {
            Value::list(elements.iter().map(|element| in_dimensions(element.clone(), inner)).collect())
        }
        (Value::Range(ends), Type::Range(inner)) => {
            let [from, to] = [&ends.0, &ends.1].map(|end| in_dimensions(end.clone(), inner));
            Value::Range(Rc::new((from, to)))
        }
        (value, _) => value,
    }
}

fn list_is_empty(value: &Value) -> bool {
    matches!(value, Value::List(elements) if elements.is_empty())
}

/// Returns quantities as text in a unit, given by its name and its factor to SI, and with a number of decimals, as far
/// as they are stated; `None` for other values, which `check` excludes, and where one is unknown.
fn shown(value: &Value, unit: Option<(&str, f64)>, decimals: Option<usize>) -> Option<String> {
    let each = |values: &mut dyn Iterator<Item = Value>| -> Option<String> {
        let shown: Option<Vec<String>> = values.map(|value| shown(&value, unit, decimals)).collect();
        Some(format!("[{}]", shown?.join(", ")))
    };
    match value {
        Value::List(elements) => each(&mut elements.iter().cloned()),
        Value::Vec3(v, dimension) => each(&mut v.iter().map(|x| Value::Quantity(*x, *dimension))),
        Value::Missing => Some("_".into()),
        value => Some(quantity_in(value.as_number()?, value.as_dimension()?, unit, decimals)),
    }
}
