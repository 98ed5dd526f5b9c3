//! Records: their declarations, their building by name, changed copies, and what of them can be compared.

use super::checker::{Checker, DefItem, Signature};
use super::expr::{Role, error_expr, expr_of};
use super::scope::Scope;
use super::typed::{DefId, DefKind, Expr, ExprKind, RecordBuild, RecordDef, RecordField};
use super::types::Type;
use crate::source::{Diagnostic, Span, code};
use crate::syntax::ast;
use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed body of a `record`, with its fields in order and their defaults; mistakes in them are
    /// reported.
    pub(super) fn check_record(&mut self, id: DefId, record: &'a ast::Record) -> DefKind {
        let signature = self.signature(id);
        let mut scope = Scope::new(self.def(id).file, None);
        let params = self.typed_params(&mut scope, &record.fields, &signature.params, true);
        self.refuse_nothing_to_hold(id);
        let field = |(info, doc): (&super::checker::ParamInfo, &Option<String>)| RecordField {
            name: info.name,
            ty: info.ty.clone(),
            doc: doc.as_deref().map(Arc::from),
        };
        let fields = signature.params.iter().zip(&record.docs).map(field).collect();
        let build = Some(RecordBuild { params, frame: scope.frame() });
        DefKind::Record(RecordDef { is: None, fields, methods: Vec::new(), build })
    }

    /// Reports a record each of whose values would hold another value of the record, without an end.
    fn refuse_nothing_to_hold(&mut self, id: DefId) {
        // A record with the field of the first one through which it was reached.
        let mut waiting: Vec<(DefId, Option<usize>)> = vec![(id, None)];
        let mut known = HashSet::from([id]);
        while let Some((record, first)) = waiting.pop() {
            for (index, param) in self.signature(record).params.iter().enumerate() {
                let Type::Record(held) = param.ty else { continue };
                let first = first.unwrap_or(index);
                if held == id {
                    return self.holds_itself(id, first);
                }
                // Of the records of a circle the first one is reported.
                if held > id && known.insert(held) {
                    waiting.push((held, Some(first)));
                }
            }
        }
    }

    /// Reports a record that holds itself through one of its fields.
    fn holds_itself(&mut self, id: DefId, field: usize) {
        let (name, span) = (self.def(id).name, self.def(id).span);
        let param = &self.signature(id).params[field];
        let ty = self.name(&param.ty);
        let diagnostic = Diagnostic::error(
            code::DECLARATION_CYCLE,
            format!("a `{name}` would hold another `{name}`, without an end"),
        )
        .label(param.span, format!("each `{name}` holds a `{ty}` here"))
        .label(span, "declared here")
        .hint(format!(
            "one that may be missing ends it: `{0}: {ty}?`; so does `{0}: List<{ty}>`",
            param.name
        ));
        self.report(diagnostic);
    }

    /// Returns the typed expression of a call that builds the record `id`, such as `Design(bend: 30deg)`; an error
    /// node of the record's type, after a report, if a field is not given by name.
    pub(super) fn build_record(
        &mut self,
        scope: &mut Scope,
        span: Span,
        id: DefId,
        args: &'a [ast::Arg],
    ) -> Expr {
        let signature = self.signature(id);
        let name = self.def(id).name;
        let Some(unnamed) = args.iter().find(|arg| arg.name.is_none()) else {
            let fields = self.arguments_of(scope, span, name, &signature, args);
            return expr_of(span, Type::Record(id), ExprKind::Record { def: id, fields });
        };
        let message = format!("the fields of `{name}` are given by name");
        let diagnostic = Diagnostic::error(code::ARGUMENTS, message)
            .label(unnamed.value.span, "which field is this?")
            .hint(format!("write `{}`", self.by_name(id, &signature, args)));
        self.report(diagnostic);
        for arg in args {
            self.expr(scope, &arg.value, Some(&Type::Error));
        }
        expr_of(span, Type::Record(id), ExprKind::Error)
    }

    /// Returns a call as it is written by name, the values without a name given to the fields in order.
    fn by_name(&self, id: DefId, signature: &Signature, args: &[ast::Arg]) -> String {
        let given = |i: usize, field| match args.iter().find(|a| a.name.is_some_and(|n| n.text == field)) {
            Some(arg) => Some(arg),
            None => args.get(i).filter(|arg| arg.name.is_none()),
        };
        let field = |(i, param): (usize, &super::checker::ParamInfo)| {
            let value = match given(i, param.name) {
                Some(arg) => self.quoted(arg.value.span).unwrap_or("..."),
                None if param.has_default => return None,
                None => "...",
            };
            Some(format!("{}: {value}", param.name))
        };
        let fields: Vec<String> = signature.params.iter().enumerate().filter_map(field).collect();
        format!("{}({})", self.def(id).name, fields.join(", "))
    }

    /// Returns the typed expression of `object with { field: value }`; an error node, after a report, if the object is
    /// not a record. A field that the record does not have, or that is given twice, is reported; one that it does not
    /// have is left out.
    pub(super) fn with(
        &mut self,
        scope: &mut Scope,
        span: Span,
        object: &'a ast::Expr,
        fields: &'a [ast::Arg],
    ) -> Expr {
        let object = self.expr(scope, object, None);
        let record = match object.ty {
            Type::Record(id) if matches!(self.def(id).item, DefItem::Record(_)) => Some(id),
            _ => None,
        };
        let Some(id) = record else {
            self.no_record(&object);
            for field in fields {
                self.expr(scope, &field.value, Some(&Type::Error));
            }
            return error_expr(span);
        };
        let signature = self.signature(id);
        let mut changed: Vec<(usize, Expr)> = Vec::with_capacity(fields.len());
        for field in fields {
            let named = field.name.expect("the grammar wants a name here");
            let Some(index) = signature.params.iter().position(|p| p.name == named.text) else {
                self.no_parameter(self.def(id).name, named, &signature);
                self.expr(scope, &field.value, Some(&Type::Error));
                continue;
            };
            if changed.iter().any(|(known, _)| *known == index) {
                let message = format!("`{}` is given twice", named.text);
                self.report(
                    Diagnostic::error(code::ARGUMENTS, message).label(field.value.span, "given again here"),
                );
            }
            let ty = &signature.params[index].ty;
            changed.push((index, self.expect(scope, &field.value, ty, Role::Param(named.text))));
        }
        expr_of(span, Type::Record(id), ExprKind::With { object: Box::new(object), fields: changed })
    }

    /// Reports `with` after something that no `record` declares.
    fn no_record(&mut self, object: &Expr) {
        let hint = match &object.ty {
            Type::Error => return,
            Type::Instance(id) => {
                format!("another one is made by its name: `{}(...)`", self.def(*id).name)
            }
            _ => "a record is declared by `record Name { a: Length, b: Angle }`".to_owned(),
        };
        let words = self.words(&object.ty);
        self.report(
            Diagnostic::error(
                code::OPERANDS,
                format!("`with` gives a changed copy of a record, not of {words}"),
            )
            .label(object.span, format!("this is {words}"))
            .hint(hint),
        );
    }

    /// Returns the reason that values of a type can't be compared for equality, as (path of the field, its type): the
    /// path, such as `a.b`, leads to a field of a record, and is empty if the type itself is the reason. `None` if
    /// they can be compared.
    pub(super) fn incomparable(&mut self, ty: &Type) -> Option<(String, Type)> {
        self.incomparable_within(ty, &mut Vec::new())
    }

    fn incomparable_within(&mut self, ty: &Type, known: &mut Vec<DefId>) -> Option<(String, Type)> {
        let id = match ty {
            Type::Opaque(..)
            | Type::Fn(_)
            | Type::Behavior
            | Type::Condition
            | Type::Signal(_)
            | Type::Study(_)
            | Type::Nothing => {
                return Some((String::new(), ty.clone()));
            }
            Type::Record(id) if !known.contains(id) => *id,
            _ => return None,
        };
        known.push(id);
        let signature: Rc<Signature> = self.signature(id);
        signature.params.iter().filter(|_| signature.fields).find_map(|param| {
            let mut inner = &param.ty;
            while let Type::Optional(element) | Type::List(element) = inner {
                inner = element;
            }
            let (path, ty) = self.incomparable_within(inner, known)?;
            let dot = if path.is_empty() { "" } else { "." };
            Some((format!("{}{dot}{path}", param.name), ty))
        })
    }

    /// Returns a hint that names the field for which records of two types can't be compared for equality; `None` if
    /// the reason is not a field, or there is none.
    pub(super) fn incomparable_field(&mut self, a: &Type, b: &Type) -> Option<String> {
        let (path, ty) = self.join(a, b).and_then(|ty| self.incomparable(&ty))?;
        let words = self.words(&ty);
        (!path.is_empty()).then(|| {
            format!("its field `{path}`, {words}, can't be compared: compare other fields one by one")
        })
    }
}
