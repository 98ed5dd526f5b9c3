//! Calls: the callee, and the assignment of arguments to parameters.

use super::bindings::Bindings;
use super::checker::{Checker, DefItem, Entity, ParamInfo, Signature};
use super::expr::{Role, alternatives, error_expr, expr_of, has_params, in_dimensions};
use super::hints::for_other_joints;
use super::lists::list_element;
use super::scope::Scope;
use super::typed::{DefId, Expr, ExprKind};
use super::types::{Choice, Type};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code, foreign};
use crate::syntax::ast;
use std::rc::Rc;
use std::sync::Arc;

/// The resolved callee of a call.
enum Callee {
    /// A function, or a declaration with instances.
    Def(DefId),
    /// A method of a record, with its object.
    Method(DefId, Expr),
    /// A behaviour of a configuration, with its object.
    Behavior(Expr, DefId, usize),
    /// A function value.
    Value(Expr),
    /// An erroneous callee that has been reported.
    Error,
}

impl<'a> Checker<'a> {
    /// Returns the typed expression of a call, written at `span` in `scope`; an error node, after a report, if the
    /// callee is unknown or can't be called. Arguments that are wrong are reported, and are error nodes in the call.
    /// `want`: the type expected of its result, `None` if any will do; it decides between the readings of a built-in
    /// ([`reading`](Self::reading)).
    pub(super) fn call(
        &mut self,
        scope: &mut Scope,
        span: Span,
        callee: &'a ast::Expr,
        args: &'a [ast::Arg],
        want: Option<&Type>,
    ) -> Expr {
        match self.callee(scope, callee) {
            Callee::Def(id) if matches!(self.def(id).item, DefItem::Record(_)) => {
                self.build_record(scope, span, id, args)
            }
            Callee::Def(id) if self.family(id).is_some() => {
                let signature = self.signature(id);
                let name = self.def(id).name;
                let args = self.arguments(scope, span, name, &signature, None, args);
                expr_of(span, Type::Instance(id), ExprKind::Instance { def: id, args: args.0 })
            }
            Callee::Def(id) => self.call_def(scope, span, id, None, args, want),
            Callee::Method(id, object) => self.call_def(scope, span, id, Some(object), args, want),
            Callee::Behavior(object, config, behavior) => {
                let members = self.members(config);
                let signature = members.behaviors[behavior].signature.clone();
                let name = members.behaviors[behavior].ast.name.text;
                let (args, _) = self.arguments(scope, span, name, &signature, None, args);
                let kind = ExprKind::CallBehavior { object: Box::new(object), behavior, args };
                expr_of(span, Type::Behavior, kind)
            }
            Callee::Value(value) => self.call_value(scope, span, value, args),
            Callee::Error => {
                for arg in args {
                    self.expr(scope, &arg.value, Some(&Type::Error));
                }
                error_expr(span)
            }
        }
    }

    /// Resolves a callee.
    fn callee(&mut self, scope: &mut Scope, callee: &'a ast::Expr) -> Callee {
        match &callee.kind {
            ast::ExprKind::Name(name) => self.named_callee(scope, callee.span, *name),
            ast::ExprKind::Field { object, field } => self.field_callee(scope, callee.span, object, *field),
            _ => match self.expr(scope, callee, None) {
                e if e.ty.is_error() => Callee::Error,
                e => Callee::Value(e),
            },
        }
    }

    /// Resolves a callee that is a name.
    fn named_callee(&mut self, scope: &mut Scope, span: Span, name: Symbol) -> Callee {
        if let Some((local, ty)) = scope.local(name) {
            return Callee::Value(expr_of(span, ty, ExprKind::Local(local)));
        }
        if let Some(this) = scope.this {
            let object = expr_of(span, Type::Instance(this), ExprKind::This);
            if let Some(behavior) = self.behavior_index(this, name) {
                return Callee::Behavior(object, this, behavior);
            }
            if let Some(found) = self.own_member(this, span, name, None) {
                return Callee::Value(found);
            }
        }
        match self.named_entity(scope.file, name, span) {
            Some(Entity::Def(id)) => self.def_callee(id, span),
            Some(Entity::Error) => Callee::Error,
            Some(Entity::File(_)) | None => {
                self.name_expr(scope, span, name, None);
                Callee::Error
            }
        }
    }

