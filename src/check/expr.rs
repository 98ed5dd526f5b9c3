//! Expressions of all kinds: expected types, choices, blocks and lambdas.

use super::checker::Checker;
use super::describe::{dimension_with_unit, dimension_words};
use super::family::Family;
use super::hints::dimension_hint;
use super::literals::direction;
use super::scope::Scope;
use super::typed::{Expr, ExprKind, StmtKind};
use super::types::{FnType, Type};
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use crate::units::Dimension;
use std::sync::Arc;

/// The context for which a type is expected, as messages name it.
#[derive(Clone, Copy)]
pub(super) enum Role {
    /// A parameter or a `let`, by its name.
    Param(Symbol),
    /// A phrase, such as "each coordinate".
    Place(&'static str),
}

impl std::fmt::Display for Role {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Role::Param(name) => write!(f, "`{name}`"),
            Role::Place(words) => f.write_str(words),
        }
    }
}

/// Returns the node of the typed tree for an expression of kind `kind` and type `ty`, written at `span`.
pub(super) fn expr_of(span: Span, ty: Type, kind: ExprKind) -> Expr {
    Expr { span, ty, kind }
}

/// Returns the expression `got`, whose type fits `want`, with its quantities in the dimensions of `want`: without the
/// radians that are dropped there, energies and torques as they are named there.
pub(super) fn in_dimensions(got: Expr, want: &Type) -> Expr {
    match got.ty.in_dimensions_of(want) {
        Some(ty) => expr_of(got.span, ty, ExprKind::SetDimension(Box::new(got))),
        None => got,
    }
}

/// Returns the error node, which stands at `span` for an expression with a reported mistake. Its type fits any other,
/// so that no further mistake follows from it.
pub(super) fn error_expr(span: Span) -> Expr {
    expr_of(span, Type::Error, ExprKind::Error)
}

impl<'a> Checker<'a> {
    /// Returns the typed expression `e`, in `scope`, converted to the type `want` as by [`coerce`](Self::coerce); an
    /// error node, after a report, if it has a mistake or does not fit. `role`: the context, as messages name it.
    pub(super) fn expect(&mut self, scope: &mut Scope, e: &'a ast::Expr, want: &Type, role: Role) -> Expr {
        let got = self.expr(scope, e, Some(want));
        self.coerce(got, want, role)
    }

    /// Returns the typed expression `got` converted to the type `want`: without the radians of a quantity where `want`
    /// has none, and with energies and torques named as in `want`; an error node, after a report, if it does not fit.
    /// `role`: the context, as messages name it.
    pub(super) fn coerce(&mut self, got: Expr, want: &Type, role: Role) -> Expr {
        if !self.fits(&got.ty, want) {
            self.mismatch(&got, want, role);
            return error_expr(got.span);
        }
        in_dimensions(got, want)
    }

