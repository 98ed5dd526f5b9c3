//! Operators: the types of their operands, and the type of their result.

use super::checker::Checker;
use super::expr::{Role, error_expr, expr_of, in_dimensions};
use super::hints::angle_hint;
use super::scope::Scope;
use super::typed::{BinaryOp, Expr, ExprKind, UnaryOp};
use super::types::Type;
use crate::source::{Diagnostic, Span, code};
use crate::syntax::ast;
use crate::units::Dimension;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed expression of a unary operator with its operand; an error node, after a report, if the
    /// operator does not take it. `want`: the type expected of the result, `None` if any will do.
    pub(super) fn unary(
        &mut self,
        scope: &mut Scope,
        span: Span,
        op: UnaryOp,
        operand: &'a ast::Expr,
        want: Option<&Type>,
    ) -> Expr {
        if op == UnaryOp::Not {
            let operand = self.expr(scope, operand, None);
            return match &operand.ty {
                Type::Bool | Type::Condition => {
                    expr_of(span, operand.ty.clone(), ExprKind::Unary { op, operand: Box::new(operand) })
                }
                _ => {
                    self.coerce(operand, &Type::Bool, Role::Place("`not`"));
                    error_expr(span)
                }
            };
        }
        let operand = self.expr(scope, operand, want);
        match &operand.ty {
            Type::Error => error_expr(span),
            Type::Quantity(_) | Type::Int | Type::Vec3(_) => {
                expr_of(span, operand.ty.clone(), ExprKind::Unary { op, operand: Box::new(operand) })
            }
            other => {
                let words = self.words(other);
                self.report(
                    Diagnostic::error(code::OPERANDS, format!("{words} has no sign"))
                        .label(operand.span, "a quantity is wanted behind a sign"),
                );
                error_expr(span)
            }
        }
    }

    /// Returns the typed expression of a binary operator, written at `op_span`, with its operands (left, right); an
    /// error node, after a report, if the operator does not take them. `want`: the type expected of the result, `None`
    /// if any will do.
    pub(super) fn binary(
        &mut self,
        scope: &mut Scope,
        span: Span,
        op: BinaryOp,
        op_span: Span,
        (left, right): (&'a ast::Expr, &'a ast::Expr),
        want: Option<&Type>,
    ) -> Expr {
        let side = self.wanted_of_operands(op, want);
        let left = self.expr(scope, left, side.as_ref());
        let right_want = match (op, &left.ty) {
            // In `p == auto` and `[] == xs` the left side determines the expected type of the right one.
            (BinaryOp::Eq | BinaryOp::Ne, ty) if !ty.is_error() => Some(left.ty.clone()),
            _ => side,
        };
        let right = self.expr(scope, right, right_want.as_ref());
        if left.ty.is_error() || right.ty.is_error() {
            return error_expr(span);
        }
        if op == BinaryOp::Pow {
            return self.power(span, left, right);
        }
        match self.binary_type(op, &left.ty, &right.ty) {
            Some(ty) => {
                // The elements of both lists are those of one.
                let side = |e: Expr| Box::new(if op == BinaryOp::Join { in_dimensions(e, &ty) } else { e });
                let (left, right) = (side(left), side(right));
                expr_of(span, ty, ExprKind::Binary { op, left, right })
            }
            None => {
                self.bad_operands(op, op_span, &left, &right);
                error_expr(span)
            }
        }
    }

    /// Returns the expected type of the operands: ports for `a <-> b`, for `a ++ b` and `a + b` the list or
    /// vector that the whole is expected to be; `None` where the operator does not determine it.
    fn wanted_of_operands(&self, op: BinaryOp, want: Option<&Type>) -> Option<Type> {
        match op {
            BinaryOp::Mated => Some(Type::Port),
            BinaryOp::Join | BinaryOp::Add | BinaryOp::Sub => {
                want.filter(|w| matches!(w, Type::List(_) | Type::Vec3(_))).cloned()
            }
            _ => None,
        }
    }

    /// Returns the result type of an operator; `None` if it does not apply.
    fn binary_type(&mut self, op: BinaryOp, a: &Type, b: &Type) -> Option<Type> {
        use BinaryOp as O;
        match op {
            O::Or | O::And => match (a, b) {
                (Type::Bool, Type::Bool) => Some(Type::Bool),
                (Type::Condition, Type::Condition) => Some(Type::Condition),
                _ => None,
            },
            O::Eq | O::Ne => {
                let joined = self.join(a, b)?;
                self.incomparable(&joined).is_none().then_some(Type::Bool)
            }
            O::Lt | O::Le | O::Gt | O::Ge => self.order_type(a, b),
            O::Mated => (*a == Type::Port && *b == Type::Port).then_some(Type::Condition),
            O::Join => self.join_type(a, b),
            O::Add | O::Sub => self.sum_type(a, b),
            O::Mul => product_type(a, b),
            O::Div => quotient_type(a, b),
            O::Rem => match (a, b) {
                (Type::Int, Type::Int) => Some(Type::Int),
                _ => a.dimension()?.common(b.dimension()?).map(Type::Quantity),
            },
            O::Pow => None,
        }
    }

    /// Returns the result type of a comparison: a Bool, or a condition for signals; `None` if it does not
    /// apply.
    fn order_type(&self, a: &Type, b: &Type) -> Option<Type> {
        match (a, b) {
            (Type::Signal(s), other) | (other, Type::Signal(s)) => {
                s.dimension()?.common(other.dimension()?).map(|_| Type::Condition)
            }
            (Type::Text, Type::Text) => Some(Type::Bool),
            _ => a.dimension()?.common(b.dimension()?).map(|_| Type::Bool),
        }
    }

    /// Returns the result type of `a ++ b`; `None` if it does not apply.
    fn join_type(&self, a: &Type, b: &Type) -> Option<Type> {
        match (a, b) {
            (Type::Text, Type::Text) => Some(Type::Text),
            (Type::List(_), Type::List(_)) => self.join(a, b),
            (Type::Record(_), Type::Record(_) | Type::Behavior) => {
                let plan = Type::Record(self.prelude_def("Plan")?);
                let both = self.fits(a, &plan) && (*b == Type::Behavior || self.fits(b, &plan));
                both.then_some(plan)
            }
            _ => None,
        }
    }

    /// Returns the result type of a sum or difference; `None` if it does not apply.
    fn sum_type(&self, a: &Type, b: &Type) -> Option<Type> {
        match (a, b) {
            (Type::Int, Type::Int) => Some(Type::Int),
            (Type::Vec3(x), Type::Vec3(y)) => {
                let d = x.dimension()?.common(y.dimension()?)?;
                Some(Type::vec3(d))
            }
            _ => a.dimension()?.common(b.dimension()?).map(Type::Quantity),
        }
    }

    /// Returns the type of `x^n`. The dimension of the result must be known, so `n` must be a literal
    /// unless `x` is a plain number.
    fn power(&mut self, span: Span, left: Expr, right: Expr) -> Expr {
        let ty = match (&left.ty, &right.ty) {
            (Type::Int, Type::Int) => Some(if is_negative(&right) { Type::NUMBER } else { Type::Int }),
            (number, Type::Int) if *number == Type::NUMBER => Some(Type::NUMBER),
            (Type::Quantity(d), Type::Int) => {
                literal(&right).and_then(|n| d.power(n.into())).map(Type::Quantity)
            }
            _ => None,
        };
        let Some(ty) = ty else {
            let quantity = left.ty.dimension().is_some();
            let mut d = Diagnostic::error(code::OPERANDS, "`^` takes a quantity and a whole number")
                .label(
                    right.span,
                    if quantity { "a whole number, written out, is wanted here" } else { "the exponent" },
                )
                .label(left.span, format!("this is {}", self.words(&left.ty)));
            if quantity {
                d = d.hint("`sqrt(x)` takes a root");
            }
            self.report(d);
            return error_expr(span);
        };
        expr_of(
            span,
            ty,
            ExprKind::Binary { op: BinaryOp::Pow, left: Box::new(left), right: Box::new(right) },
        )
    }

    /// Returns the hint that gives a plain literal the unit of the other operand; `None` if that is no likely
    /// correction.
    fn with_unit(&self, number: &Expr, beside: &Expr) -> Option<String> {
        let (plain, needed) = (number.ty.dimension()?, beside.ty.dimension()?);
        let written = self.quoted(number.span)?;
        let literal = written.starts_with(|c: char| c.is_ascii_digit());
        if !literal || plain != Dimension::NUMBER || needed == Dimension::NUMBER {
            return None;
        }
        // In the unit of the other operand, if that is a literal with a unit.
        let other = self.quoted(beside.span).unwrap_or_default();
        let digits = other.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '_'));
        let same = digits.len() < other.len() && crate::units::is_unit(digits);
        // A fraction beside degrees is most likely in radians.
        if needed == Dimension::ANGLE && !(same && written.bytes().all(|b| b.is_ascii_digit())) {
            return Some(angle_hint(written));
        }
        let unit = if same { digits.to_owned() } else { crate::units::usual_unit(needed) };
        (!unit.is_empty()).then(|| format!("a unit sticks to its number: `{written}{unit}`?"))
    }

    /// Reports operands to which an operator does not apply.
    fn bad_operands(&mut self, op: BinaryOp, op_span: Span, left: &Expr, right: &Expr) {
        let (a, b) = (self.words(&left.ty), self.words(&right.ty));
        let sign = op_text(op);
        let dimensions = left.ty.dimension().is_some() && right.ty.dimension().is_some();
        let (code, message) = if dimensions {
            (code::DIMENSION_MISMATCH, format!("{a} and {b} do not go together in `{sign}`"))
        } else {
            (code::OPERANDS, format!("`{sign}` does not take {a} and {b}"))
        };
        let mut d = Diagnostic::error(code, message)
            .label(op_span, format!("`{sign}` stands between them"))
            .label(left.span, format!("this is {a}"))
            .label(right.span, format!("this is {b}"));
        if let (BinaryOp::Eq | BinaryOp::Ne, Some(field)) = (op, self.incomparable_field(&left.ty, &right.ty))
        {
            d = d.hint(field);
        } else if op == BinaryOp::Add && (left.ty == Type::Text || right.ty == Type::Text) {
            d = d.hint("texts are joined by `++`, and values put into them by `\"... {value}\"`");
        } else if op == BinaryOp::Add && matches!(left.ty, Type::List(_)) {
            d = d.hint("lists are joined by `++`");
        } else if op == BinaryOp::Mul && matches!((&left.ty, &right.ty), (Type::List(_), Type::Int)) {
            d = d.hint("a list of equal elements is made by `[0 for i in 0..3]`");
        } else if let Some(with_unit) = self.with_unit(left, right).or_else(|| self.with_unit(right, left)) {
            d = d.hint(with_unit);
        } else if matches!(
            (&left.ty, &right.ty),
            (Type::Bool, Type::Condition) | (Type::Condition, Type::Bool)
        ) {
            d = d.hint("a condition is watched while the robot moves; true and false are known before");
        }
        self.report(d);
    }
}

