//! The meaning of `object.name`: members of instances, fields of records, parts of values.

use super::checker::{Checker, DefItem, Entity, MemberInfoKind};
use super::expr::{error_expr, expr_of};
use super::family::Family;
use super::scope::Scope;
use super::typed::{DefId, Expr, ExprKind, MemberId};
use super::types::{FnType, Type};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code, foreign};
use crate::syntax::ast::{self, ExprKind as K};
use crate::units::Dimension;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed expression of the member, joint or port that a bare name at `span` stands for in the body of
    /// `this`; `None` if it names none. `want`: the expected type, which decides between a joint and a port of one
    /// name.
    pub(super) fn own_member(
        &mut self,
        this: DefId,
        span: Span,
        name: Symbol,
        want: Option<&Type>,
    ) -> Option<Expr> {
        let members = self.members(this);
        let known = members.index.contains_key(&name)
            || members.joint_index.contains_key(&name)
            || members.port_index.contains_key(&name);
        if !known {
            return None;
        }
        let object = expr_of(span, Type::Instance(this), ExprKind::This);
        Some(self.field_of(span, object, ast::Name { text: name, span }, want))
    }

    /// Returns the typed expression of `object.name`, written at `span` in `scope`; an error node, after a report, if
    /// the object is unknown or has no such field, or an imported file no such item. `want`: the expected type, which
    /// decides between a joint and a port of one name.
    pub(super) fn field(
        &mut self,
        scope: &mut Scope,
        span: Span,
        object: &'a ast::Expr,
        field: ast::Name,
        want: Option<&Type>,
    ) -> Expr {
        if let Some(entity) = self.file_item(scope, object, field) {
            return match entity {
                Entity::Def(id) => self.def_value(id, span),
                Entity::File(_) | Entity::Error => error_expr(span),
            };
        }
        // `m.left.joint` and `m.left.port` choose between the two name spaces.
        let chosen = match field.text.as_str() {
            "joint" => Some(Type::joint(Dimension::ANGLE)),
            "port" => Some(Type::Port),
            _ => None,
        };
        if let (Some(chosen), K::Field { object: inner, field: name }) = (chosen, &object.kind) {
            let inner = self.expr(scope, inner, None);
            let want = match &inner.ty {
                Type::Instance(id) if self.family(*id) == Some(Family::Module) => Some(&chosen),
                _ => None,
            };
            let object = self.field_of(object.span, inner, *name, want);
            return self.chosen(span, object, field);
        }
        let object = self.expr(scope, object, None);
        self.field_of(span, object, field, want)
    }

    /// Returns the typed expression of `.joint` or `.port` after `object`, which choose between a joint and a port of
    /// one name: the object itself, if it is already the one or the other, else its field of this name; an error node,
    /// after a report, if it has no such field.
    pub(super) fn chosen(&mut self, span: Span, object: Expr, field: ast::Name) -> Expr {
        match (field.text.as_str(), object.kind) {
            ("joint", kind @ ExprKind::Joint { .. }) | ("port", kind @ ExprKind::Port { .. }) => {
                expr_of(span, object.ty, kind)
            }
            (_, kind) => self.field_of(span, Expr { kind, ..object }, field, None),
        }
    }

    /// Returns the typed expression of a field of a typed object, by the object's type; an error node, after a report,
    /// if it has no such field. `want`: the expected type, which decides between a joint and a port of one name.
    pub(super) fn field_of(
        &mut self,
        span: Span,
        object: Expr,
        field: ast::Name,
        want: Option<&Type>,
    ) -> Expr {
        match object.ty.clone() {
            Type::Error => error_expr(span),
            Type::Instance(id) => self.instance_field(span, object, id, field, want),
            Type::Record(id) => self.record_field(span, object, id, field),
            // A field of a behaviour is that of its plan.
            Type::Behavior if self.plan_record().is_some() => {
                let plan = self.planned(object);
                let record = self.plan_record().expect("just asked");
                self.record_field(span, plan, record, field)
            }
            Type::Vec3(element) if ["x", "y", "z"].contains(&field.text.as_str()) => {
                let kind = ExprKind::Field { object: Box::new(object), field: field.text };
                expr_of(span, (*element).clone(), kind)
            }
            Type::Range(element) if ["from", "to"].contains(&field.text.as_str()) => {
                let kind = ExprKind::Field { object: Box::new(object), field: field.text };
                expr_of(span, (*element).clone(), kind)
            }
            Type::Port if field.text == "joint" => {
                expr_of(span, Type::joint(Dimension::ANGLE), ExprKind::Hinge(Box::new(object)))
            }
            Type::Pose if field.text == "position" => {
                let kind = ExprKind::Field { object: Box::new(object), field: field.text };
                expr_of(span, Type::vec3(Dimension::LENGTH), kind)
            }
            other => {
                let words = self.words(&other);
                let mut d =
                    Diagnostic::error(code::UNKNOWN_MEMBER, format!("{words} has no `{}`", field.text))
                        .label(field.span, "no such field");
                if let Type::List(_) = other {
                    d = d.hint(match field.text.as_str() {
                        "append" | "push" | "add" | "extend" | "insert" => {
                            "lists are joined: `list ++ [element]`"
                        }
                        "len" | "length" | "size" | "count" => "write `len(list)`",
                        _ => "name one element: `[0]`",
                    });
                } else if let Type::AnyOf(_) = other {
                    d = d.hint("which declaration it is an instance of is not known here");
                }
                self.report(d);
                error_expr(span)
            }
        }
    }

    /// Returns a member, joint or port of an instance.
    fn instance_field(
        &mut self,
        span: Span,
        object: Expr,
        id: DefId,
        field: ast::Name,
        want: Option<&Type>,
    ) -> Expr {
        let members = self.members(id);
        let joint = members.joint_index.get(&field.text).copied();
        let port = members.port_index.get(&field.text).copied();
        let wants_joint = want.is_some_and(|w| wants(w, |t| matches!(t, Type::Joint(_))));
        let wants_port = want.is_some_and(|w| wants(w, |t| *t == Type::Port));
        let object = Box::new(object);
        match (joint, port) {
            (Some(_), Some(_)) if wants_joint == wants_port => {
                let (joint, port) = (
                    members.joints[joint.expect("matched")].span,
                    members.ports[port.expect("matched")].span,
                );
                self.report(
                    Diagnostic::error(
                        code::AMBIGUOUS_MEMBER,
                        format!("`{}` is both a joint and a port", field.text),
                    )
                    .label(field.span, "which one is meant?")
                    .label(joint, "the joint")
                    .label(port, "the port")
                    .hint(format!("`.{0}.joint` or `.{0}.port`", field.text)),
                );
                error_expr(span)
            }
            (Some(joint), port) if port.is_none() || wants_joint => {
                let ty = Type::joint(members.joints[joint].dimension);
                expr_of(span, ty, ExprKind::Joint { object, joint })
            }
            (_, Some(port)) => {
                let ty = if members.ports[port].array { Type::list(Type::Port) } else { Type::Port };
                expr_of(span, ty, ExprKind::Port { object, port })
            }
            _ => match members.index.get(&field.text).copied() {
                Some(member) => self.member_expr(span, object, id, member),
                None => self.unknown_member(span, id, field),
            },
        }
    }

    /// Returns a member of an instance as an expression.
    fn member_expr(&mut self, span: Span, object: Box<Expr>, id: DefId, member: MemberId) -> Expr {
        let members = self.members(id);
        if let MemberInfoKind::Behavior(behavior) = members.list[member.0 as usize].kind {
            let params = members.behaviors[behavior].signature.params.iter().map(|p| p.ty.clone()).collect();
            let ty = Type::Fn(Arc::new(FnType { params, result: Type::Behavior }));
            return expr_of(span, ty, ExprKind::BehaviorValue { object, behavior });
        }
        let ty = self.member_type(id, member, Some(span));
        expr_of(span, ty, ExprKind::Member { object, member })
    }

    /// Reports an unknown member.
    fn unknown_member(&mut self, span: Span, id: DefId, field: ast::Name) -> Expr {
        if self.is_unread(field.text) {
            return error_expr(span);
        }
        let what = match self.family(id) {
            Some(Family::Module) => "joint, port or parameter",
            Some(Family::Config) if self.is_scene(id) => "part, obstacle, port or behavior",
            Some(Family::Config) => "part, port or behavior",
            _ => "member",
        };
        let names = self.member_names(id);
        let near = suggest(field.text.as_str(), names);
        let name = self.def(id).name;
        let mut d = Diagnostic::error(code::UNKNOWN_MEMBER, format!("no {what} `{}` in {name}", field.text))
            .label(field.span, format!("{name} has none of this name"));
        if let Some(new) = foreign::renamed(name.as_str(), field.text.as_str()) {
            d = d.hint(format!("`{}` is now called `{new}`", field.text));
        } else if let Some(near) = near {
            d = d.hint(format!("`{near}`?"));
        }
        self.report(d);
        error_expr(span)
    }

    /// Returns a field of a record, inherited ones included; reports an unknown one.
    fn record_field(&mut self, span: Span, object: Expr, id: DefId, field: ast::Name) -> Expr {
        for record in self.record_line(id) {
            if let Some(ty) = self.field_type(record, field.text) {
                let kind = ExprKind::Field { object: Box::new(object), field: field.text };
                return expr_of(span, ty, kind);
            }
        }
        let name = self.def(id).name;
        let names = self.record_names(id);
        let mut d = Diagnostic::error(code::UNKNOWN_MEMBER, format!("a {name} has no `{}`", field.text))
            .label(field.span, "no such field");
        if let Some(new) = foreign::renamed(name.as_str(), field.text.as_str()) {
            d = d.hint(format!("`{}` is now called `{new}`", field.text));
        } else if let Some(near) = suggest(field.text.as_str(), names) {
            d = d.hint(format!("`{near}`?"));
        }
        self.report(d);
        error_expr(span)
    }

    /// Returns the type of a field that a record itself declares; `None` if it has none of this name.
    fn field_type(&mut self, record: DefId, field: Symbol) -> Option<Type> {
        match self.def(record).item {
            DefItem::Record(_) => {
                let signature = self.signature(record);
                signature.params.iter().find(|p| p.name == field).map(|p| p.ty.clone())
            }
            DefItem::ExternType(ast) => {
                let found = ast.fields.iter().find(|f| f.name.text == field)?;
                let scope = Scope::new(self.def(record).file, None);
                Some(self.type_expr(&scope, &found.ty))
            }
            _ => None,
        }
    }

    /// Returns the prelude's record `Plan`; `None` if the prelude could not be read.
    pub(super) fn plan_record(&self) -> Option<DefId> {
        self.prelude_def("plan").and(self.prelude_def("Plan"))
    }

    /// Returns the expression `plan(behavior)` of the record type `Plan`, as for a plan's field that is read from a
    /// behaviour. Panics if the prelude could not be read; [`Checker::plan_record`] tells.
    pub(super) fn planned(&mut self, behavior: Expr) -> Expr {
        let def = self.prelude_def("plan").expect("the prelude declares what its record comes from");
        let record = self.prelude_def("Plan").expect("the prelude declares what `plan` gives");
        let mut args = vec![None; self.signature(def).params.len()];
        let span = behavior.span;
        args[0] = Some(behavior);
        expr_of(span, Type::Record(record), ExprKind::Call { def, args })
    }

    /// Returns the names of the fields and methods of a record, for suggestions.
    fn record_names(&self, id: DefId) -> Vec<&'static str> {
        let mut names = Vec::new();
        for record in self.record_line(id) {
            match self.def(record).item {
                DefItem::Record(ast) => names.extend(ast.fields.iter().map(|f| f.name.text.as_str())),
                DefItem::ExternType(ast) => {
                    names.extend(ast.fields.iter().map(|f| f.name.text.as_str()));
                    names.extend(ast.methods.iter().map(|(_, m)| m.name.text.as_str()));
                }
                _ => {}
            }
        }
        names
    }
}

/// Returns true if an expected type, or one of its alternatives or elements, is of a kind.
fn wants(want: &Type, kind: fn(&Type) -> bool) -> bool {
    match want {
        Type::Optional(t) | Type::List(t) => wants(t, kind),
        Type::Choice(c) => c.types.iter().any(|t| wants(t, kind)),
        other => kind(other),
    }
}