    /// Returns a declaration as callee; reports one that cannot be called.
    fn def_callee(&mut self, id: DefId, span: Span) -> Callee {
        match self.def(id).item {
            DefItem::Fn(_) | DefItem::Native(_) | DefItem::Method(..) | DefItem::Record(_) => Callee::Def(id),
            _ if self.family(id).is_some() => Callee::Def(id),
            _ => match self.def_value(id, span) {
                e if e.ty.is_error() => Callee::Error,
                e => Callee::Value(e),
            },
        }
    }

    /// Resolves a callee `object.name`.
    fn field_callee(
        &mut self,
        scope: &mut Scope,
        span: Span,
        object: &'a ast::Expr,
        field: ast::Name,
    ) -> Callee {
        if let Some(entity) = self.file_item(scope, object, field) {
            return match entity {
                Entity::Def(id) => self.def_callee(id, span),
                Entity::File(_) | Entity::Error => Callee::Error,
            };
        }
        let object = self.expr(scope, object, None);
        match &object.ty {
            Type::Instance(id) => {
                let id = *id;
                if let Some(behavior) = self.behavior_index(id, field.text) {
                    return Callee::Behavior(object, id, behavior);
                }
            }
            Type::Behavior => {
                if let Some(method) = self.plan_record().and_then(|plan| self.method(plan, field.text)) {
                    return Callee::Method(method, self.planned(object));
                }
            }
            Type::Record(id) => {
                if let Some(method) = self.method(*id, field.text) {
                    return Callee::Method(method, object);
                }
            }
            _ => {}
        }
        match self.field_of(span, object, field, None) {
            e if e.ty.is_error() => Callee::Error,
            e => Callee::Value(e),
        }
    }

    /// Returns the entity of an item of an imported file, as in `gaits.caterpillar`; [`Entity::Error`], after a
    /// report, if the file has no such item. `None` if `object`, in `scope`, is not a name of an imported file.
    pub(super) fn file_item(
        &mut self,
        scope: &mut Scope,
        object: &ast::Expr,
        field: ast::Name,
    ) -> Option<Entity> {
        let ast::ExprKind::Name(name) = &object.kind else { return None };
        if scope.has_local(*name) || scope.this.is_some_and(|t| self.members(t).index.contains_key(name)) {
            return None;
        }
        let file = match self.entity(scope.file, *name)? {
            Entity::File(file) => file,
            _ => return None,
        };
        let path = [ast::Name { text: *name, span: object.span }, field];
        let found = self.path_entity(scope.file, &path);
        if found.is_none() {
            let names: Vec<&str> = self.top(file).keys().map(|s| s.as_str()).collect();
            let mut d = Diagnostic::error(code::UNKNOWN_NAME, format!("`{name}` has no `{}`", field.text))
                .label(field.span, "no such item in this file");
            if let Some(near) = suggest(field.text.as_str(), names) {
                d = d.hint(format!("`{near}`?"));
            }
            self.report(d);
        }
        Some(found.unwrap_or(Entity::Error))
    }

    /// Returns the index of a behaviour of a configuration; `None` if there is none of this name.
    fn behavior_index(&mut self, id: DefId, name: Symbol) -> Option<usize> {
        let DefItem::Config(_) = self.def(id).item else { return None };
        let members = self.members(id);
        members.behaviors.iter().position(|b| b.ast.name.text == name)
    }

