//! Types as they are written, and the subtype relation.

use super::bindings::Bindings;
use super::checker::{Bound, Checker, DefItem, Entity};
use super::family::Family;
use super::scope::Scope;
use super::typed::DefId;
use super::types::{Choice, FnType, Type};
use crate::source::foreign;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Symbol, code};
use crate::syntax::ast::{self, TypeKind};
use crate::units::{self, Dimension, NAMED};
use std::sync::Arc;

/// The built-in type names without arguments, named dimensions and supertypes of families apart.
const PLAIN: &[(&str, Type)] = &[
    ("Any", Type::Any),
    ("Int", Type::Int),
    ("Bool", Type::Bool),
    ("Text", Type::Text),
    ("Pose", Type::Pose),
    ("Port", Type::Port),
    ("Behavior", Type::Behavior),
    ("Condition", Type::Condition),
    ("Shape", Type::Shape),
    ("JointKind", Type::JointKind),
    ("Cells", Type::Cells),
    ("Mesh", Type::Mesh),
    ("Cloud", Type::Cloud),
    ("Terrain", Type::Terrain),
];

/// Returns the built-in type of a name without arguments: one of [`PLAIN`], or the supertype of a family;
/// `None` for other names.
fn plain(name: &str) -> Option<Type> {
    let listed = PLAIN.iter().find(|(n, _)| *n == name).map(|(_, ty)| ty.clone());
    let family = || Family::ALL.into_iter().find(|family| family.name() == name).map(Type::AnyOf);
    listed.or_else(family)
}

/// The built-in type names with an argument.
const WITH_ARGUMENT: &[&str] = &["List", "Vec3", "Range", "Joint", "Signal", "Quantity", "Study"];

impl<'a> Checker<'a> {
    /// Returns the type that a type expression stands for in `scope`; [`Type::Error`], after a report, if it is
    /// unknown.
    pub(super) fn type_expr(&mut self, scope: &Scope, ty: &ast::TypeExpr) -> Type {
        match &ty.kind {
            TypeKind::Error => Type::Error,
            TypeKind::Optional(inner) => Type::optional(self.type_expr(scope, inner)),
            TypeKind::Fn { params, result } => {
                let params = params.iter().map(|p| self.type_expr(scope, p)).collect();
                Type::Fn(Arc::new(FnType { params, result: self.type_expr(scope, result) }))
            }
            TypeKind::Choice(alternatives) => self.choice_type(scope, alternatives),
            TypeKind::Quantity(unit) => self.quantity_type(scope, unit),
            TypeKind::Named { path, args } if args.is_empty() => self.plain_type(scope, path),
            TypeKind::Named { path, args } => self.generic_type(scope, path, args),
        }
    }

    /// Checks a choice.
    fn choice_type(&mut self, scope: &Scope, alternatives: &[ast::TypeExpr]) -> Type {
        let mut choice = Choice { words: Vec::new(), types: Vec::new() };
        for alternative in alternatives {
            match self.choice_word(scope, alternative) {
                Some(word) => choice.words.push(word),
                None => choice.types.push(self.type_expr(scope, alternative)),
            }
        }
        Type::Choice(Arc::new(choice))
    }

    /// Returns a bare name in a choice that names no type: a word of the choice; `None` for a type.
    fn choice_word(&self, scope: &Scope, ty: &ast::TypeExpr) -> Option<Symbol> {
        let TypeKind::Named { path, args } = &ty.kind else { return None };
        let [name] = path.as_slice() else { return None };
        let text = name.text.as_str();
        let known = scope.type_params.iter().any(|p| p.name == name.text)
            || plain(text).is_some()
            || Dimension::named(text).is_some()
            || matches!(self.entity(scope.file, name.text), Some(Entity::Def(id)) if self.is_type(id));
        (args.is_empty() && !known).then_some(name.text)
    }

    /// Returns true if a declaration is a type.
    fn is_type(&self, id: DefId) -> bool {
        self.family(id).is_some() || matches!(self.def(id).item, DefItem::Record(_) | DefItem::ExternType(_))
    }

