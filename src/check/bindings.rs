//! Type parameters: what they are bound to in a call.

use super::checker::{Bound, Checker, ParamInfo, TypeParam};
use super::expr::has_params;
use super::scope::Scope;
use super::typed::Expr;
use super::types::{FnType, Type};
use crate::syntax::ast;
use crate::units::Dimension;
use std::sync::Arc;

/// The greatest number of lambdas within each other that are checked for a wider binding. Each is checked up to three
/// times, and all in it as often.
const WIDENING_MAX: u8 = 2;
/// The greatest length in bytes of a lambda that is checked for a wider binding within another: what nests deeper
/// would take its time to the power of three.
const WIDENED_MAX: usize = 1_000;

/// The first words of the error that a lambda's result is of another type.
const RESULT_WANTS: &str = "the function's result wants";

/// The types and dimensions bound to the type parameters of a function in one call. Each of its lists has one entry for
/// each type parameter, in order.
#[derive(Clone, Default)]
pub(super) struct Bindings {
    /// The type of each parameter; `None` until one is bound, and for a dimension parameter.
    pub(super) types: Vec<Option<Type>>,
    /// The dimension of each parameter; `None` until one is bound, and for a parameter that is a type.
    pub(super) dimensions: Vec<Option<Dimension>>,
    /// The bound of each parameter: the types that it may stand for.
    pub(super) bounds: Vec<Bound>,
}

impl<'a> Checker<'a> {
    /// Returns the typed lambda of an argument written as `e`, in `scope`, for the parameter `param` whose type has
    /// type parameters, which it binds in `bindings`; an error node, after a report, if the lambda has a mistake or
    /// does not fit.
    ///
    /// Its result may not fit what the arguments before it have bound, as in `reduce(list, (a, x) => a + x, from: 0)`
    /// over numbers: then the parameter is bound anew to what both fit, and the lambda is checked again with it.
    pub(super) fn lambda_argument(
        &mut self,
        scope: &mut Scope,
        e: &'a ast::Expr,
        param: &ParamInfo,
        bindings: &mut Bindings,
    ) -> Expr {
        let known = self.diagnostics.len();
        let want = bindings.apply(&param.ty);
        let got = self.expr(scope, e, Some(&want));
        let mut errors = self.diagnostics[known..].iter().filter(|d| d.is_error()).peekable();
        let failed = errors.peek().is_some() && errors.all(|d| d.message.starts_with(RESULT_WANTS));
        let (Type::Fn(pattern), Type::Fn(bound)) = (&param.ty, &want) else {
            return self.bind_argument(got, &param.ty, param.name, bindings);
        };
        let short = e.span.range().len() <= WIDENED_MAX;
        let again = self.widening == 0 || self.widening < WIDENING_MAX && short;
        if !failed || has_params(&bound.result) || !again {
            return self.bind_argument(got, &param.ty, param.name, bindings);
        }
        let told = self.diagnostics.split_off(known);
        let free = FnType { params: bound.params.clone(), result: pattern.result.clone() };
        self.widening += 1;
        let result = self.expr(scope, e, Some(&Type::Fn(Arc::new(free))));
        let mut wider = bindings.clone();
        let fits = self.diagnostics.len() == known
            && matches!(&result.ty, Type::Fn(f) if self.unify(&pattern.result, &f.result, &mut wider));
        let want = wider.apply(&param.ty);
        let again = fits.then(|| self.expr(scope, e, Some(&want)));
        self.widening -= 1;
        let sound = self.diagnostics.len() == known;
        self.diagnostics.truncate(known);
        match again {
            Some(again) if sound => {
                *bindings = wider;
                again
            }
            _ => {
                self.diagnostics.extend(told);
                got
            }
        }
    }

