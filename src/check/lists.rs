//! Lists, comprehensions, ranges and indices.

use super::checker::Checker;
use super::expr::{Role, alternatives, error_expr, expr_of, has_params, in_dimensions};
use super::scope::Scope;
use super::typed::{Clause, Expr, ExprKind};
use super::types::Type;
use crate::source::{Diagnostic, Span, code};
use crate::syntax::ast;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed expression of a list `[a, b]`, or of a vector if `want` expects one and there are three
    /// elements; an error node, after a report, if the elements have no common type. Elements that do not fit the
    /// expected type are reported, and are error nodes. `want`: the type expected of the list, `None` if any will do.
    pub(super) fn list(
        &mut self,
        scope: &mut Scope,
        span: Span,
        items: &'a [ast::Expr],
        want: Option<&Type>,
    ) -> Expr {
        if let Some(element) = want.and_then(vec3_element)
            && let [x, y, z] = items
        {
            let element = element.clone();
            let role = Role::Place("each coordinate");
            let parts = [x, y, z].map(|e| match &element {
                Type::QuantityParam { .. } => self.expr(scope, e, None),
                element => self.expect(scope, e, element, role),
            });
            let element = match element {
                Type::QuantityParam { .. } => parts[0].ty.clone(),
                element => element,
            };
            return expr_of(span, Type::Vec3(Arc::new(element)), ExprKind::Vec3(Box::new(parts)));
        }
        let element = want.and_then(list_element).cloned();
        let mut common: Option<Type> = None;
        let mut out = Vec::with_capacity(items.len());
        for item in items {
            let got = self.expr(scope, item, element.as_ref());
            let joined = match &common {
                None => Some(got.ty.clone()),
                Some(ty) => self.join(ty, &got.ty),
            };
            match joined {
                Some(ty) => common = Some(ty),
                None if element.is_some() => {}
                None => {
                    let (a, b) =
                        (self.words(common.as_ref().expect("an element came before")), self.words(&got.ty));
                    self.report(
                        Diagnostic::error(code::TYPE_MISMATCH, "the elements of a list are of one type")
                            .label(got.span, format!("this is {b}"))
                            .label(items[0].span, format!("the list began with {a}")),
                    );
                    return error_expr(span);
                }
            }
            out.push(got);
        }
        if let Some(element) = &element
            && !has_params(element)
        {
            let role = Role::Place("an element of the list");
            let out: Vec<Expr> = out.into_iter().map(|e| self.coerce(e, element, role)).collect();
            return expr_of(span, Type::list(element.clone()), ExprKind::List(out));
        }
        let common = common.unwrap_or(Type::Error);
        let out = out.into_iter().map(|e| in_dimensions(e, &common)).collect();
        expr_of(span, Type::list(common), ExprKind::List(out))
    }

    /// Returns the typed expression of a list comprehension, written at `span` in `scope`; error nodes, after a
    /// report, stand for a part that is wrong. `want`: the type expected of the list, `None` if any will do.
    pub(super) fn comprehension(
        &mut self,
        scope: &mut Scope,
        span: Span,
        body: &'a ast::Expr,
        clauses: &'a [ast::ComprehensionClause],
        want: Option<&Type>,
    ) -> Expr {
        let mark = scope.open();
        let mut typed = Vec::with_capacity(clauses.len());
        for clause in clauses {
            typed.push(match clause {
                ast::ComprehensionClause::For { binder, iterable } => {
                    let (iterable, element) = self.iterable(scope, iterable);
                    Clause::For { binder: scope.bind(binder.text, element), iterable }
                }
                ast::ComprehensionClause::If(condition) => {
                    Clause::If(self.expect(scope, condition, &Type::Bool, Role::Place("the condition")))
                }
            });
        }
        let element = want.and_then(list_element).filter(|t| !has_params(t)).cloned();
        let body = match &element {
            Some(element) => self.expect(scope, body, element, Role::Place("an element of the list")),
            None => self.expr(scope, body, None),
        };
        scope.close(mark);
        let ty = Type::list(element.unwrap_or_else(|| body.ty.clone()));
        expr_of(span, ty, ExprKind::Comprehension { body: Box::new(body), clauses: typed })
    }

    /// Returns (expression, type of its elements) of what a `for` loops over: the type is [`Type::Error`], after a
    /// report, if it is neither a list nor a range of whole numbers.
    pub(super) fn iterable(&mut self, scope: &mut Scope, e: &'a ast::Expr) -> (Expr, Type) {
        let got = self.expr(scope, e, None);
        let element = match &got.ty {
            Type::List(t) => (**t).clone(),
            Type::Range(t) if **t == Type::Int => Type::Int,
            Type::Error => Type::Error,
            other => {
                let words = self.words(other);
                self.report(
                    Diagnostic::error(
                        code::TYPE_MISMATCH,
                        format!("`for` runs over a list or a range; this is {words}"),
                    )
                    .label(got.span, "a list or a range of whole numbers is wanted")
                    .hint("`for i in 0..4`, `for x in [a, b]`"),
                );
                Type::Error
            }
        };
        (got, element)
    }

    /// Returns the typed expression of a range; an error node, after a report, unless its ends are two whole numbers
    /// or two quantities of one dimension.
    pub(super) fn range(
        &mut self,
        scope: &mut Scope,
        span: Span,
        from: &'a ast::Expr,
        to: &'a ast::Expr,
    ) -> Expr {
        let (a, b) = (self.expr(scope, from, None), self.expr(scope, to, None));
        let element = match (&a.ty, &b.ty) {
            (Type::Error, _) | (_, Type::Error) => return error_expr(span),
            (Type::Int, Type::Int) => Type::Int,
            (x, y) => match x.dimension().zip(y.dimension()).and_then(|(x, y)| x.common(y)) {
                Some(d) => Type::Quantity(d),
                None => {
                    let (x, y) = (self.words(x), self.words(y));
                    self.report(
                        Diagnostic::error(code::OPERANDS, "the ends of a range are of one kind")
                            .label(b.span, format!("this is {y}"))
                            .label(a.span, format!("this is {x}")),
                    );
                    return error_expr(span);
                }
            },
        };
        let [a, b] = [a, b].map(|end| Box::new(in_dimensions(end, &element)));
        let kind = ExprKind::Range { from: a, to: b };
        expr_of(span, Type::Range(Arc::new(element)), kind)
    }

    /// Returns the typed expression of `object[index]`; of type [`Type::Error`], after a report, if the object has no
    /// elements. An index that is not a whole number is reported, and is an error node. `want`: the type expected of
    /// the element, `None` if any will do.
    pub(super) fn index(
        &mut self,
        scope: &mut Scope,
        span: Span,
        object: &'a ast::Expr,
        index: &'a ast::Expr,
        want: Option<&Type>,
    ) -> Expr {
        let list = want.map(|w| Type::list(w.clone()));
        let object = self.expr(scope, object, list.as_ref());
        let index = self.expect(scope, index, &Type::Int, Role::Place("an index"));
        self.index_of(span, object, index)
    }

    /// Returns the typed expression of `object[index]` for typed operands; of type [`Type::Error`], after a report, if
    /// the object has no elements.
    pub(super) fn index_of(&mut self, span: Span, object: Expr, index: Expr) -> Expr {
        let element = match &object.ty {
            Type::List(t) => (**t).clone(),
            Type::Vec3(t) => (**t).clone(),
            Type::Error => Type::Error,
            other => {
                let words = self.words(other);
                self.report(
                    Diagnostic::error(code::OPERANDS, format!("{words} has no elements"))
                        .label(object.span, "a list is wanted before `[...]`"),
                );
                Type::Error
            }
        };
        expr_of(span, element, ExprKind::Index { object: Box::new(object), index: Box::new(index) })
    }
}

/// Returns the type of the three elements of the vector among the alternatives of an expected type; `None` if there is
/// none.
pub(super) fn vec3_element(want: &Type) -> Option<&Type> {
    alternatives(want).into_iter().find_map(|t| if let Type::Vec3(e) = t { Some(&**e) } else { None })
}

/// Returns the type of the elements of the list among the alternatives of an expected type; `None` if there is none.
pub(super) fn list_element(want: &Type) -> Option<&Type> {
    alternatives(want).into_iter().find_map(|t| if let Type::List(e) = t { Some(&**e) } else { None })
}
