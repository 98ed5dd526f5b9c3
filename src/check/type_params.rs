//! The type parameters of functions: their bounds, and which of them a function with a body may have.

use super::checker::{Bound, Checker, Signature, TypeParam};
use super::family::Family;
use super::types::Type;
use crate::source::{Diagnostic, code};
use crate::syntax::ast;

impl Checker<'_> {
    /// Returns type parameters with their bounds, in order; an unknown bound is reported.
    pub(super) fn type_params(&mut self, params: &[ast::TypeParam]) -> Vec<TypeParam> {
        let bound = |checker: &mut Self, name: ast::Name| match name.text.as_str() {
            "Dimension" => Bound::Dimension,
            "Quantity" => Bound::Quantity,
            "Module" => Bound::Family(Family::Module),
            "Config" => Bound::Family(Family::Config),
            _ => {
                checker.report(
                    Diagnostic::error(code::NOT_A_TYPE, format!("`{}` bounds no type parameter", name.text))
                        .label(name.span, "one of Dimension, Quantity, Module, Config is wanted"),
                );
                Bound::Anything
            }
        };
        let param = |p: &ast::TypeParam| TypeParam {
            name: p.name.text,
            bound: p.bound.map_or(Bound::Anything, |b| bound(self, b)),
        };
        params.iter().map(param).collect()
    }

    /// Reports mistakes in the type parameters of a function that has a body, in which nothing is known of them: names
    /// given twice, bounds that only built-ins have, parameters that no argument binds, and a result type that is not
    /// written.
    pub(super) fn check_type_params(&mut self, f: &ast::Fn, signature: &Signature) {
        let mut dimension: Option<ast::Name> = None;
        for (index, (written, param)) in f.type_params.iter().zip(&signature.type_params).enumerate() {
            let name = written.name;
            if let Some(first) = f.type_params[..index].iter().find(|p| p.name.text == name.text) {
                self.declared_twice(name.text, first.name.span, name.span);
                continue;
            }
            if let (Bound::Quantity | Bound::Family(_), Some(bound)) = (param.bound, written.bound) {
                let message = format!("`{}` bounds the type parameters of built-ins only", bound.text);
                self.report(
                    Diagnostic::error(code::NOT_A_TYPE, message)
                        .label(bound.span, "`Dimension` may stand here, or no bound")
                        .hint("quantities of any dimension are `<D: Dimension>(x: Quantity<D>)`"),
                );
            }
            if param.bound == Bound::Dimension
                && let Some(first) = dimension.replace(name)
            {
                self.report(
                    Diagnostic::error(code::NOT_A_TYPE, "a function has one dimension parameter at most")
                        .label(name.span, "the second one")
                        .label(first.span, "the first one"),
                );
            }
            if !signature.params.iter().any(|p| mentions(&p.ty, index)) {
                let message = format!("nothing says what `{}` is", name.text);
                self.report(
                    Diagnostic::error(code::CANNOT_INFER, message)
                        .label(name.span, "no parameter has this in its type")
                        .hint("a call binds it by the types of its arguments"),
                );
            }
        }
        if let (None, [first, ..]) = (&f.result, f.type_params.as_slice()) {
            self.report(
                Diagnostic::error(code::CANNOT_INFER, "a function with type parameters says what it gives")
                    .label(f.name.span, "no result is written")
                    .label(first.name.span, "a type parameter")
                    .hint("write its result: `-> Type` behind the parameters"),
            );
        }
    }
}

/// Returns true if a type mentions the type parameter of this index.
fn mentions(ty: &Type, index: usize) -> bool {
    match ty {
        Type::Param(i) => usize::from(*i) == index,
        Type::QuantityParam { param, .. } => usize::from(*param) == index,
        Type::List(t)
        | Type::Vec3(t)
        | Type::Range(t)
        | Type::Optional(t)
        | Type::Signal(t)
        | Type::Study(t)
        | Type::Joint(t) => mentions(t, index),
        Type::Fn(f) => f.params.iter().chain([&f.result]).any(|t| mentions(t, index)),
        Type::Choice(c) => c.types.iter().any(|t| mentions(t, index)),
        _ => false,
    }
}
