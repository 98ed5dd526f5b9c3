//! Operators on values.

use super::frame::Frame;
use super::interpreter::Interpreter;
use super::stop::{Eval, fault};
use super::value::{ConditionValue, Measure, SignalValue, Value};
use crate::check::typed::{BinaryOp, Expr, UnaryOp};
use crate::plan::{Compare, Condition};
use crate::source::{Diagnostic, Span, code};
use crate::units::Dimension;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns the value of a whole number from its decimal digits, however many. `span`: the span of the literal.
    ///
    /// # Errors
    /// A fault where it has more digits than the limit of the run.
    pub fn big_literal(&mut self, digits: &str, span: Span) -> Eval<Value> {
        let limit = self.limits().digits;
        if digits.len() > limit {
            let message = format!("a whole number of more than {limit} digits is not allowed");
            return Err(fault(code::SIZE_LIMIT, span, message, "this number is too large"));
        }
        Ok(digits.parse::<BigInt>().map_or(Value::Unknown, Value::whole))
    }

    /// Returns the result of a prefix operator; `Value::Unknown` where the operand is. `op`: the operator; `span`: the
    /// span of the whole expression.
    ///
    /// # Errors
    /// A fault where the operator does not fit the value.
    pub fn unary(&mut self, op: UnaryOp, value: &Value, span: Span) -> Eval<Value> {
        Ok(match (op, value) {
            (_, Value::Unknown) => Value::Unknown,
            (UnaryOp::Plus, value) => value.clone(),
            (UnaryOp::Not, Value::Bool(b)) => Value::Bool(!b),
            (UnaryOp::Not, Value::Condition(c)) => Value::Condition(Rc::new(ConditionValue {
                robot: c.robot.clone(),
                condition: Condition::Not(Box::new(c.condition.clone())),
            })),
            (UnaryOp::Neg, Value::Int(n)) => {
                n.checked_neg().map_or_else(|| Value::whole(-BigInt::from(*n)), Value::Int)
            }
            (UnaryOp::Neg, Value::Big(n)) => Value::whole(-n.as_ref()),
            (UnaryOp::Neg, Value::Quantity(x, d)) => Value::Quantity(-x, *d),
            (UnaryOp::Neg, Value::Vec3(v, d)) => Value::Vec3(-v, *d),
            (UnaryOp::Neg, Value::Range(ends)) => {
                let to = self.unary(op, &ends.0, span)?;
                let from = self.unary(op, &ends.1, span)?;
                Value::Range(Rc::new((from, to)))
            }
            _ => return Err(operands_do_not_fit(span)),
        })
    }

    /// Returns the result of an infix operator; `Value::Unknown` where an operand is. `and` and `or` leave out the
    /// second operand where the first decides. `op`: the operator; `left` and `right`: the operands; `span`: the span
    /// of the whole expression; `frame`: the variables of the body in which it stands.
    ///
    /// # Errors
    /// A fault where the operator does not fit the values, divides by zero, or gives a value that is too large.
    pub fn eval_binary(
        &mut self,
        op: BinaryOp,
        left: &Expr,
        right: &Expr,
        span: Span,
        frame: &mut Frame,
    ) -> Eval<Value> {
        let a = self.eval(left, frame)?;
        // `and` and `or` look at the right side only where it matters.
        match (op, &a) {
            (BinaryOp::And, Value::Bool(false)) | (BinaryOp::Or, Value::Bool(true)) => return Ok(a),
            _ => {}
        }
        let b = self.eval(right, frame)?;
        self.binary(op, &a, &b, span, right.span)
    }

    fn binary(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span, right: Span) -> Eval<Value> {
        if a.is_unknown() || b.is_unknown() {
            return Ok(Value::Unknown);
        }
        match op {
            BinaryOp::And | BinaryOp::Or => self.logic(op, a, b, span),
            BinaryOp::Eq => Ok(a.same(b).map_or(Value::Unknown, Value::Bool)),
            BinaryOp::Ne => Ok(a.same(b).map_or(Value::Unknown, |same| Value::Bool(!same))),
            BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge => self.compare(op, a, b, span),
            BinaryOp::Mated => self.mated_condition(a, b, span),
            BinaryOp::Join => self.join(a, b, span),
            BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem | BinaryOp::Pow => {
                self.arithmetic(op, a, b, span, right)
            }
        }
    }

    fn logic(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Eval<Value> {
        match (a, b) {
            // The left side did not decide, so the right one does.
            (Value::Bool(_), Value::Bool(b)) => Ok(Value::Bool(*b)),
            (Value::Condition(a), Value::Condition(b)) => {
                let robot = self.common_subject(a.robot.as_ref(), b.robot.as_ref(), span)?;
                let (x, y) = (Box::new(a.condition.clone()), Box::new(b.condition.clone()));
                let condition = if op == BinaryOp::And { Condition::And(x, y) } else { Condition::Or(x, y) };
                Ok(Value::Condition(Rc::new(ConditionValue { robot, condition })))
            }
            _ => Err(operands_do_not_fit(span)),
        }
    }

    fn compare(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Eval<Value> {
        match (a, b) {
            (Value::Signal(signal), limit) => {
                let value = limit.as_number().ok_or_else(|| operands_do_not_fit(span))?;
                compare_signal(signal, comparison(op), value, span)
            }
            (limit, Value::Signal(signal)) => {
                let value = limit.as_number().ok_or_else(|| operands_do_not_fit(span))?;
                compare_signal(signal, flipped(comparison(op)), value, span)
            }
            _ => {
                let order = order_of(a, b).ok_or_else(|| operands_do_not_fit(span))?;
                Ok(Value::Bool(match op {
                    BinaryOp::Lt => order.is_lt(),
                    BinaryOp::Le => order.is_le(),
                    BinaryOp::Gt => order.is_gt(),
                    _ => order.is_ge(),
                }))
            }
        }
    }

    fn join(&mut self, a: &Value, b: &Value, span: Span) -> Eval<Value> {
        match (a, b) {
            (Value::List(x), Value::List(y)) => {
                self.check_list(x.len() + y.len(), span)?;
                Ok(Value::List(Rc::new(x.iter().chain(y.iter()).cloned().collect())))
            }
            (Value::Text(x), Value::Text(y)) => {
                self.check_text(x.len() + y.len(), span)?;
                Ok(Value::text(format!("{x}{y}")))
            }
            _ => self.join_plans(a, b, span),
        }
    }

    fn arithmetic(&mut self, op: BinaryOp, a: &Value, b: &Value, span: Span, right: Span) -> Eval<Value> {
        match (op, a, b) {
            (BinaryOp::Add, Value::Text(_), Value::Text(_)) => self.join(a, b, span),
            (_, Value::Int(x), Value::Int(y)) => match small(op, *x, *y) {
                Some(n) => Ok(Value::Int(n)),
                None => self.whole_arithmetic(op, a, b, span, right),
            },
            (_, Value::Int(_) | Value::Big(_), Value::Int(_) | Value::Big(_)) => {
                self.whole_arithmetic(op, a, b, span, right)
            }
            (_, Value::Vec3(..), _) | (_, _, Value::Vec3(..)) => vectors(op, a, b, span, right),
            (BinaryOp::Mul, Value::Pose(x), Value::Pose(y)) => Ok(Value::Pose(Rc::new(**x * **y))),
            (BinaryOp::Pow, Value::Quantity(x, d), Value::Int(n)) => power(*x, *d, *n, span, right),
            _ => real(op, a, b, span, right),
        }
    }

    /// Returns the result of exact arithmetic; `/` of whole numbers gives a number.
    fn whole_arithmetic(
        &mut self,
        op: BinaryOp,
        a: &Value,
        b: &Value,
        span: Span,
        right: Span,
    ) -> Eval<Value> {
        let (Some(x), Some(y)) = (a.as_big(), b.as_big()) else { return Err(operands_do_not_fit(span)) };
        let limit = self.limits().digits as f64 * std::f64::consts::LOG2_10;
        let bits = |n: &BigInt| n.bits() as f64;
        let expected = match op {
            BinaryOp::Mul => bits(&x) + bits(&y),
            BinaryOp::Pow => bits(&x) * num_traits::ToPrimitive::to_f64(&y).unwrap_or(f64::MAX),
            _ => bits(&x).max(bits(&y)),
        };
        if expected > limit.max(128.0) && !(op == BinaryOp::Pow && x.abs() <= BigInt::from(1)) {
            let digits = self.limits().digits;
            let message = format!("a whole number of more than {digits} digits is not allowed");
            return Err(fault(code::SIZE_LIMIT, span, message, "this number is too large"));
        }
        Ok(match op {
            BinaryOp::Add => Value::whole(x + y),
            BinaryOp::Sub => Value::whole(x - y),
            BinaryOp::Mul => Value::whole(x * y),
            BinaryOp::Rem if y.is_zero() => return Err(by_zero(right)),
            BinaryOp::Rem => Value::whole(x.mod_floor(&y.abs())),
            BinaryOp::Pow if y.is_negative() => {
                return power(x_as_f64(&x), Dimension::NUMBER, small_power(&y), span, right);
            }
            BinaryOp::Pow => Value::whole(num_traits::pow::Pow::pow(x, exponent(&y))),
            _ => return real(op, a, b, span, right),
        })
    }
}

/// Returns an exponent that passed the limit on digits; where the base is -1, 0 or 1 its parity suffices.
fn exponent(y: &BigInt) -> u32 {
    u32::try_from(y).unwrap_or(if y.is_even() { 2 } else { 1 })
}

fn small_power(y: &BigInt) -> i64 {
    i64::try_from(y).unwrap_or(i64::MIN)
}

fn x_as_f64(x: &BigInt) -> f64 {
    num_traits::ToPrimitive::to_f64(x).unwrap_or(f64::INFINITY)
}

/// Returns the result of whole-number arithmetic in machine words; `None` where it overflows.
fn small(op: BinaryOp, x: i64, y: i64) -> Option<i64> {
    match op {
        BinaryOp::Add => x.checked_add(y),
        BinaryOp::Sub => x.checked_sub(y),
        BinaryOp::Mul => x.checked_mul(y),
        BinaryOp::Rem if y != 0 => x.checked_rem_euclid(y),
        BinaryOp::Pow => x.checked_pow(u32::try_from(y).ok()?),
        _ => None,
    }
}

/// Returns the result of arithmetic with quantities; that of `%` is never negative.
fn real(op: BinaryOp, a: &Value, b: &Value, span: Span, right: Span) -> Eval<Value> {
    let (Some(x), Some(y)) = (a.as_number(), b.as_number()) else { return Err(operands_do_not_fit(span)) };
    let (Some(dx), Some(dy)) = (a.as_dimension(), b.as_dimension()) else {
        return Err(operands_do_not_fit(span));
    };
    // The sum of an empty list is a zero of no dimension.
    let same = || dx.common(dy).unwrap_or(if dx == Dimension::NUMBER { dy } else { dx });
    let (value, dimension) = match op {
        BinaryOp::Add => (x + y, Some(same())),
        BinaryOp::Sub => (x - y, Some(same())),
        BinaryOp::Mul => (x * y, dx.times(dy)),
        BinaryOp::Div | BinaryOp::Rem if y == 0.0 => return Err(by_zero(right)),
        BinaryOp::Div => (x / y, dx.over(dy)),
        BinaryOp::Rem => (x - y.abs() * libm::floor(x / y.abs()), Some(same())),
        BinaryOp::Pow if y == libm::trunc(y) && y.abs() < 128.0 => {
            return power(x, dx, y as i64, span, right);
        }
        _ => return Err(operands_do_not_fit(span)),
    };
    finite(value, dimension, span)
}

/// Returns the result of an operator with a vector: a sum, a difference, or a product or quotient with a
/// number.
fn vectors(op: BinaryOp, a: &Value, b: &Value, span: Span, right: Span) -> Eval<Value> {
    match (op, a, b) {
        (BinaryOp::Add, Value::Vec3(x, d), Value::Vec3(y, e)) => {
            Ok(Value::Vec3(x + y, d.common(*e).unwrap_or(*d)))
        }
        (BinaryOp::Sub, Value::Vec3(x, d), Value::Vec3(y, e)) => {
            Ok(Value::Vec3(x - y, d.common(*e).unwrap_or(*d)))
        }
        (BinaryOp::Mul, Value::Vec3(x, d), k) | (BinaryOp::Mul, k, Value::Vec3(x, d)) => {
            let (Some(factor), Some(e)) = (k.as_number(), k.as_dimension()) else {
                return Err(operands_do_not_fit(span));
            };
            Ok(Value::Vec3(x * factor, d.times(e).unwrap_or(*d)))
        }
        (BinaryOp::Div, Value::Vec3(x, d), k) => {
            let (Some(divisor), Some(e)) = (k.as_number(), k.as_dimension()) else {
                return Err(operands_do_not_fit(span));
            };
            if divisor == 0.0 {
                return Err(by_zero(right));
            }
            Ok(Value::Vec3(x / divisor, d.over(e).unwrap_or(*d)))
        }
        _ => Err(operands_do_not_fit(span)),
    }
}

/// Returns a whole power by repeated squaring, so that it is the same on every platform.
fn power(x: f64, dimension: Dimension, n: i64, span: Span, right: Span) -> Eval<Value> {
    if n < 0 && x == 0.0 {
        return Err(by_zero(right));
    }
    let mut result = 1.0;
    let mut base = if n < 0 { 1.0 / x } else { x };
    let mut left = n.unsigned_abs();
    while left > 0 {
        if left % 2 == 1 {
            result *= base;
        }
        base *= base;
        left /= 2;
    }
    finite(result, dimension.power(n), span)
}

/// Returns a result that is a finite number; an overflow is a fault, so that no infinity spreads.
fn finite(value: f64, dimension: Option<Dimension>, span: Span) -> Eval<Value> {
    match dimension {
        Some(dimension) if value.is_finite() => Ok(Value::Quantity(value, dimension)),
        _ => Err(fault(code::BAD_VALUE, span, "the result is no finite number", "too large to compute with")),
    }
}

fn order_of(a: &Value, b: &Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Int(x), Value::Int(y)) => Some(x.cmp(y)),
        (Value::Int(_) | Value::Big(_), Value::Int(_) | Value::Big(_)) => Some(a.as_big()?.cmp(&b.as_big()?)),
        (Value::Text(x), Value::Text(y)) => Some(x.cmp(y)),
        _ => a.as_number()?.partial_cmp(&b.as_number()?),
    }
}