    /// Returns the source text of a span, to be quoted in a message; `None` if it has more than 40 bytes or several
    /// lines.
    pub(super) fn quoted(&self, span: Span) -> Option<&'a str> {
        let text = self.sources.text(span);
        (text.len() <= 40 && !text.contains('\n')).then_some(text)
    }

    /// Reports an expression of an unexpected type.
    fn mismatch(&mut self, got: &Expr, want: &Type, role: Role) {
        let written = self.quoted(got.span).map_or("this".to_string(), |t| format!("`{t}`"));
        let whole = alternatives(want).contains(&&Type::Int);
        let diagnostic = match (got.ty.dimension(), inner_quantity(want)) {
            (Some(have), Some(need)) if !(whole && have == need) => {
                let message = format!(
                    "{role} wants {}; {written} is {}",
                    dimension_with_unit(need),
                    dimension_words(have)
                );
                let mut d = Diagnostic::error(code::DIMENSION_MISMATCH, message)
                    .label(got.span, format!("this is {}", dimension_words(have)));
                if let Some(hint) = dimension_hint(self.quoted(got.span), have, need) {
                    d = d.hint(hint);
                }
                d
            }
            _ => {
                let (need, have) = (self.words(want), self.words(&got.ty));
                let mut d = Diagnostic::error(
                    code::TYPE_MISMATCH,
                    format!("{role} wants {need}; {written} is {have}"),
                )
                .label(got.span, format!("this is {have}"));
                if let Some(hint) = self.type_hint(got, want) {
                    d = d.hint(hint);
                }
                d
            }
        };
        self.report(diagnostic);
    }

    /// Returns the typed expression `e`, in `scope`; an error node, after a report, if it has a mistake that leaves
    /// nothing of it to understand; mistakes inside give error nodes there. `want`: the expected type, which decides
    /// the meaning of words of choices, `_` and `[...]`, but is not enforced; `None` if any will do.
    pub(super) fn expr(&mut self, scope: &mut Scope, e: &'a ast::Expr, want: Option<&Type>) -> Expr {
        use ast::ExprKind as K;
        let span = e.span;
        match &e.kind {
            K::Error => error_expr(span),
            K::Number { digits, unit } => self.number(scope, span, *digits, unit.as_ref()),
            K::Bool(b) => expr_of(span, Type::Bool, ExprKind::Bool(*b)),
            K::Text(parts) => self.text(scope, span, parts),
            K::Name(name) => self.name_expr(scope, span, *name, want),
            K::Axis(axis) => direction(span, *axis),
            K::Hole => self.hole(scope, span, want),
            K::List(items) => self.list(scope, span, items, want),
            K::Comprehension { body, clauses } => self.comprehension(scope, span, body, clauses, want),
            K::Unary { op, operand, .. } => self.unary(scope, span, *op, operand, want),
            K::Binary { op, op_span, left, right } => {
                self.binary(scope, span, *op, *op_span, (left, right), want)
            }
            K::Range { from, to } => self.range(scope, span, from, to),
            K::Otherwise { value, otherwise } => self.otherwise(scope, span, value, otherwise, want),
            K::Call { callee, args } => self.call(scope, span, callee, args, want),
            K::Index { object, index } => self.index(scope, span, object, index, want),
            K::Field { object, field } => self.field(scope, span, object, *field, want),
            K::With { object, fields } => self.with(scope, span, object, fields),
            K::If { condition, then, otherwise } => {
                self.if_expr(scope, span, condition, then, otherwise.as_deref(), want)
            }
            K::Block { statements, value } => self.block(scope, span, statements, value.as_deref(), want),
            K::Lambda { params, body } => self.lambda(scope, span, params, body, want),
        }
    }

    /// Checks `x else y`, for an optional value or an action with a timeout.
    fn otherwise(
        &mut self,
        scope: &mut Scope,
        span: Span,
        value: &'a ast::Expr,
        otherwise: &'a ast::Expr,
        want: Option<&Type>,
    ) -> Expr {
        let optional = want.map(|w| Type::optional(w.clone()));
        let value = self.expr(scope, value, optional.as_ref());
        match &value.ty {
            Type::Behavior => {
                let otherwise =
                    self.expect(scope, otherwise, &Type::Behavior, Role::Place("what follows a timeout"));
                let kind = ExprKind::TimeoutElse { action: Box::new(value), otherwise: Box::new(otherwise) };
                expr_of(span, Type::Behavior, kind)
            }
            Type::Optional(inner) => {
                let inner = (**inner).clone();
                let otherwise = self.expect(scope, otherwise, &inner, Role::Place("what stands in"));
                let ty = if inner.is_error() { otherwise.ty.clone() } else { inner };
                expr_of(span, ty, ExprKind::OrElse { value: Box::new(value), otherwise: Box::new(otherwise) })
            }
            Type::Error => {
                self.expr(scope, otherwise, want);
                error_expr(span)
            }
            other => {
                let words = self.words(other);
                self
                    .report(Diagnostic::error(code::TYPE_MISMATCH, format!("{words} is never missing")).label(
                    value.span,
                    "`else` stands behind a value that may be missing, or behind an action with a timeout",
                ));
                error_expr(span)
            }
        }
    }

    /// Checks an `if` expression; reports one without `else`, and branches of different types.
    fn if_expr(
        &mut self,
        scope: &mut Scope,
        span: Span,
        condition: &'a ast::Expr,
        then: &'a ast::Expr,
        otherwise: Option<&'a ast::Expr>,
        want: Option<&Type>,
    ) -> Expr {
        let condition = self.expect(scope, condition, &Type::Bool, Role::Place("the condition"));
        let then = self.expr(scope, then, want);
        let Some(otherwise) = otherwise else {
            self.report(
                Diagnostic::error(
                    code::TYPE_MISMATCH,
                    "this `if` has no value when its condition does not hold",
                )
                .label(span, "`else` is missing")
                .hint("`if c { a } else { b }`"),
            );
            return error_expr(span);
        };
        let otherwise = self.expr(scope, otherwise, want);
        let Some(ty) = self.join(&then.ty, &otherwise.ty) else {
            let (a, b) = (self.words(&then.ty), self.words(&otherwise.ty));
            self.report(
                Diagnostic::error(code::TYPE_MISMATCH, "both branches of an `if` are of one type")
                    .label(otherwise.span, format!("this is {b}"))
                    .label(then.span, format!("this is {a}")),
            );
            return error_expr(span);
        };
        let kind = ExprKind::If {
            condition: Box::new(condition),
            then: Box::new(in_dimensions(then, &ty)),
            otherwise: Some(Box::new(in_dimensions(otherwise, &ty))),
        };
        expr_of(span, ty, kind)
    }

    /// Checks a block expression; reports values of lines that are lost.
    fn block(
        &mut self,
        scope: &mut Scope,
        span: Span,
        statements: &'a [ast::Stmt],
        value: Option<&'a ast::Expr>,
        want: Option<&Type>,
    ) -> Expr {
        // A block with no statement is its value.
        if let (Some(value), []) = (value, statements) {
            scope.contracts = false;
            return self.expr(scope, value, want);
        }
        let mark = scope.open();
        let statements = self.statements(scope, statements);
        scope.contracts = false;
        for s in &statements {
            if let StmtKind::Expr(e) = &s.kind
                && !matches!(e.ty, Type::Nothing | Type::Error)
            {
                let words = self.words(&e.ty);
                self.report(
                    Diagnostic::error(
                        code::TYPE_MISMATCH,
                        format!("the value of this line, {words}, is lost"),
                    )
                    .label(e.span, "only the last line of a block is its value")
                    .hint("a list joins several values: `[a, b]`; `let` names one"),
                );
            }
        }
        let value = value.map(|v| self.expr(scope, v, want));
        scope.close(mark);
        let ty = value.as_ref().map_or(Type::Nothing, |v| v.ty.clone());
        expr_of(span, ty, ExprKind::Block { statements, value: value.map(Box::new) })
    }

    /// Checks a lambda against the expected function type, from which the types of its parameters come.
    fn lambda(
        &mut self,
        scope: &mut Scope,
        span: Span,
        params: &'a [ast::Name],
        body: &'a ast::Expr,
        want: Option<&Type>,
    ) -> Expr {
        let Some(Type::Fn(wanted)) = want.map(fn_of) else {
            self.report(
                Diagnostic::error(code::CANNOT_INFER, "the types of these parameters can't be told")
                    .label(span, "a function stands where one is expected, as an argument")
                    .hint("declare it: `fn name(x: Length) -> Length = ...`"),
            );
            return error_expr(span);
        };
        let wanted = wanted.clone();
        if wanted.params.len() != params.len() {
            let (need, have) = (wanted.params.len(), params.len());
            self.report(
                Diagnostic::error(
                    code::ARGUMENTS,
                    format!("a function of {need} is wanted; this one takes {have}"),
                )
                .label(span, format!("{need} parameters are wanted")),
            );
            return error_expr(span);
        }
        scope.enter_lambda();
        for (param, ty) in params.iter().zip(&wanted.params) {
            let ty = if has_params(ty) { Type::Error } else { ty.clone() };
            scope.bind(param.text, ty);
        }
        let body = if has_params(&wanted.result) {
            self.expr(scope, body, None)
        } else {
            self.expect(scope, body, &wanted.result, Role::Place("the function's result"))
        };
        let (frame, captures) = scope.leave_lambda();
        let ty = FnType { params: wanted.params.clone(), result: body.ty.clone() };
        let kind = ExprKind::Lambda { captures, params: params.len(), body: Arc::new(body), frame };
        expr_of(span, Type::Fn(Arc::new(ty)), kind)
    }

    /// Returns the family of an instance type; `None` for other types.
    pub(super) fn instance_family(&self, ty: &Type) -> Option<Family> {
        match ty {
            Type::Instance(id) => self.family(*id),
            _ => None,
        }
    }
}