/// Returns the type of a product; `None` if it does not apply.
fn product_type(a: &Type, b: &Type) -> Option<Type> {
    match (a, b) {
        (Type::Int, Type::Int) => Some(Type::Int),
        (Type::Pose, Type::Pose) => Some(Type::Pose),
        (Type::Pose, Type::Vec3(_)) => Some(b.clone()),
        (Type::Vec3(v), s) | (s, Type::Vec3(v)) => v.dimension()?.times(s.dimension()?).map(Type::vec3),
        _ => a.dimension()?.times(b.dimension()?).map(Type::Quantity),
    }
}

/// Returns the type of a quotient; `None` if it does not apply.
fn quotient_type(a: &Type, b: &Type) -> Option<Type> {
    match (a, b) {
        (Type::Vec3(v), s) => {
            let d = v.dimension()?.over(s.dimension()?)?;
            Some(Type::Vec3(Arc::new(Type::Quantity(d))))
        }
        _ => a.dimension()?.over(b.dimension()?).map(Type::Quantity),
    }
}

/// Returns the value of an integer literal, negated ones included; `None` for other expressions.
fn literal(e: &Expr) -> Option<i32> {
    match &e.kind {
        ExprKind::Int(n) => i32::try_from(*n).ok(),
        ExprKind::Unary { op: UnaryOp::Neg, operand } => literal(operand)?.checked_neg(),
        ExprKind::Unary { op: UnaryOp::Plus, operand } => literal(operand),
        _ => None,
    }
}

/// Returns true if an expression is a negative literal.
fn is_negative(e: &Expr) -> bool {
    literal(e).is_some_and(|n| n < 0)
}

/// Returns an operator as it is written.
fn op_text(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Or => "or",
        BinaryOp::And => "and",
        BinaryOp::Eq => "==",
        BinaryOp::Ne => "!=",
        BinaryOp::Lt => "<",
        BinaryOp::Le => "<=",
        BinaryOp::Gt => ">",
        BinaryOp::Ge => ">=",
        BinaryOp::Mated => "<->",
        BinaryOp::Join => "++",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Rem => "%",
        BinaryOp::Pow => "^",
    }
}
