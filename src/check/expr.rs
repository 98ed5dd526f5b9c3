//! Expressions: names, literals, lists, blocks; calls and operators have files of their own.

use super::checker::{Checker, DefItem, Entity, MemberInfoKind, Scope};
use super::describe::{dimension_with_unit, dimension_words};
use super::typed::{Clause, DefId, Expr, ExprKind, StmtKind};
use super::types::{Family, FnType, Type};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use crate::units::table::to_si;
use crate::units::{Dimension, is_unit};
use std::sync::Arc;

/// What an expression is wanted for, as messages name it.
#[derive(Clone, Copy)]
pub enum Role {
    Param(Symbol),
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

pub fn expr_of(span: Span, ty: Type, kind: ExprKind) -> Expr {
    Expr { span, ty, kind }
}

pub fn error_expr(span: Span) -> Expr {
    expr_of(span, Type::Error, ExprKind::Error)
}

impl<'a> Checker<'a> {
    /// An expression that must fit a type; reports where it does not.
    pub fn expect(&mut self, scope: &mut Scope, e: &'a ast::Expr, want: &Type, role: Role) -> Expr {
        let got = self.expr(scope, e, Some(want));
        self.coerce(got, want, role)
    }

    pub fn coerce(&mut self, got: Expr, want: &Type, role: Role) -> Expr {
        if !self.fits(&got.ty, want) {
            self.mismatch(&got, want, role);
            return error_expr(got.span);
        }
        match (&got.ty, inner_quantity(want)) {
            (Type::Quantity(a), Some(b)) if *a != b => {
                let span = got.span;
                expr_of(span, Type::Quantity(b), ExprKind::DropRadians(Box::new(got)))
            }
            _ => got,
        }
    }

    /// The text of a span, if it is short enough to be said in a sentence.
    pub fn quoted(&self, span: Span) -> Option<&'a str> {
        let text = self.sources.text(span);
        (text.len() <= 40 && !text.contains('\n')).then_some(text)
    }