    /// Returns a method of a record, inherited ones included; `None` if there is none of this name.
    fn method(&self, record: DefId, name: Symbol) -> Option<DefId> {
        let line = self.record_line(record);
        let found = self.defs.iter().position(|info| {
            info.name == name && matches!(info.item, DefItem::Method(_, owner) if line.contains(&owner))
        });
        found.map(|i| DefId(i as u32))
    }

    /// Checks a call of a declaration.
    fn call_def(
        &mut self,
        scope: &mut Scope,
        span: Span,
        id: DefId,
        object: Option<Expr>,
        args: &'a [ast::Arg],
        want: Option<&Type>,
    ) -> Expr {
        let signature = self.reading(id, want);
        let name = self.def(id).name;
        let (args, bindings) = self.arguments(scope, span, name, &signature, object, args);
        let result = match &signature.result {
            Some(ty) => bindings.apply(ty),
            None => self.result_type(id, Some(span)),
        };
        // A type parameter that no argument binds is inferred from the expected type.
        let result = if has_params(&result) { want.cloned().unwrap_or(Type::Error) } else { result };
        expr_of(span, result, ExprKind::Call { def: id, args })
    }

    /// Returns the signature with which a declaration is called. A built-in may give a value or a signal, as `pose(of:
    /// Port | Module) -> Pose | Signal<Pose>` does: then the signature has the signal if `want` is one, else the value,
    /// and those types of parameters that go with it.
    pub(super) fn reading(&mut self, id: DefId, want: Option<&Type>) -> Rc<Signature> {
        let signature = self.signature(id);
        let either = |ty: &Type| alternatives(ty).len() > 1 && alternatives(ty).into_iter().any(is_signal);
        let native = matches!(self.def(id).item, DefItem::Native(_) | DefItem::Method(..));
        if !native || !signature.result.as_ref().is_some_and(either) {
            return signature;
        }
        let wanted = want.is_some_and(is_signal);
        let read = |ty: &Type| match ty {
            Type::Choice(choice) if either(ty) => {
                let types = choice.types.iter().filter(|ty| is_signal(ty) == wanted).cloned();
                let types: Vec<Type> = types.collect();
                match <[Type; 1]>::try_from(types) {
                    Ok([one]) => one,
                    Err(types) => Type::Choice(Arc::new(Choice { words: choice.words.clone(), types })),
                }
            }
            _ => ty.clone(),
        };
        let param = |param: &ParamInfo| ParamInfo { ty: read(&param.ty), ..param.clone() };
        Rc::new(Signature {
            params: signature.params.iter().map(param).collect(),
            result: signature.result.as_ref().map(read),
            ..(*signature).clone()
        })
    }

    /// Checks a call of a function value.
    fn call_value(&mut self, scope: &mut Scope, span: Span, callee: Expr, args: &'a [ast::Arg]) -> Expr {
        let Type::Fn(f) = callee.ty.clone() else {
            if !callee.ty.is_error() {
                let words = self.words(&callee.ty);
                self.report(
                    Diagnostic::error(code::NOT_CALLABLE, format!("{words} can't be called"))
                        .label(callee.span, "this is no function"),
                );
            }
            for arg in args {
                self.expr(scope, &arg.value, Some(&Type::Error));
            }
            return error_expr(span);
        };
        let mut typed = Vec::new();
        for (i, arg) in args.iter().enumerate() {
            if let Some(name) = arg.name {
                self.report(
                    Diagnostic::error(code::ARGUMENTS, "the parameters of a function value have no names")
                        .label(name.span, "write the argument without its name"),
                );
            }
            typed.push(match f.params.get(i) {
                Some(ty) => self.expect(scope, &arg.value, ty, Role::Place("this argument")),
                None => self.expr(scope, &arg.value, Some(&Type::Error)),
            });
        }
        if args.len() != f.params.len() {
            let need = f.params.len();
            self.report(
                Diagnostic::error(
                    code::ARGUMENTS,
                    format!("this function takes {need} arguments, not {}", args.len()),
                )
                .label(span, format!("{need} arguments are wanted")),
            );
            return error_expr(span);
        }
        let call =
            expr_of(span, f.result.clone(), ExprKind::CallValue { callee: Box::new(callee), args: typed });
        // A function that gives a torque may stand for one that gives an energy, and shows what it gives as its own.
        if !f.result.holds_torques() {
            return call;
        }
        expr_of(span, f.result.clone(), ExprKind::SetDimension(Box::new(call)))
    }