    /// Checks a quantity type `Quantity<m/s>`, or one with a dimension parameter, `Quantity<D/s>`.
    fn quantity_type(&mut self, scope: &Scope, unit: &ast::UnitExpr) -> Type {
        let param = |(name, _): &(ast::Name, i32)| scope.type_params.iter().position(|p| p.name == name.text);
        let mut units = unit.clone();
        let own = units.factors.iter().position(|factor| param(factor).is_some());
        let own = own.map(|at| units.factors.remove(at));
        let Some((times, _)) = self.unit(&units) else { return Type::Error };
        let Some(own) = own else { return Type::Quantity(times) };
        let index = param(&own).expect("it was found by that");
        let power = i8::try_from(own.1).expect("the grammar keeps powers within 99");
        let ty = Type::QuantityParam { param: index as u8, power, times };
        if scope.in_body { Bindings::opaque(&scope.type_params).apply(&ty) } else { ty }
    }

    /// Returns (dimension, factors) of a unit: its dimension, and its factors as (factor to SI, exponent), in the
    /// order of the text; `None`, after a report, if the unit is unknown or a power too large.
    pub(super) fn unit(&mut self, unit: &ast::UnitExpr) -> Option<(Dimension, Vec<(f64, i32)>)> {
        let mut dimension = Dimension::NUMBER;
        let mut factors = Vec::new();
        for (name, power) in &unit.factors {
            let Some(known) = units::unit(name.text.as_str()) else {
                self.unknown_unit(name);
                return None;
            };
            let Some(sum) = known.dimension.power(i64::from(*power)).and_then(|d| dimension.times(d)) else {
                self.report(
                    Diagnostic::error(code::UNKNOWN_UNIT, "this unit has too large a power")
                        .label(unit.span, "too large a power"),
                );
                return None;
            };
            dimension = sum;
            factors.push((known.factor, *power));
        }
        Some((dimension, factors))
    }

    /// Reports an unknown unit.
    fn unknown_unit(&mut self, name: &ast::Name) {
        let names = units::UNITS.iter().map(|u| u.name);
        let mut diagnostic = Diagnostic::error(code::UNKNOWN_UNIT, format!("`{}` is no unit", name.text))
            .label(name.span, "a unit sticks to its number");
        if let Some(meant) = foreign::unit(name.text.as_str()) {
            return self.report(diagnostic.hint(format!("write `{meant}`")));
        }
        if let Some(here) = foreign::measure(name.text.as_str()) {
            return self.report(diagnostic.hint(here));
        }
        if let Some(near) = suggest(name.text.as_str(), names) {
            diagnostic = diagnostic.hint(format!("`{near}`?"));
        }
        self.report(
            diagnostic.hint(format!("with spaces it is a variable: `90deg / {0}`, `2 * {0}`", name.text)),
        );
    }

    /// Checks a type name without arguments.
    fn plain_type(&mut self, scope: &Scope, path: &[ast::Name]) -> Type {
        if let [name] = path {
            if let Some(index) = scope.type_params.iter().position(|p| p.name == name.text) {
                let ty = match scope.type_params[index].bound {
                    Bound::Dimension => {
                        Type::QuantityParam { param: index as u8, power: 1, times: Dimension::NUMBER }
                    }
                    _ => Type::Param(index as u8),
                };
                return if scope.in_body { Bindings::opaque(&scope.type_params).apply(&ty) } else { ty };
            }
            if let Some(ty) = plain(name.text.as_str()) {
                return ty;
            }
            if let Some(d) = Dimension::named(name.text.as_str()) {
                return Type::Quantity(d);
            }
        }
        match self.path_entity(scope.file, path) {
            Some(Entity::Def(id)) => match self.def(id).item {
                DefItem::Record(_) | DefItem::ExternType(_) => Type::Record(id),
                _ if self.family(id).is_some() => Type::Instance(id),
                _ => self.no_type(scope, path, "is no type"),
            },
            Some(Entity::File(_)) => self.no_type(scope, path, "is a file, no type"),
            Some(Entity::Error) => Type::Error,
            None => self.no_type(scope, path, "is no type that is known here"),
        }
    }