fn comparison(op: BinaryOp) -> Compare {
    match op {
        BinaryOp::Lt => Compare::Less,
        BinaryOp::Le => Compare::LessEqual,
        BinaryOp::Gt => Compare::Greater,
        _ => Compare::GreaterEqual,
    }
}

fn flipped(compare: Compare) -> Compare {
    match compare {
        Compare::Less => Compare::Greater,
        Compare::LessEqual => Compare::GreaterEqual,
        Compare::Greater => Compare::Less,
        Compare::GreaterEqual => Compare::LessEqual,
    }
}

/// Returns the condition that a signal compares with a value.
///
/// # Errors
/// A fault where no robot senses the signal.
fn compare_signal(signal: &SignalValue, compare: Compare, value: f64, span: Span) -> Eval<Value> {
    let Measure::Sensed(sensed) = signal.measure else {
        let message = "no robot senses this while it moves, so nothing can wait for it";
        return Err(Diagnostic::error(code::BAD_ACTION, message)
            .label(span, "worked out by the judge")
            .hint(
                "conditions sense `angle`, `displacement`, `speed`, `elapsed`, `docked`, `torque`, `force`, `separation`, `tilt` and `touching`; `p.series(...)` gives all others",
            )
            .into());
    };
    let condition = Condition::Compare { signal: sensed, compare, value };
    Ok(Value::Condition(Rc::new(ConditionValue { robot: signal.robot.clone(), condition })))
}

fn by_zero(span: Span) -> super::stop::Stop {
    fault(code::DIVISION_BY_ZERO, span, "division by zero", "this is zero")
}

/// Returns the fault of operands that do not fit: `check` lets none through, this is the net under it.
fn operands_do_not_fit(span: Span) -> super::stop::Stop {
    Diagnostic::error(code::OPERANDS, "the operator does not apply to these values")
        .label(span, "here")
        .into()
}