    fn mismatch(&mut self, got: &Expr, want: &Type, role: Role) {
        let written = self.quoted(got.span).map_or("this".to_string(), |t| format!("`{t}`"));
        let diagnostic = match (got.ty.dimension(), inner_quantity(want)) {
            (Some(have), Some(need)) => {
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

    fn type_hint(&self, got: &Expr, want: &Type) -> Option<String> {
        let written = self.quoted(got.span).unwrap_or("it");
        match (&got.ty, want) {
            (Type::Fn(f), _) if self.fits(&f.result, want) => Some(format!("call it: `{written}()`")),
            (Type::Optional(_), _) => {
                Some(format!("say what stands in when it is missing: `{written} else ...`"))
            }
            (Type::Condition, Type::Bool) => {
                Some("a condition is watched while the robot moves; it has no value yet".into())
            }
            _ => None,
        }
    }

    pub fn expr(&mut self, scope: &mut Scope, e: &'a ast::Expr, want: Option<&Type>) -> Expr {
        use ast::ExprKind as K;
        let span = e.span;
        match &e.kind {
            K::Error => error_expr(span),
            K::Number { digits, unit } => self.number(scope, span, *digits, unit.as_ref()),
            K::Bool(b) => expr_of(span, Type::Bool, ExprKind::Bool(*b)),
            K::Text(parts) => self.text(scope, span, parts),
            K::Name(name) => self.name_expr(scope, span, *name, want),
            K::Axis(axis) => direction(span, *axis),
            K::Hole => expr_of(span, Type::optional(hole_type(want)), ExprKind::Missing),
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
            K::If { condition, then, otherwise } => {
                self.if_expr(scope, span, condition, then, otherwise.as_deref(), want)
            }
            K::Block { statements, value } => self.block(scope, span, statements, value.as_deref(), want),
            K::Lambda { params, body } => self.lambda(scope, span, params, body, want),
        }
    }

    fn number(&mut self, scope: &Scope, span: Span, digits: Symbol, unit: Option<&ast::UnitExpr>) -> Expr {
        let text = digits.as_str();
        let Some(unit) = unit else { return self.plain_number(span, text) };
        let Ok(value) = text.parse::<f64>() else { return self.bad_number(span) };
        // The first factor can't be misread: nothing but a unit follows a number directly.
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

    /// Whether a number of this name may be meant: a local, a parameter or `let` of the body, or a
    /// `let` of the file.
    fn is_variable(&mut self, scope: &Scope, name: Symbol) -> bool {
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
        match self.scopes[scope.file].get(&name) {
            Some(Entity::Def(id)) => matches!(self.def(*id).item, DefItem::Let(_)),
            _ => false,
        }
    }

    fn plain_number(&mut self, span: Span, text: &str) -> Expr {
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

    fn bad_number(&mut self, span: Span) -> Expr {
        self.report(
            Diagnostic::error(code::BAD_NUMBER, "this number is too large")
                .label(span, "beyond what a number can hold"),
        );
        error_expr(span)
    }

    fn text(&mut self, scope: &mut Scope, span: Span, parts: &'a [ast::TextPart]) -> Expr {
        if let [] | [ast::TextPart::Literal(_)] = parts {
            let text = parts.first().map_or("", |p| match p {
                ast::TextPart::Literal(text) => text.as_str(),
                ast::TextPart::Value(_) => unreachable!("matched as a literal"),
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
            })
            .collect();
        expr_of(span, Type::Text, ExprKind::Interpolation(pieces))
    }

    pub fn name_expr(&mut self, scope: &mut Scope, span: Span, name: Symbol, want: Option<&Type>) -> Expr {
        if want.is_some_and(|w| is_word(w, name)) {
            return expr_of(span, Type::Choice(word_choice(name)), ExprKind::Word(name));
        }
        if let Some((local, ty)) = scope.local(name) {
            return expr_of(span, ty, ExprKind::Local(local));
        }
        if let Some(this) = scope.this
            && let Some(found) = self.own_member(this, span, name, want)
        {
            return found;
        }
        match self.entity(scope.file, name) {
            Some(Entity::Def(id)) => self.def_value(id, span),
            Some(Entity::Error) => error_expr(span),
            Some(Entity::File(_)) => {
                self.report(
                    Diagnostic::error(
                        code::TYPE_MISMATCH,
                        format!("`{name}` is a file of the library, no value"),
                    )
                    .label(span, "a value is wanted here")
                    .hint(format!("name one of its items: `{name}.item`")),
                );
                error_expr(span)
            }
            None => self.unknown_name(scope, span, name, want),
        }
    }

    fn unknown_name(&mut self, scope: &Scope, span: Span, name: Symbol, want: Option<&Type>) -> Expr {
        let choice = want.and_then(choice_of).filter(|c| !c.words.is_empty());
        if let Some(choice) = choice {
            let words: Vec<&str> = choice.words.iter().map(|w| w.as_str()).collect();
            let mut d = Diagnostic::error(code::UNKNOWN_CHOICE, format!("`{name}` is none of the choices"))
                .label(span, format!("one of {} is wanted", words.join(", ")));
            if let Some(near) = suggest(name.as_str(), words) {
                d = d.hint(format!("`{near}`?"));
            }
            self.report(d);
            return error_expr(span);
        }
        let mut names: Vec<&str> = self.visible_names(scope.file);
        names.extend(scope.local_names());
        if let Some(this) = scope.this {
            names.extend(self.member_names(this));
        }
        let mut d = Diagnostic::error(code::UNKNOWN_NAME, format!("`{name}` is not known here"))
            .label(span, "no such name");
        if let Some(near) = suggest(name.as_str(), names) {
            d = d.hint(format!("`{near}`?"));
        } else if is_unit(name.as_str()) {
            d = d.hint(format!("as a unit it sticks to a number: `1{name}`"));
        }
        self.report(d);
        error_expr(span)
    }

    /// A declaration used as a value.
    pub fn def_value(&mut self, id: DefId, span: Span) -> Expr {
        match self.def(id).item {
            DefItem::Let(_) => {
                let ty = self.inferred_type(id, Some(span));
                expr_of(span, ty, ExprKind::Global(id))
            }
            DefItem::Fn(_) | DefItem::Native(_) | DefItem::Method(..) => {
                let signature = self.signature(id);
                if !signature.type_params.is_empty() || signature.params.iter().any(|p| p.variadic) {
                    let name = self.def(id).name;
                    self.report(
                        Diagnostic::error(code::TYPE_MISMATCH, format!("`{name}` must be called here"))
                            .label(span, "takes arguments of several types, so it can't be handed on")
                            .hint(format!("hand on a function of your own: `x => {name}(x)`")),
                    );
                    return error_expr(span);
                }
                let result = self.result_type(id, Some(span));
                let params = signature.params.iter().map(|p| p.ty.clone()).collect();
                expr_of(span, Type::Fn(Arc::new(FnType { params, result })), ExprKind::FnValue(id))
            }
            _ if self.family(id).is_some() => self.default_instance(id, span),
            _ => {
                let name = self.def(id).name;
                self.report(
                    Diagnostic::error(code::TYPE_MISMATCH, format!("`{name}` is no value"))
                        .label(span, "a value is wanted here"),
                );
                error_expr(span)
            }
        }
    }

    /// A type name where an instance is wanted means its instance with all defaults.
    fn default_instance(&mut self, id: DefId, span: Span) -> Expr {
        let signature = self.signature(id);
        let missing: Vec<String> = signature
            .params
            .iter()
            .filter(|p| !p.may_be_left_out())
            .map(|p| format!("`{}`", p.name))
            .collect();
        if !missing.is_empty() {
            let name = self.def(id).name;
            self.report(
                Diagnostic::error(code::ARGUMENTS, format!("`{name}` needs {}", missing.join(", ")))
                    .label(span, "its instance with all defaults is meant, but it has none for these")
                    .label(self.def(id).span, "declared here")
                    .hint(format!("give them: `{name}(...)`")),
            );
            return error_expr(span);
        }
        let args = vec![None; signature.params.len()];
        expr_of(span, Type::Instance(id), ExprKind::Instance { def: id, args })
    }

    fn list(&mut self, scope: &mut Scope, span: Span, items: &'a [ast::Expr], want: Option<&Type>) -> Expr {
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
        expr_of(span, Type::list(common.unwrap_or(Type::Error)), ExprKind::List(out))
    }

    fn comprehension(
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

    /// What a `for` runs over, and the type of what it binds.
    pub fn iterable(&mut self, scope: &mut Scope, e: &'a ast::Expr) -> (Expr, Type) {
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

    fn range(&mut self, scope: &mut Scope, span: Span, from: &'a ast::Expr, to: &'a ast::Expr) -> Expr {
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
        let kind = ExprKind::Range { from: Box::new(a), to: Box::new(b) };
        expr_of(span, Type::Range(Arc::new(element)), kind)
    }

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

    fn index(
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

    pub fn index_of(&mut self, span: Span, object: Expr, index: Expr) -> Expr {
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
            then: Box::new(then),
            otherwise: Some(Box::new(otherwise)),
        };
        expr_of(span, ty, kind)
    }

    fn block(
        &mut self,
        scope: &mut Scope,
        span: Span,
        statements: &'a [ast::Stmt],
        value: Option<&'a ast::Expr>,
        want: Option<&Type>,
    ) -> Expr {
        // A block that is nothing but its value is the value.
        if let (Some(value), []) = (value, statements) {
            return self.expr(scope, value, want);
        }
        let mark = scope.open();
        let statements = self.statements(scope, statements);
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

    /// Names of members, joints and ports of a declaration, for suggestions.
    pub fn member_names(&mut self, id: DefId) -> Vec<&'static str> {
        let members = self.members(id);
        let list = members.list.iter().map(|m| m.name);
        let joints = members.joint_index.keys().copied();
        let ports = members.port_index.keys().copied();
        list.chain(joints).chain(ports).map(|s| s.as_str()).collect()
    }

    /// The family of a type whose values have members.
    pub fn instance_family(&self, ty: &Type) -> Option<Family> {
        match ty {
            Type::Instance(id) => self.family(*id),
            _ => None,
        }
    }
}

fn scaled(value: f64, factors: &[(f64, i32)]) -> f64 {
    factors.iter().fold(value, |value, (factor, power)| {
        let times = power.unsigned_abs();
        (0..times).fold(value, |v, _| if *power > 0 { to_si(v, *factor) } else { v / to_si(1.0, *factor) })
    })
}

fn direction(span: Span, axis: ast::Axis) -> Expr {
    let one = |on: bool| expr_of(span, Type::NUMBER, ExprKind::Number(if on { 1.0 } else { 0.0 }));
    let parts = [ast::Axis::X, ast::Axis::Y, ast::Axis::Z].map(|a| one(a == axis));
    expr_of(span, Type::vec3(Dimension::NUMBER), ExprKind::Vec3(Box::new(parts)))
}

/// The types that a wanted type stands for: itself, what an optional holds, the types of a choice.
fn alternatives(ty: &Type) -> Vec<&Type> {
    match ty {
        Type::Optional(inner) => alternatives(inner),
        Type::Choice(choice) => choice.types.iter().flat_map(alternatives).collect(),
        other => vec![other],
    }
}

fn inner_quantity(want: &Type) -> Option<Dimension> {
    match alternatives(want).as_slice() {
        [one] => one.dimension(),
        _ => None,
    }
}

fn vec3_element(want: &Type) -> Option<&Type> {
    alternatives(want).into_iter().find_map(|t| if let Type::Vec3(e) = t { Some(&**e) } else { None })
}

pub fn list_element(want: &Type) -> Option<&Type> {
    alternatives(want).into_iter().find_map(|t| if let Type::List(e) = t { Some(&**e) } else { None })
}

fn fn_of(want: &Type) -> &Type {
    alternatives(want).into_iter().find(|t| matches!(t, Type::Fn(_))).unwrap_or(want)
}

fn choice_of(want: &Type) -> Option<&super::types::Choice> {
    match want {
        Type::Optional(inner) => choice_of(inner),
        Type::Choice(choice) => Some(choice),
        _ => None,
    }
}

fn is_word(want: &Type, name: Symbol) -> bool {
    choice_of(want).is_some_and(|c| c.words.contains(&name))
}

fn word_choice(name: Symbol) -> Arc<super::types::Choice> {
    Arc::new(super::types::Choice { words: vec![name], types: Vec::new() })
}

/// What a `_` leaves out, as far as it is known.
fn hole_type(want: Option<&Type>) -> Type {
    match want {
        Some(Type::Optional(inner)) => (**inner).clone(),
        _ => Type::Error,
    }
}

/// Whether a type mentions type parameters that are not bound yet.
pub fn has_params(ty: &Type) -> bool {
    match ty {
        Type::Param(_) | Type::QuantityParam { .. } => true,
        Type::List(t)
        | Type::Vec3(t)
        | Type::Range(t)
        | Type::Optional(t)
        | Type::Signal(t)
        | Type::Joint(t) => has_params(t),
        Type::Fn(f) => f.params.iter().any(has_params) || has_params(&f.result),
        Type::Choice(c) => c.types.iter().any(has_params),
        _ => false,
    }
}

/// A mend for a quantity of the wrong dimension, if one is likely.
fn dimension_hint(written: Option<&str>, have: Dimension, need: Dimension) -> Option<String> {
    let written = written?;
    let literal = written.starts_with(|c: char| c.is_ascii_digit());
    if have.over(Dimension::TIME) == Some(need) {
        return Some(if literal {
            format!("per second? `{written}/s`")
        } else {
            format!("per second? `{written} / 1s`")
        });
    }
    if have == Dimension::NUMBER && literal {
        let unit = crate::units::display::usual_unit(need);
        return (!unit.is_empty()).then(|| format!("with a unit? `{written}{unit}`"));
    }
    if need == Dimension::NUMBER && have == Dimension::ANGLE {
        return Some(format!("angles are no plain numbers; divide by a unit to get one: `{written} / 1rad`"));
    }
    None
}