    /// Reports a path that is not a type.
    fn no_type(&mut self, scope: &Scope, path: &[ast::Name], why: &str) -> Type {
        let last = path[path.len() - 1];
        let span = path[0].span.to(last.span);
        let mut known: Vec<&str> = self.visible_names(scope.file);
        known.extend(PLAIN.iter().map(|(n, _)| *n));
        known.extend(Family::ALL.map(Family::name));
        known.extend(NAMED.iter().map(|(n, _)| *n));
        known.extend(WITH_ARGUMENT);
        let types = known.into_iter().filter(|n| n.starts_with(|c: char| c.is_ascii_uppercase()));
        let mut diagnostic = Diagnostic::error(code::NOT_A_TYPE, format!("`{}` {why}", last.text))
            .label(span, "a type is wanted here");
        if let Some(here) = foreign::of_type(last.text.as_str()) {
            diagnostic = diagnostic.hint(format!("write {here}"));
        } else if let Some(import) = self.import_hint(scope.file, last.text).filter(|_| path.len() == 1) {
            diagnostic = diagnostic.hint(import);
        } else if let Some(near) = suggest(last.text.as_str(), types) {
            diagnostic = diagnostic.hint(format!("`{near}`?"));
        }
        self.report(diagnostic);
        Type::Error
    }

    /// Returns the entity of a dotted path at the top of a file, an index into the loaded files; `None` if there is
    /// none, or it is private to another file (not reported).
    pub(super) fn path_entity(&self, file: usize, path: &[ast::Name]) -> Option<Entity> {
        let mut entity = self.named_entity(file, path[0].text, path[0].span)?;
        for name in &path[1..] {
            entity = match entity {
                Entity::File(target) => {
                    let inner = self.top(target).get(&name.text).copied()?;
                    match inner {
                        Entity::Def(id) if self.def(id).file != target => return None,
                        Entity::Def(_) if name.text.as_str().starts_with('_') => return None,
                        other => other,
                    }
                }
                Entity::Error => return Some(Entity::Error),
                Entity::Def(_) => return None,
            };
        }
        Some(entity)
    }

    /// Checks a type name with arguments.
    fn generic_type(&mut self, scope: &Scope, path: &[ast::Name], args: &[ast::TypeExpr]) -> Type {
        let name = path[path.len() - 1];
        let known = path.len() == 1 && WITH_ARGUMENT.contains(&name.text.as_str());
        let ([arg], true) = (args, known) else {
            return self.no_type(scope, path, "takes no type in `<...>`");
        };
        let inner = self.type_expr(scope, arg);
        match (name.text.as_str(), &inner) {
            (_, Type::Error) => Type::Error,
            ("List", _) => Type::List(Arc::new(inner)),
            ("Range", Type::Int | Type::Quantity(_) | Type::QuantityParam { .. } | Type::Param(_)) => {
                Type::Range(Arc::new(inner))
            }
            ("Vec3", Type::Quantity(_) | Type::QuantityParam { .. }) => Type::Vec3(Arc::new(inner)),
            ("Joint", Type::QuantityParam { .. }) => Type::Joint(Arc::new(inner)),
            ("Joint", Type::Quantity(d)) if [Dimension::ANGLE, Dimension::LENGTH].contains(d) => {
                Type::Joint(Arc::new(inner))
            }
            (
                "Signal",
                Type::Quantity(_)
                | Type::QuantityParam { .. }
                | Type::Vec3(_)
                | Type::Pose
                | Type::Bool
                | Type::Param(_)
                | Type::Opaque(..),
            ) => Type::Signal(Arc::new(inner)),
            ("Study", Type::Record(_) | Type::Param(_) | Type::Opaque(..)) => Type::Study(Arc::new(inner)),
            ("Quantity", Type::Quantity(_)) => inner,
            _ => {
                let message = format!("`{}` takes no {}", name.text, self.name(&inner));
                self.report(
                    Diagnostic::error(code::NOT_A_TYPE, message)
                        .label(arg.span, "another type is wanted here"),
                );
                Type::Error
            }
        }
    }