    /// Binds the type parameters in `pattern` so that a value of type `got` fits it; returns true if it does. After
    /// false some parameters may be bound anew.
    pub(super) fn unify(&self, pattern: &Type, got: &Type, bindings: &mut Bindings) -> bool {
        match (pattern, got) {
            (_, Type::Error) => true,
            (Type::Param(i), _) => {
                let joined = match &bindings.types[*i as usize] {
                    None => Some(got.clone()),
                    Some(bound) => self.join(bound, got),
                };
                let Some(joined) = joined else { return false };
                let within = match bindings.bounds[*i as usize] {
                    Bound::Quantity => joined.dimension().is_some(),
                    Bound::Family(family) => self.fits(&joined, &Type::AnyOf(family)),
                    Bound::Anything | Bound::Dimension => true,
                };
                if !within {
                    return false;
                }
                bindings.types[*i as usize] = Some(joined);
                true
            }
            (Type::QuantityParam { param, power, times }, _) => {
                let Some(d) = got.dimension() else { return false };
                let base = d.over(*times).and_then(|rest| rest.root(*power));
                let slot = &mut bindings.dimensions[*param as usize];
                match (base, &*slot) {
                    (None, _) => false,
                    (Some(base), None) => {
                        *slot = Some(base);
                        true
                    }
                    (Some(base), Some(bound)) => match base.common(*bound) {
                        Some(common) => {
                            *slot = Some(common);
                            true
                        }
                        None => false,
                    },
                }
            }
            (Type::List(p), Type::List(g))
            | (Type::Vec3(p), Type::Vec3(g))
            | (Type::Range(p), Type::Range(g))
            | (Type::Signal(p), Type::Signal(g))
            | (Type::Study(p), Type::Study(g))
            | (Type::Joint(p), Type::Joint(g))
            | (Type::Optional(p), Type::Optional(g)) => self.unify(p, g, bindings),
            (Type::Optional(p), _) => self.unify(p, got, bindings),
            (Type::Fn(p), Type::Fn(g)) => self.unify_fn(p, g, bindings),
            (Type::Choice(c), _) => {
                self.fits(got, pattern) || c.types.iter().any(|t| self.unify(t, got, bindings))
            }
            _ => self.fits(got, pattern),
        }
    }

    /// Unifies two function types: parameters and result.
    fn unify_fn(&self, pattern: &FnType, got: &FnType, bindings: &mut Bindings) -> bool {
        if pattern.params.len() != got.params.len() {
            return false;
        }
        let params = pattern.params.iter().zip(&got.params);
        let bound = params.map(|(p, g)| has_params(g) || self.unify(p, g, bindings)).fold(true, |a, b| a & b);
        bound && self.unify(&pattern.result, &got.result, bindings)
    }
}

impl Bindings {
    /// Returns bindings of `params` in which nothing is bound.
    pub(super) fn new(params: &[TypeParam]) -> Bindings {
        let n = params.len();
        let bounds = params.iter().map(|p| p.bound).collect();
        Bindings { types: vec![None; n], dimensions: vec![None; n], bounds }
    }

    /// Returns the bindings of a function's own type parameters in its body: each to itself, as a type of which
    /// nothing is known.
    pub(super) fn opaque(params: &[TypeParam]) -> Bindings {
        let mut bindings = Bindings::new(params);
        for (i, param) in params.iter().enumerate() {
            bindings.types[i] = Some(Type::Opaque(i as u8, param.name));
            bindings.dimensions[i] = Some(Dimension::PARAM);
        }
        bindings
    }

    /// Returns the type of all that an unbound parameter may stand for, if `ty` is one that is bounded by a family of
    /// declarations; any other type is returned as it is.
    pub(super) fn bound_of(&self, ty: Type) -> Type {
        match ty {
            Type::Param(i) => match self.bounds[usize::from(i)] {
                Bound::Family(family) => Type::AnyOf(family),
                _ => ty,
            },
            _ => ty,
        }
    }

    /// Returns a type with the bound parameters substituted; unbound ones stay. [`Type::Error`] stands for a quantity
    /// in which the exponent of a base dimension would be too large.
    pub(super) fn apply(&self, ty: &Type) -> Type {
        let inner = |t: &Arc<Type>| Arc::new(self.apply(t));
        match ty {
            Type::Param(i) => self.types[*i as usize].clone().unwrap_or_else(|| ty.clone()),
            Type::QuantityParam { param, power, times } => match self.dimensions[*param as usize] {
                Some(d) => {
                    let whole = d.power(i64::from(*power)).and_then(|d| d.times(*times));
                    whole.map_or(Type::Error, Type::Quantity)
                }
                None => ty.clone(),
            },
            Type::List(t) => Type::List(inner(t)),
            Type::Vec3(t) => Type::Vec3(inner(t)),
            Type::Range(t) => Type::Range(inner(t)),
            Type::Optional(t) => Type::Optional(inner(t)),
            Type::Signal(t) => Type::Signal(inner(t)),
            Type::Study(t) => Type::Study(inner(t)),
            Type::Joint(t) => Type::Joint(inner(t)),
            Type::Fn(f) => Type::Fn(Arc::new(FnType {
                params: f.params.iter().map(|p| self.apply(p)).collect(),
                result: self.apply(&f.result),
            })),
            Type::Choice(c) => {
                let types = c.types.iter().map(|t| self.apply(t)).collect();
                Type::Choice(Arc::new(super::types::Choice { words: c.words.clone(), types }))
            }
            _ => ty.clone(),
        }
    }
}