/// Returns the alternatives of a type: itself, the inner type of an optional one, the types of a choice.
pub(super) fn alternatives(ty: &Type) -> Vec<&Type> {
    match ty {
        Type::Optional(inner) => alternatives(inner),
        Type::Choice(choice) => choice.types.iter().flat_map(alternatives).collect(),
        other => vec![other],
    }
}

/// Returns the dimension of an expected type that is one quantity; `None` for other types and for several
/// alternatives.
fn inner_quantity(want: &Type) -> Option<Dimension> {
    match alternatives(want).as_slice() {
        [one] => one.dimension(),
        _ => None,
    }
}

/// Returns the function type among the alternatives of an expected type; the type itself if there is none.
fn fn_of(want: &Type) -> &Type {
    alternatives(want).into_iter().find(|t| matches!(t, Type::Fn(_))).unwrap_or(want)
}

/// Returns true if a type mentions unbound type parameters.
pub(super) fn has_params(ty: &Type) -> bool {
    match ty {
        Type::Param(_) | Type::QuantityParam { .. } => true,
        Type::List(t)
        | Type::Vec3(t)
        | Type::Range(t)
        | Type::Optional(t)
        | Type::Signal(t)
        | Type::Study(t)
        | Type::Joint(t) => has_params(t),
        Type::Fn(f) => f.params.iter().any(has_params) || has_params(&f.result),
        Type::Choice(c) => c.types.iter().any(has_params),
        _ => false,
    }
}
