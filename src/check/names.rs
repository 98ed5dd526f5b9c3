//! Names as values: locals, members, declarations.

use super::checker::{Checker, DefItem, Entity};
use super::expr::{error_expr, expr_of, has_params};
use super::scope::Scope;
use super::typed::{DefId, Expr, ExprKind};
use super::types::{FnType, Type};
use crate::source::foreign;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::units::is_unit;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed expression of a name used as a value, written at `span`; an error node, after a report, if
    /// the name is unknown or that of a file, or the declaration that it names is not a value. The name stands for the
    /// first of: a word of the choice `want`, a local of `scope`, a member of the body in `scope`, a declaration that
    /// the file sees. `want` is the expected type, `None` if any will do.
    pub(super) fn name_expr(
        &mut self,
        scope: &mut Scope,
        span: Span,
        name: Symbol,
        want: Option<&Type>,
    ) -> Expr {
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
        match self.named_entity(scope.file, name, span) {
            Some(Entity::Def(id)) => self.def_value(id, span),
            Some(Entity::Error) => error_expr(span),
            Some(Entity::File(_)) => {
                self.report(
                    Diagnostic::error(code::TYPE_MISMATCH, format!("`{name}` is a file, no value"))
                        .label(span, "a value is wanted here")
                        .hint(format!("name one of its items: `{name}.item`")),
                );
                error_expr(span)
            }
            None => self.unknown_name(scope, span, name, want),
        }
    }

    /// Returns the name of the declaration that `_` stands for in a session, that of the last value; `None` where an
    /// optional value is expected, and if there is no value before.
    pub(super) fn last_value(&self, scope: &Scope, want: Option<&Type>) -> Option<Symbol> {
        let may_miss = matches!(want, Some(Type::Optional(_)));
        self.loaded.files[scope.file].last.filter(|_| !may_miss)
    }

    /// Returns the typed expression of `_`, written at `span`: the last value of a session, or the missing value if
    /// `want`, the expected type, is optional; an error node, after a report, if it is neither.
    pub(super) fn hole(&mut self, scope: &mut Scope, span: Span, want: Option<&Type>) -> Expr {
        if let Some(name) = self.last_value(scope, want) {
            return self.name_expr(scope, span, name, want);
        }
        match want {
            // Nothing is known of the value that is missing where its type is still to be bound.
            Some(missing @ Type::Optional(_)) if has_params(missing) => {
                expr_of(span, Type::Optional(Arc::new(Type::Error)), ExprKind::Missing)
            }
            Some(missing @ Type::Optional(_)) => expr_of(span, missing.clone(), ExprKind::Missing),
            Some(Type::Error) => error_expr(span),
            _ => {
                let diagnostic = Diagnostic::error(code::UNKNOWN_NAME, "`_` has no value here")
                    .label(span, "nothing may be left out")
                    .hint(
                        "`_` is what is left out where a type ends in `?`, and in a session the last value",
                    );
                self.report(diagnostic);
                error_expr(span)
            }
        }
    }

    /// Reports an unknown name, with suggestions, and returns the error node for it: as an unknown word if `want`, the
    /// expected type, is a choice with words; without a report if `want` is [`Type::Error`], since the name may then
    /// be a word.
    pub(super) fn unknown_name(
        &mut self,
        scope: &Scope,
        span: Span,
        name: Symbol,
        want: Option<&Type>,
    ) -> Expr {
        // The expected type is unknown, so the name may be a word of a choice.
        if want.is_some_and(Type::is_error) {
            return error_expr(span);
        }
        if self.state_elsewhere(scope, name, span) {
            return error_expr(span);
        }
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
        if let Some(instead) = foreign::instead(name.as_str()) {
            d = d.hint(instead);
        } else if let Some(import) = self.import_hint(scope.file, name) {
            d = d.hint(import);
        } else if let Some(near) = suggest(name.as_str(), names) {
            d = d.hint(format!("`{near}`?"));
        } else if is_unit(name.as_str()) {
            d = d.hint(format!("as a unit it sticks to a number: `1{name}`"));
        }
        self.report(d);
        error_expr(span)
    }

    /// Returns the path of another file of the program that declares a public name, if both that file and `file` (an
    /// index into the loaded files) are at the top of the project; otherwise `None`.
    pub(super) fn declared_elsewhere(&self, file: usize, name: Symbol) -> Option<String> {
        let public = !name.as_str().starts_with('_');
        let own = |other: usize| match self.top(other).get(&name) {
            Some(Entity::Def(id)) => self.def(*id).file == other,
            _ => false,
        };
        let path = |file: usize| {
            let text = self.sources.file(self.loaded.files[file].ast.id);
            (!text.library).then(|| text.name.to_string())
        };
        // The path to a file in another folder is not suggested.
        let beside = |path: &String| path.ends_with(".mod") && !path.contains('/');
        let here = path(file).is_some_and(|path| !path.contains('/'));
        let mut others = (0..self.loaded.files.len()).filter(|&other| other != file && public && here);
        others.find_map(|other| own(other).then(|| path(other)).flatten().filter(beside))
    }

    /// Returns the typed expression of a declaration used as a value, by its name at `span`; an error node, after a
    /// report, if the declaration is not a value, must be called, or has parameters without default.
    pub(super) fn def_value(&mut self, id: DefId, span: Span) -> Expr {
        match self.def(id).item {
            DefItem::Let(_) => {
                let ty = self.inferred_type(id, Some(span));
                expr_of(span, ty, ExprKind::Global(id))
            }
            DefItem::Fn(_) | DefItem::Native(_) | DefItem::Method(..) => {
                let signature = self.reading(id, None);
                if !signature.type_params.is_empty() || signature.params.iter().any(|p| p.variadic) {
                    let name = self.def(id).name;
                    self.report(
                        Diagnostic::error(code::TYPE_MISMATCH, format!("`{name}` must be called here"))
                            .label(span, "takes arguments of several types, so it can't be handed on")
                            .hint(format!("hand on a function of your own: `x => {name}(x)`")),
                    );
                    return error_expr(span);
                }
                let result = match &signature.result {
                    Some(result) => result.clone(),
                    None => self.result_type(id, Some(span)),
                };
                let params = signature.params.iter().map(|p| p.ty.clone()).collect();
                expr_of(span, Type::Fn(Arc::new(FnType { params, result })), ExprKind::FnValue(id))
            }
            DefItem::Study(_) => self.study_value(id, span),
            DefItem::Record(_) => self.default_instance(id, span),
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

    /// Returns the typed expression of the instance with all defaults, for the name of a type at `span`; an error
    /// node, after a report, if a parameter has no default.
    pub(super) fn default_instance(&mut self, id: DefId, span: Span) -> Expr {
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
        if signature.fields {
            return expr_of(span, Type::Record(id), ExprKind::Record { def: id, fields: args });
        }
        expr_of(span, Type::Instance(id), ExprKind::Instance { def: id, args })
    }

    /// Returns the names of members, joints and ports of a declaration, aliases included, in no order, for
    /// suggestions.
    pub(super) fn member_names(&mut self, id: DefId) -> Vec<&'static str> {
        let members = self.members(id);
        let list = members.list.iter().map(|m| m.name);
        let joints = members.joint_index.keys().copied();
        let ports = members.port_index.keys().copied();
        list.chain(joints).chain(ports).map(|s| s.as_str()).collect()
    }
}

/// Returns the choice that an expected type is, or is an optional one of; `None` if it is none.
pub(super) fn choice_of(want: &Type) -> Option<&super::types::Choice> {
    match want {
        Type::Optional(inner) => choice_of(inner),
        Type::Choice(choice) => Some(choice),
        _ => None,
    }
}

/// Returns true if a name is a word of the expected choice.
pub(super) fn is_word(want: &Type, name: Symbol) -> bool {
    choice_of(want).is_some_and(|c| c.words.contains(&name))
}

/// Returns the choice whose only alternative is one word.
pub(super) fn word_choice(name: Symbol) -> Arc<super::types::Choice> {
    Arc::new(super::types::Choice { words: vec![name], types: Vec::new() })
}
