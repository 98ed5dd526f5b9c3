//! Literals: numbers with their units, texts, and words of choices.

use super::checker::{Checker, DefItem, Entity, MemberInfoKind};
use super::expr::{error_expr, expr_of};
use super::scope::Scope;
use super::typed::{Expr, ExprKind};
use super::types::Type;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use crate::units::Dimension;
use crate::units::to_si;

impl<'a> Checker<'a> {
    /// Returns the typed expression of a number with its unit, if it has one, in SI units; an error node, after a
    /// report, if it is too large or the unit is unknown. A later factor of the unit that is also the name of a
    /// variable in `scope` is warned of.
    pub(super) fn number(
        &mut self,
        scope: &Scope,
        span: Span,
        digits: Symbol,
        unit: Option<&ast::UnitExpr>,
    ) -> Expr {
        let text = digits.as_str();
        let Some(unit) = unit else { return self.plain_number(span, text) };
        let Ok(value) = text.parse::<f64>() else { return self.bad_number(span) };
        // The first factor is unambiguous: only a unit may follow a number directly.
        for (name, _) in unit.factors.iter().skip(1) {
            if self.is_variable(scope, name.text) {
                self.report(
                    Diagnostic::warning(
                        code::UNIT_SHADOWED,
                        format!("`{0}` here is the unit, not the variable `{0}`", name.text),
                    )
                    .label(name.span, "a unit sticks to its number")
                    .hint("with a space and an operator it is the variable"),
                );
            }
        }
        match self.unit(unit) {
            Some((dimension, factors)) => {
                let value = scaled(value, &factors);
                if !value.is_finite() {
                    return self.bad_number(span);
                }
                expr_of(span, Type::Quantity(dimension), ExprKind::Number(value))
            }
            None => error_expr(span),
        }
    }

    /// Returns true if a name could stand for a number: a local, a parameter or `let` of the body, or a
    /// `let` of the file.
    pub(super) fn is_variable(&mut self, scope: &Scope, name: Symbol) -> bool {
        if let Some(ty) = scope.local_type(name) {
            return ty.dimension().is_some();
        }
        if let Some(this) = scope.this {
            let members = self.members(this);
            if let Some(member) = members.index.get(&name) {
                let kind = members.list[member.0 as usize].kind;
                return matches!(kind, MemberInfoKind::Param(_) | MemberInfoKind::Let(_));
            }
        }
        match self.top(scope.file).get(&name) {
            Some(Entity::Def(id)) => matches!(self.def(*id).item, DefItem::Let(_)),
            _ => false,
        }
    }

    /// Returns the typed expression of a number without unit from its text: an `Int` without point and exponent, else
    /// a `Number`; an error node, after a report, if a `Number` is too large.
    pub(super) fn plain_number(&mut self, span: Span, text: &str) -> Expr {
        if !text.contains(['.', 'e', 'E']) {
            return match text.parse::<i64>() {
                Ok(value) => expr_of(span, Type::Int, ExprKind::Int(value)),
                Err(_) => expr_of(span, Type::Int, ExprKind::BigInt(Symbol::new(text))),
            };
        }
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => expr_of(span, Type::NUMBER, ExprKind::Number(value)),
            _ => self.bad_number(span),
        }
    }

    /// Reports that the number at `span` is too large, and returns the error node for it.
    pub(super) fn bad_number(&mut self, span: Span) -> Expr {
        self.report(
            Diagnostic::error(code::BAD_NUMBER, "this number is too large")
                .label(span, "beyond what a number can hold"),
        );
        error_expr(span)
    }

    /// Returns the typed expression of a text with its interpolated expressions, which may be of any type; error
    /// nodes, after a report, stand for those that are wrong.
    pub(super) fn text(&mut self, scope: &mut Scope, span: Span, parts: &'a [ast::TextPart]) -> Expr {
        if let [] | [ast::TextPart::Literal(_)] = parts {
            let text = parts.first().map_or("", |p| match p {
                ast::TextPart::Literal(text) => text.as_str(),
                ast::TextPart::Value(_) | ast::TextPart::Shown { .. } => unreachable!("matched as a literal"),
            });
            return expr_of(span, Type::Text, ExprKind::Text(text.into()));
        }
        let pieces = parts
            .iter()
            .map(|part| match part {
                ast::TextPart::Literal(text) => {
                    expr_of(span, Type::Text, ExprKind::Text(text.as_str().into()))
                }
                ast::TextPart::Value(e) => self.expr(scope, e, None),
                ast::TextPart::Shown { value, unit, decimals } => {
                    self.shown(scope, value, unit.as_ref(), *decimals)
                }
            })
            .collect();
        expr_of(span, Type::Text, ExprKind::Interpolation(pieces))
    }
}