    /// Returns true if a value of type `got` may be used where `want` is expected (subtyping); radians may be dropped
    /// as [`Dimension::fits`] says, and [`Type::Error`] fits any type.
    pub(super) fn fits(&self, got: &Type, want: &Type) -> bool {
        match (got, want) {
            (Type::Error, _) | (_, Type::Error) => true,
            (Type::Nothing, Type::Any) => false,
            (_, Type::Any) => true,
            _ if got == want => true,
            (Type::Int, Type::Quantity(d)) => *d == Dimension::NUMBER,
            (Type::Quantity(a), Type::Quantity(b)) => a.fits(*b),
            (Type::Optional(a), Type::Optional(b)) => self.fits(a, b),
            (_, Type::Optional(b)) => self.fits(got, b),
            (Type::Choice(a), Type::Choice(b)) => {
                a.words.iter().all(|w| b.words.contains(w)) && a.types.iter().all(|t| self.fits(t, want))
            }
            (Type::Choice(a), _) => a.words.is_empty() && a.types.iter().all(|t| self.fits(t, want)),
            (_, Type::Choice(b)) => b.types.iter().any(|t| self.fits(got, t)),
            (Type::List(a), Type::List(b)) | (Type::Vec3(a), Type::Vec3(b)) => self.fits(a, b),
            (Type::Range(a), Type::Range(b)) | (Type::Signal(a), Type::Signal(b)) => self.fits(a, b),
            (Type::Joint(a), Type::Joint(b)) | (Type::Study(a), Type::Study(b)) => self.fits(a, b),
            (Type::Fn(a), Type::Fn(b)) => {
                a.params.len() == b.params.len()
                    && a.params.iter().zip(&b.params).all(|(x, y)| self.fits(y, x))
                    && self.fits(&a.result, &b.result)
            }
            (Type::Instance(id), Type::AnyOf(family)) => self.family(*id).is_some_and(|f| is_a(f, *family)),
            (Type::AnyOf(f), Type::AnyOf(family)) => is_a(*f, *family),
            (Type::Record(id), Type::Record(wanted)) => self.record_line(*id).contains(wanted),
            _ => false,
        }
    }

    /// Returns a record type and those that it extends, itself first: for `Folding`, `Folding` and `Plan`.
    pub(super) fn record_line(&self, id: DefId) -> Vec<DefId> {
        let mut line = vec![id];
        let mut last = id;
        while let DefItem::ExternType(ast::ExternType { is: Some(parent), .. }) = self.def(last).item
            && let Some(Entity::Def(parent)) = self.entity(self.def(last).file, parent.text)
            && !line.contains(&parent)
        {
            line.push(parent);
            last = parent;
        }
        line
    }

    /// Returns the least common supertype of two types, as for the elements of a list: [`Type::AnyOf`] for instances
    /// of one family. `None` if there is none.
    pub(super) fn join(&self, a: &Type, b: &Type) -> Option<Type> {
        if a.is_error() || b.is_error() {
            return Some(if a.is_error() { b.clone() } else { a.clone() });
        }
        if self.fits(a, b) {
            return Some(b.shown_beside(a));
        }
        if self.fits(b, a) {
            return Some(a.shown_beside(b));
        }
        match (a, b) {
            (Type::Optional(x), y) | (y, Type::Optional(x)) => {
                let y = if let Type::Optional(y) = y { y } else { y };
                self.join(x, y).map(Type::optional)
            }
            (Type::List(x), Type::List(y)) => self.join(x, y).map(Type::list),
            _ => {
                let (f, g) = (self.family_of(a)?, self.family_of(b)?);
                if f == g {
                    Some(Type::AnyOf(f))
                } else if is_a(f, Family::Config) && is_a(g, Family::Config) {
                    Some(Type::AnyOf(Family::Config))
                } else {
                    None
                }
            }
        }
    }

    /// Returns the family of an instance type or supertype; `None` for other types.
    fn family_of(&self, ty: &Type) -> Option<Family> {
        match ty {
            Type::Instance(id) => self.family(*id),
            Type::AnyOf(family) => Some(*family),
            _ => None,
        }
    }
}

/// Returns true if instances of a family belong to another: a module is the smallest configuration.
fn is_a(family: Family, wanted: Family) -> bool {
    family == wanted || (family == Family::Module && wanted == Family::Config)
}
