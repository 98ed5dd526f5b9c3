//! Numbers with units and truth values as they are written in a text.

use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, UnaryOp, UnitExpr};
use crate::units;

/// The least difference between numbers that are written, in their unit: finer than any slider.
pub(super) const FINEST: f64 = 1e-6;

/// A number with its unit, or a truth value, that stands in a text as a literal.
#[derive(Clone, Debug, PartialEq)]
pub enum Written {
    /// A number.
    Number {
        /// The number in its unit.
        value: f64,
        /// The unit as it is written, such as `deg`; empty for a plain number.
        unit: String,
        /// The value of one such unit in SI.
        factor: f64,
    },
    /// A truth value.
    Bool(bool),
}

/// Returns the literal that an expression is; `None` for any other expression. `text`: that of its file.
pub(super) fn literal(expr: &Expr, text: &str) -> Option<Written> {
    match &expr.kind {
        ExprKind::Bool(value) => Some(Written::Bool(*value)),
        ExprKind::Number { digits, unit } => {
            let value = digits.as_str().parse::<f64>().ok()?;
            let (unit, factor) = match unit {
                Some(unit) => (written(text, unit.span)?, factor(unit)?),
                None => (String::new(), 1.0),
            };
            Some(Written::Number { value, unit, factor })
        }
        ExprKind::Unary { op: UnaryOp::Neg, operand, .. } => match literal(operand, text)? {
            Written::Number { value, unit, factor } => Some(Written::Number { value: -value, unit, factor }),
            Written::Bool(_) => None,
        },
        _ => None,
    }
}

fn written(text: &str, span: Span) -> Option<String> {
    text.get(span.range()).map(str::to_owned)
}

/// Returns the value of a unit in SI; `None` if the language has no such unit.
fn factor(unit: &UnitExpr) -> Option<f64> {
    let one = |(name, power): &(crate::syntax::ast::Name, i32)| {
        Some(libm::pow(units::unit(name.text.as_str())?.factor, f64::from(*power)))
    };
    unit.factors.iter().map(one).product()
}

/// Returns a number with its unit as programs write it: without an exponent, with six decimals at most. `None` for a number that is
/// not finite.
pub(super) fn number(value: f64, unit: &str) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    // Of zero, both signs are the same number.
    let shown = if rounded(value) == 0.0 { 0.0 } else { rounded(value) };
    Some(format!("{shown}{unit}"))
}

/// Returns a number rounded to six decimals.
pub(super) fn rounded(value: f64) -> f64 {
    (value / FINEST).round() / (1.0 / FINEST).round()
}