/// The greatest number of decimals that a text may ask for.
const DECIMALS_MAX: usize = 20;

impl<'a> Checker<'a> {
    /// Checks a quantity of a text in a stated unit, or with a stated number of decimals: `{x in mm:.2}`.
    fn shown(
        &mut self,
        scope: &mut Scope,
        value: &'a ast::Expr,
        unit: Option<&ast::UnitExpr>,
        decimals: Option<(Symbol, Span)>,
    ) -> Expr {
        let value = self.expr(scope, value, None);
        let span = value.span;
        let places = decimals.map(|(digits, _)| digits.as_str().parse::<usize>().unwrap_or(usize::MAX));
        if let (Some((_, at)), Some(DECIMALS_MAX..)) = (decimals, places.filter(|n| *n > DECIMALS_MAX)) {
            let message = format!("a text shows at most {DECIMALS_MAX} decimals");
            self.report(Diagnostic::error(code::BAD_NUMBER, message).label(at, "too many"));
            return error_expr(span);
        }
        let unit = match unit {
            Some(written) => match self.unit(written) {
                Some((dimension, factors)) => Some((written.span, dimension, scaled(1.0, &factors))),
                None => return error_expr(span),
            },
            None => None,
        };
        if value.ty.is_error() {
            return value;
        }
        let words = self.words(&value.ty);
        let Some(dimension) = shown_dimension(&value.ty) else {
            let message = format!("a unit and a number of decimals are for quantities; this is {words}");
            self.report(
                Diagnostic::error(code::TYPE_MISMATCH, message)
                    .label(span, format!("this is {words}"))
                    .hint("`{...}` alone shows any value; `pad(text, width)` fills it up"),
            );
            return error_expr(span);
        };
        if let Some((at, wanted, _)) = unit
            && !dimension.fits(wanted)
        {
            let name = &self.sources.file(at.file).text[at.range()];
            let message = format!("{words} can't be shown in `{name}`");
            self.report(
                Diagnostic::error(code::DIMENSION_MISMATCH, message)
                    .label(span, format!("this is {words}"))
                    .label(at, "another dimension"),
            );
            return error_expr(span);
        }
        let unit = unit.map(|(at, _, factor)| (self.sources.file(at.file).text[at.range()].into(), factor));
        expr_of(span, Type::Text, ExprKind::Shown { value: Box::new(value), unit, decimals: places })
    }
}

/// Returns the dimension of a type of quantities: one, a list, a vector, and where they may be missing.
fn shown_dimension(ty: &Type) -> Option<Dimension> {
    match ty {
        Type::List(inner) | Type::Optional(inner) | Type::Vec3(inner) => shown_dimension(inner),
        ty => ty.dimension(),
    }
}

/// Converts a value to SI units: multiplies it by the factors of its units, each (factor to SI, exponent).
pub(super) fn scaled(value: f64, factors: &[(f64, i32)]) -> f64 {
    factors.iter().fold(value, |value, (factor, power)| {
        let times = power.unsigned_abs();
        (0..times).fold(value, |v, _| if *power > 0 { to_si(v, *factor) } else { v / to_si(1.0, *factor) })
    })
}

/// Returns the unit vector of a coordinate axis, such as `X` or `-Z`, as an expression of three plain numbers.
pub(super) fn direction(span: Span, axis: ast::Axis) -> Expr {
    let one = |on: bool| expr_of(span, Type::NUMBER, ExprKind::Number(if on { 1.0 } else { 0.0 }));
    let parts = [ast::Axis::X, ast::Axis::Y, ast::Axis::Z].map(|a| one(a == axis));
    expr_of(span, Type::vec3(Dimension::NUMBER), ExprKind::Vec3(Box::new(parts)))
}