    /// Returns the typed arguments of a call at `span`, in the order of the parameters of `signature`, `None` for one
    /// that is left out. An argument that is wrong or missing is reported, and is an error node; one too many, given
    /// twice or under an unknown name is reported and left out. `name`: that of the function, for messages.
    pub(super) fn arguments_of(
        &mut self,
        scope: &mut Scope,
        span: Span,
        name: Symbol,
        signature: &Rc<Signature>,
        args: &'a [ast::Arg],
    ) -> Vec<Option<Expr>> {
        self.arguments(scope, span, name, signature, None, args).0
    }

    /// Returns (arguments, bindings): the typed arguments in the order of the parameters, and the bindings of the type
    /// parameters. `object`, if given, is the first argument. Reports arguments that are too many, given twice,
    /// misnamed or missing; in place of a missing one stands an error node.
    fn arguments(
        &mut self,
        scope: &mut Scope,
        span: Span,
        name: Symbol,
        signature: &Rc<Signature>,
        object: Option<Expr>,
        args: &'a [ast::Arg],
    ) -> (Vec<Option<Expr>>, Bindings) {
        let params = &signature.params;
        // The arguments so far by parameter, and the next parameter that is filled by position.
        let mut bindings = Bindings::new(&signature.type_params);
        let mut out: Vec<Option<Expr>> = vec![None; params.len()];
        let mut filled = vec![false; params.len()];
        let mut next = 0;
        if let Some(object) = object {
            out[0] = Some(object);
            filled[0] = true;
            next = 1;
        }
        let mut rest: Vec<&'a ast::Expr> = Vec::new();
        let mut lambdas: Vec<(usize, &'a ast::Expr)> = Vec::new();
        // Each argument goes to the parameter of its name, or to the first that has none yet; no others follow a
        // variadic one that is named.
        let (mut misnamed, mut listed) = (false, false);
        for arg in args {
            let index = match arg.name {
                Some(n) => match params.iter().position(|p| p.name == n.text) {
                    Some(index) => index,
                    None => {
                        misnamed = true;
                        self.no_parameter(name, n, signature);
                        self.expr(scope, &arg.value, Some(&Type::Error));
                        continue;
                    }
                },
                None => {
                    let open = |i: usize| !filled[i] || params[i].variadic && !listed;
                    next = (next..params.len()).find(|&i| open(i)).unwrap_or(params.len());
                    if next == params.len() {
                        self.too_many(name, arg, params);
                        self.expr(scope, &arg.value, Some(&Type::Error));
                        continue;
                    }
                    if params[next].variadic {
                        rest.push(&arg.value);
                        filled[next] = true;
                        continue;
                    }
                    next
                }
            };
            if filled[index] {
                self.report(
                    Diagnostic::error(code::ARGUMENTS, format!("`{}` is given twice", params[index].name))
                        .label(arg.value.span, "given again here"),
                );
                self.expr(scope, &arg.value, Some(&Type::Error));
                continue;
            }
            filled[index] = true;
            if params[index].variadic {
                (listed, rest) = (true, vec![&arg.value]);
                continue;
            }
            // The types of a lambda's parameters are known once the other arguments have bound them.
            if matches!(arg.value.kind, ast::ExprKind::Lambda { .. }) && has_params(&params[index].ty) {
                lambdas.push((index, &arg.value));
                continue;
            }
            out[index] = Some(self.argument(scope, name, &arg.value, &params[index], &mut bindings));
        }
        if let Some(variadic) = params.iter().position(|p| p.variadic)
            && out[variadic].is_none()
        {
            out[variadic] = Some(self.variadic(scope, span, &rest, &params[variadic], &mut bindings));
            filled[variadic] = true;
        }
        for (index, lambda) in lambdas {
            out[index] = Some(self.lambda_argument(scope, lambda, &params[index], &mut bindings));
        }
        if !signature.type_params.is_empty() {
            in_bound_dimensions(&mut out, params, &bindings);
        }
        let mut missing = Vec::new();
        // A parameter without default needs an argument.
        for (index, param) in params.iter().enumerate().filter(|(_, p)| !p.may_be_left_out()) {
            if !filled[index] {
                missing.push(format!("`{}`", param.name));
                // A result computed without it is unknown, not an error.
                out[index] = Some(error_expr(span));
            }
        }
        // An argument under an unknown name was most likely meant for the missing parameter.
        if !missing.is_empty() && !misnamed {
            self.report(
                Diagnostic::error(code::ARGUMENTS, format!("`{name}` also needs {}", missing.join(", ")))
                    .label(
                        span,
                        format!(
                            "{} not given",
                            match (missing.len(), signature.fields) {
                                (1, true) => "one field is",
                                (1, false) => "one argument is",
                                (_, true) => "fields are",
                                (_, false) => "arguments are",
                            }
                        ),
                    ),
            );
        }
        (out, bindings)
    }

    /// Reports an argument of `function` whose name is that of no parameter.
    pub(super) fn no_parameter(&mut self, function: Symbol, name: ast::Name, signature: &Signature) {
        let names: Vec<&str> = signature.params.iter().map(|p| p.name.as_str()).collect();
        let what = if signature.fields { "field" } else { "parameter" };
        let mut d = Diagnostic::error(code::ARGUMENTS, format!("`{function}` has no {what} `{}`", name.text))
            .label(name.span, format!("no such {what}"));
        let renamed = foreign::renamed(function.as_str(), name.text.as_str());
        d = match renamed.or_else(|| suggest(name.text.as_str(), names.iter().copied())) {
            Some(new) if renamed.is_some() => d.hint(format!("`{}` is now called `{new}`", name.text)),
            Some(near) => d.hint(format!("`{near}`?")),
            None if names.is_empty() && signature.fields => d.hint(format!("`{function}` has no fields")),
            None if names.is_empty() => d.hint(format!("`{function}` takes no arguments")),
            None if signature.fields => d.hint(format!("its fields are {}", names.join(", "))),
            None => d.hint(format!("it takes {}", names.join(", "))),
        };
        self.report(d);
    }

    /// Reports an argument for which there is no parameter.
    fn too_many(&mut self, function: Symbol, arg: &ast::Arg, params: &[ParamInfo]) {
        let names: Vec<&str> = params.iter().map(|p| p.name.as_str()).collect();
        let d = Diagnostic::error(code::ARGUMENTS, format!("too many arguments for `{function}`"))
            .label(arg.value.span, "there is no parameter for this one");
        self.report(if names.is_empty() { d } else { d.hint(format!("it takes {}", names.join(", "))) });
    }

    /// Checks one argument of a function against the type of its parameter.
    fn argument(
        &mut self,
        scope: &mut Scope,
        function: Symbol,
        e: &'a ast::Expr,
        param: &ParamInfo,
        bindings: &mut Bindings,
    ) -> Expr {
        if !has_params(&param.ty) {
            let got = self.expr(scope, e, Some(&param.ty));
            let hint = for_other_joints(function, &got.ty, &param.ty);
            let known = self.diagnostics.len();
            let got = self.coerce(got, &param.ty, Role::Param(param.name));
            if let (Some(hint), [mismatch]) = (hint, &mut self.diagnostics[known..]) {
                mismatch.hints.push(hint);
            }
            return got;
        }
        let want = bindings.apply(&param.ty);
        let got = self.expr(scope, e, Some(&want));
        self.bind_argument(got, &param.ty, param.name, bindings)
    }

    /// Returns the argument `got` in the dimensions of the type `pattern` of the parameter `name`, and binds the type
    /// parameters in it; an error node, after a report, if it does not fit.
    pub(super) fn bind_argument(
        &mut self,
        got: Expr,
        pattern: &Type,
        name: Symbol,
        bindings: &mut Bindings,
    ) -> Expr {
        if got.ty.is_error() {
            return got;
        }
        if !self.unify(pattern, &got.ty, bindings) {
            let want = bindings.bound_of(bindings.apply(pattern));
            if has_params(&want) || matches!(want, Type::AnyOf(_)) {
                let (need, have) = (self.words(&want), self.words(&got.ty));
                let message = format!("`{name}` wants {need}; this is {have}");
                let mut d = Diagnostic::error(code::TYPE_MISMATCH, message)
                    .label(got.span, format!("this is {have}"));
                if let Some(hint) = self.type_hint(&got, &want) {
                    d = d.hint(hint);
                }
                self.report(d);
                return error_expr(got.span);
            }
            return self.coerce(got, &want, Role::Param(name));
        }
        let want = bindings.apply(pattern);
        if has_params(&want) { got } else { self.coerce(got, &want, Role::Param(name)) }
    }

    /// Returns the list of a variadic parameter: of the remaining arguments, or the one list given.
    fn variadic(
        &mut self,
        scope: &mut Scope,
        span: Span,
        rest: &[&'a ast::Expr],
        param: &ParamInfo,
        bindings: &mut Bindings,
    ) -> Expr {
        let element = &param.ty;
        if let [one] = rest {
            let list = bindings.apply(&Type::list(element.clone()));
            let written_list =
                matches!(one.kind, ast::ExprKind::List(_) | ast::ExprKind::Comprehension { .. });
            let want = if written_list { list } else { bindings.apply(element) };
            let got = self.expr(scope, one, Some(&want));
            let takes_any = *element == Type::Any;
            if got.ty.is_error() {
                return got;
            }
            if let Type::List(_) = &got.ty
                && !takes_any
                && list_element(element).is_none()
            {
                return self.bind_argument(got, &Type::list(element.clone()), param.name, bindings);
            }
            let got = self.bind_argument(got, element, param.name, bindings);
            let ty = Type::list(got.ty.clone());
            return expr_of(span, ty, ExprKind::List(vec![got]));
        }
        let items: Vec<Expr> = rest
            .iter()
            .map(|e| {
                let want = bindings.apply(element);
                let got = self.expr(scope, e, Some(&want));
                self.bind_argument(got, element, param.name, bindings)
            })
            .collect();
        let ty = bindings.apply(element);
        let ty = if has_params(&ty) { Type::Error } else { ty };
        let items = items.into_iter().map(|item| in_dimensions(item, &ty)).collect();
        expr_of(span, Type::List(Arc::new(ty)), ExprKind::List(items))
    }
}

/// Gives the arguments of parameters with type parameters the dimensions that these were bound to in the end: an
/// argument may have been checked before a later one bound them anew.
fn in_bound_dimensions(args: &mut [Option<Expr>], params: &[ParamInfo], bindings: &Bindings) {
    for (arg, param) in args.iter_mut().zip(params).filter(|(_, param)| has_params(&param.ty)) {
        let ty = bindings.apply(&param.ty);
        let ty = if param.variadic { Type::list(ty) } else { ty };
        *arg = arg.take().map(|arg| in_dimensions(arg, &ty));
    }
}

/// Returns true for the type of a signal.
fn is_signal(ty: &Type) -> bool {
    matches!(ty, Type::Signal(_))
}
