//! Items and statements: signatures and bodies, each checked when first needed.

use super::bindings::Bindings;
use super::checker::{Checker, DefItem, ParamInfo, Signature};
use super::expr::{Role, error_expr};
use super::scope::Scope;
use super::typed::{
    Body, DefId, DefKind, Expr, FnDef, LetDef, MemberId, NativeDef, Param, RecordDef, RecordField, Stmt,
    StmtKind, Test,
};
use super::types::Type;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use std::rc::Rc;
use std::sync::Arc;

/// The longest chain of declarations whose inferred types need each other.
const DECLARATION_CHAIN_MAX: usize = 1_000;

/// The stack that must be left for the deepest expression of one declaration, in bytes.
const STACK_LEFT_MIN: usize = 1 << 20;
/// The stack that is added when less is left, in bytes.
const STACK_PIECE: usize = 8 << 20;

impl<'a> Checker<'a> {
    /// Returns the signature of a declaration, computed at the first call. Mistakes in it are reported then, with
    /// [`Type::Error`] for a type that is wrong.
    pub(super) fn signature(&mut self, id: DefId) -> Rc<Signature> {
        if let Some(signature) = &self.def(id).signature {
            return signature.clone();
        }
        let mut scope = Scope::new(self.def(id).file, None);
        let signature = match self.def(id).item {
            DefItem::Fn(f) => {
                scope.type_params = self.type_params(&f.type_params);
                Signature {
                    params: self.params(&scope, &f.params),
                    result: match &f.result {
                        Some(ty) => Some(self.type_expr(&scope, ty)),
                        // It is reported where the body is checked, from which it can't be told for a call.
                        None => (!f.type_params.is_empty()).then_some(Type::Error),
                    },
                    type_params: scope.type_params,
                    fields: false,
                }
            }
            DefItem::Record(x) => {
                Signature { params: self.params(&scope, &x.fields), fields: true, ..Signature::default() }
            }
            DefItem::Native(f) => self.native_signature(&mut scope, f, None),
            DefItem::Method(f, record) => self.native_signature(&mut scope, f, Some(record)),
            item => {
                let params: &'a [ast::Param] = match item {
                    DefItem::Module(x) => &x.params,
                    DefItem::Facts(x) => &x.params,
                    DefItem::Config(x) => &x.params,
                    DefItem::Lattice(x) => &x.params,
                    DefItem::Truss(x) => &x.params,
                    _ => &[],
                };
                Signature { params: self.params(&scope, params), ..Signature::default() }
            }
        };
        let signature = Rc::new(signature);
        self.def_mut(id).signature = Some(signature.clone());
        signature
    }

    /// Returns the signature of an `extern fn`; a method's object is its first parameter.
    fn native_signature(
        &mut self,
        scope: &mut Scope,
        f: &'a ast::ExternFn,
        record: Option<DefId>,
    ) -> Signature {
        scope.type_params = self.type_params(&f.type_params);
        let mut params = Vec::new();
        if let Some(record) = record {
            params.push(ParamInfo {
                name: Symbol::new("self"),
                span: f.name.span,
                ty: Type::Record(record),
                has_default: false,
                variadic: false,
            });
        }
        params.extend(self.params(scope, &f.params));
        let result = f.result.as_ref().map_or(Type::Nothing, |ty| self.type_expr(scope, ty));
        let type_params = scope.type_params.clone();
        Signature { params, result: Some(result), type_params, fields: false }
    }

    /// Returns the parameters of a signature, whose types are resolved in `scope`. Names given twice are reported, and
    /// so are unknown types, which become [`Type::Error`].
    pub(super) fn params(&mut self, scope: &Scope, params: &'a [ast::Param]) -> Vec<ParamInfo> {
        let mut seen: Vec<(Symbol, Span)> = Vec::new();
        params
            .iter()
            .map(|p| {
                if let Some((_, first)) = seen.iter().find(|(name, _)| *name == p.name.text) {
                    let first = *first;
                    self.declared_twice(p.name.text, first, p.name.span);
                }
                seen.push((p.name.text, p.name.span));
                ParamInfo {
                    name: p.name.text,
                    span: p.name.span,
                    ty: self.type_expr(scope, &p.ty),
                    has_default: p.default.is_some(),
                    variadic: p.variadic,
                }
            })
            .collect()
    }

    /// Returns the parameters `infos` with their defaults, written in `asts`, as typed expressions; an error node,
    /// after a report, for a default that is wrong. `infos` may begin with others that have no default, as a method's
    /// does with its object. If `bind` is true, each parameter is bound as a local in `scope`, for a body without
    /// members.
    pub(super) fn typed_params(
        &mut self,
        scope: &mut Scope,
        asts: &'a [ast::Param],
        infos: &[ParamInfo],
        bind: bool,
    ) -> Vec<Param> {
        let own = infos.len() - asts.len();
        let mut out = Vec::with_capacity(infos.len());
        for (i, info) in infos.iter().enumerate() {
            let default = i.checked_sub(own).and_then(|i| asts[i].default.as_ref());
            let default = default.map(|e| self.expect(scope, e, &info.ty, Role::Param(info.name)));
            if bind {
                let ty = if info.variadic { Type::list(info.ty.clone()) } else { info.ty.clone() };
                scope.bind(info.name, ty);
            }
            self.lint_snake(info.name, info.span, "parameters and fields");
            let (name, span, ty, variadic) = (info.name, info.span, info.ty.clone(), info.variadic);
            out.push(Param { name, span, ty, default, variadic });
        }
        out
    }

    /// Returns the type of a top-level `let`; declared or inferred from its value. `at` is the span that needs it,
    /// `None` if no other declaration does. A declaration that needs itself is reported and has [`Type::Error`].
    pub(super) fn inferred_type(&mut self, id: DefId, at: Option<Span>) -> Type {
        if let DefItem::Let(ast::Let { ty: Some(ty), .. }) = self.def(id).item {
            let scope = Scope::new(self.def(id).file, None);
            if self.def(id).inferred.is_none() {
                let ty = self.type_expr(&scope, ty);
                self.def_mut(id).inferred = Some(ty);
            }
            return self.def(id).inferred.clone().expect("just set");
        }
        self.inferred_by_body(id, at)
    }

    /// Returns the result type of a function; declared or inferred from its body. `at` is the span that needs it,
    /// `None` if no other declaration does. A function that needs itself is reported and has [`Type::Error`].
    pub(super) fn result_type(&mut self, id: DefId, at: Option<Span>) -> Type {
        match self.signature(id).result.clone() {
            Some(ty) => ty,
            None => self.inferred_by_body(id, at),
        }
    }

    /// Returns a type inferred from a body; reports a cycle of inferred types.
    fn inferred_by_body(&mut self, id: DefId, at: Option<Span>) -> Type {
        if let Some(ty) = &self.def(id).inferred {
            return ty.clone();
        }
        if self.def(id).busy {
            let (name, span) = (self.def(id).name, self.def(id).span);
            if let DefItem::Fn(_) = self.def(id).item {
                self.report(
                    Diagnostic::error(
                        code::CANNOT_INFER,
                        format!("the result of `{name}` can't be told from itself"),
                    )
                    .label(at.unwrap_or(span), "called here while its result is being worked out")
                    .label(span, "declared here")
                    .hint("write its result: `-> Type` behind the parameters"),
                );
            } else {
                self.declaration_cycle(name, span, at);
            }
            // Reported once; the other declarations on the cycle stay silent.
            self.def_mut(id).inferred = Some(Type::Error);
            return Type::Error;
        }
        if self.open_declarations >= DECLARATION_CHAIN_MAX {
            let span = at.unwrap_or(self.def(id).span);
            let message = format!("more than {DECLARATION_CHAIN_MAX} declarations need each other in a row");
            self.report(
                Diagnostic::error(code::TOO_DEEP, message)
                    .label(span, "needed here")
                    .hint("write the type of one of them: `let a: Length = ...`"),
            );
            self.def_mut(id).inferred = Some(Type::Error);
            return Type::Error;
        }
        self.check_def(id);
        self.def(id).inferred.clone().unwrap_or(Type::Error)
    }

    /// Checks the body of a declaration, once: does nothing if that is done, or going on.
    pub(super) fn check_def(&mut self, id: DefId) {
        if self.def(id).typed.is_some() || self.def(id).busy {
            return;
        }
        self.def_mut(id).busy = true;
        self.open_declarations += 1;
        let kind = stacker::maybe_grow(STACK_LEFT_MIN, STACK_PIECE, || self.typed_def(id));
        self.open_declarations -= 1;
        self.lint_def(id);
        let info = self.def_mut(id);
        info.typed = Some(kind);
        info.busy = false;
    }

    /// Checks the body of a declaration by its kind.
    fn typed_def(&mut self, id: DefId) -> DefKind {
        match self.def(id).item {
            DefItem::Let(x) => self.check_let(id, x),
            DefItem::Fn(x) => self.check_fn(id, x),
            DefItem::Native(x) => self.check_native(id, x, None),
            DefItem::Method(x, record) => self.check_native(id, x, Some(record)),
            DefItem::Record(x) => self.check_record(id, x),
            DefItem::ExternType(x) => self.check_extern_type(id, x),
            DefItem::Connector(x) => self.check_connector(id, x),
            DefItem::Module(x) => self.check_module(id, x),
            DefItem::Facts(x) => self.check_facts(id, x),
            DefItem::Config(x) => self.check_config(id, x),
            DefItem::Lattice(x) => self.check_lattice(id, x),
            DefItem::Truss(x) => self.check_truss(id, x),
            DefItem::Study(x) => self.check_study(id, x),
            DefItem::Vacant => DefKind::Error,
        }
    }

    /// Checks a top-level `let`.
    fn check_let(&mut self, id: DefId, x: &'a ast::Let) -> DefKind {
        let mut scope = Scope::new(self.def(id).file, None);
        let written = x.ty.as_ref().map(|_| self.inferred_type(id, None));
        let value = self.value_of_type(&mut scope, x, written);
        let ty = value.ty.clone();
        let info = self.def_mut(id);
        let ty = info.inferred.get_or_insert(ty).clone();
        DefKind::Let(LetDef { ty, value, frame: scope.frame() })
    }

    /// Returns the typed value of a `let`, converted to its declared type if it has one; an error node, after a
    /// report, if the value has a mistake or does not fit.
    pub(super) fn let_value(&mut self, scope: &mut Scope, x: &'a ast::Let) -> Expr {
        let written = x.ty.as_ref().map(|ty| self.type_expr(scope, ty));
        self.value_of_type(scope, x, written)
    }

    /// Checks the value of a `let` of a known or inferred type.
    fn value_of_type(&mut self, scope: &mut Scope, x: &'a ast::Let, written: Option<Type>) -> Expr {
        let value = match written {
            Some(ty) => {
                let mut value = self.expect(scope, &x.value, &ty, Role::Param(x.name.text));
                if !value.ty.is_error() {
                    value.ty = ty;
                }
                value
            }
            None => self.expr(scope, &x.value, None),
        };
        if value.ty == Type::Nothing {
            self.report(
                Diagnostic::error(code::TYPE_MISMATCH, format!("`{}` would have no value", x.name.text))
                    .label(value.span, "this gives nothing"),
            );
            return error_expr(value.span);
        }
        if x.ty.is_none() && !value.ty.is_error() {
            self.lets.push((x.name.span, value.ty.clone()));
        }
        value
    }

    /// Checks a `fn`.
    fn check_fn(&mut self, id: DefId, f: &'a ast::Fn) -> DefKind {
        let signature = self.signature(id);
        let mut scope = Scope::new(self.def(id).file, None);
        self.check_type_params(f, &signature);
        (scope.type_params, scope.in_body) = (signature.type_params.clone(), true);
        let own = Bindings::opaque(&signature.type_params);
        let in_body = |p: &ParamInfo| ParamInfo { ty: own.apply(&p.ty), ..p.clone() };
        let infos: Vec<ParamInfo> = signature.params.iter().map(in_body).collect();
        let params = self.typed_params(&mut scope, &f.params, &infos, true);
        let result = signature.result.as_ref().map(|ty| own.apply(ty));
        let body = match &result {
            Some(ty) => self.expect(&mut scope, &f.body, ty, Role::Place("the result")),
            None => self.expr(&mut scope, &f.body, None),
        };
        let result = result.unwrap_or_else(|| body.ty.clone());
        let inferred = &mut self.def_mut(id).inferred;
        inferred.get_or_insert_with(|| result.clone());
        DefKind::Fn(FnDef { params, result, body, frame: scope.frame() })
    }

    /// Checks an `extern fn`, or a method of `record`.
    fn check_native(&mut self, id: DefId, f: &'a ast::ExternFn, record: Option<DefId>) -> DefKind {
        self.only_in_library(id, "extern fn");
        let signature = self.signature(id);
        let mut scope = Scope::new(self.def(id).file, None);
        scope.type_params = signature.type_params.clone();
        let params = self.typed_params(&mut scope, &f.params, &signature.params, true);
        let key = match record {
            Some(record) => Symbol::new(&format!("{}.{}", self.def(record).name, f.name.text)),
            None => f.name.text,
        };
        DefKind::Native(NativeDef {
            key,
            params,
            result: signature.result.clone().expect("declared"),
            type_params: signature.type_params.iter().map(|p| p.name).collect(),
            frame: scope.frame(),
        })
    }

    /// Checks an `extern type`.
    fn check_extern_type(&mut self, id: DefId, record: &'a ast::ExternType) -> DefKind {
        self.only_in_library(id, "extern type");
        let scope = Scope::new(self.def(id).file, None);
        let fields = record
            .fields
            .iter()
            .map(|f| RecordField {
                name: f.name.text,
                ty: self.type_expr(&scope, &f.ty),
                doc: f.doc.as_deref().map(Arc::from),
            })
            .collect();
        let owned = |(i, info): (usize, &super::checker::DefInfo)| {
            matches!(info.item, DefItem::Method(_, owner) if owner == id).then_some(DefId(i as u32))
        };
        let methods = self.defs.iter().enumerate().filter_map(owned).collect();
        let is = self.record_line(id).get(1).copied();
        DefKind::Record(RecordDef { is, fields, methods, build: None })
    }

    /// Reports a declaration that only the standard library may have.
    fn only_in_library(&mut self, id: DefId, what: &str) {
        let info = self.def(id);
        let span = info.span;
        if !self.sources.file(span.file).library {
            self.report(
                Diagnostic::error(code::SYNTAX, format!("`{what}` is for the standard library"))
                    .label(span, "nothing supplies this one")
                    .hint("a function of your own has a body: `fn name(...) = ...`"),
            );
        }
    }

    /// Returns the typed statements that can be run, in order, checked in the current scope; mistakes are reported,
    /// and error nodes stand for expressions that are wrong.
    pub(super) fn statements(&mut self, scope: &mut Scope, statements: &'a [ast::Stmt]) -> Vec<Stmt> {
        let mark = scope.open();
        statements.iter().filter_map(|s| self.statement(scope, mark, s)).collect()
    }

    /// Checks a statement; `mark` is that of the block it is in. `None` for an unreadable one.
    fn statement(&mut self, scope: &mut Scope, mark: (usize, u32), s: &'a ast::Stmt) -> Option<Stmt> {
        // Statements within this one are not in the block itself.
        let own = std::mem::take(&mut scope.contracts);
        let kind = self.statement_kind(scope, mark, s, own);
        scope.contracts = own;
        Some(Stmt { span: s.span, kind: kind? })
    }

    /// Checks a statement by its kind. `own`: true in a behaviour's own block.
    fn statement_kind(
        &mut self,
        scope: &mut Scope,
        mark: (usize, u32),
        s: &'a ast::Stmt,
        own: bool,
    ) -> Option<StmtKind> {
        use ast::StmtKind as K;
        Some(match &s.kind {
            K::Error => return None,
            K::Let(x) => {
                let value = self.let_value(scope, x);
                if scope.bound_since(mark, x.name.text) {
                    self.report(
                        Diagnostic::error(
                            code::DECLARED_TWICE,
                            format!("`{}` is declared twice", x.name.text),
                        )
                        .label(x.name.span, "declared again in the same block"),
                    );
                }
                self.lint_snake(x.name.text, x.name.span, "variables");
                StmtKind::Let { local: scope.bind(x.name.text, value.ty.clone()), value }
            }
            K::Expr(e) => StmtKind::Expr(self.expr(scope, e, None)),
            K::Expect { condition, message } => StmtKind::Expect {
                condition: self.expect(scope, condition, &Type::Bool, Role::Place("`expect`")),
                message: message
                    .as_ref()
                    .map(|m| self.expect(scope, m, &Type::Text, Role::Place("the message"))),
            },
            K::Require(r) if own => self.behavior_require(scope, r),
            K::Ensure(r) => return self.ensure(scope, r, own),
            K::Require(r) => {
                let r = self.require(scope, r);
                StmtKind::Expect { condition: r.condition, message: r.message }
            }
            K::If { condition, then, otherwise } => {
                let condition = self.expect(scope, condition, &Type::Bool, Role::Place("the condition"));
                let (then, otherwise) = (self.inner(scope, then), self.inner(scope, otherwise));
                StmtKind::If { condition, then, otherwise }
            }
            K::For { binder, iterable, body } => {
                let (iterable, element) = self.iterable(scope, iterable);
                let outer = scope.open();
                let local = scope.bind(binder.text, element);
                let body = self.inner(scope, body);
                scope.close(outer);
                StmtKind::For { binder: local, iterable, body }
            }
        })
    }

    /// Checks statements in an inner scope.
    fn inner(&mut self, scope: &mut Scope, statements: &'a [ast::Stmt]) -> Vec<Stmt> {
        let mark = scope.open();
        let out = self.statements(scope, statements);
        scope.close(mark);
        out
    }

    /// Returns the typed `require` clause; error nodes, after a report, stand for a condition that is not a truth
    /// value and a message that is not a text.
    pub(super) fn require(&mut self, scope: &mut Scope, r: &'a ast::Require) -> super::typed::Require {
        super::typed::Require {
            span: r.span,
            condition: self.expect(scope, &r.condition, &Type::Bool, Role::Place("`require`")),
            message: r
                .message
                .as_ref()
                .map(|m| self.expect(scope, m, &Type::Text, Role::Place("the message"))),
        }
    }

    /// Returns (statements, tests) of the file that is run (an index into the loaded files), both typed and in order;
    /// mistakes are reported.
    pub(super) fn check_root(&mut self, file: usize) -> (Body, Vec<Test>) {
        let mut scope = Scope::new(file, None);
        let mut statements = Vec::new();
        let mut tests = Vec::new();
        for item in &self.loaded.files[file].ast.items {
            match &item.kind {
                ast::ItemKind::Statement(s) => {
                    let mark = scope.open();
                    statements.extend(self.statement(&mut scope, mark, s));
                }
                ast::ItemKind::Test(test) => {
                    let mut scope = Scope::new(file, None);
                    let statements = self.statements(&mut scope, &test.body);
                    let body = Body { statements, frame: scope.frame() };
                    tests.push(Test { name: test.name.clone(), span: test.name_span, body });
                }
                _ => {}
            }
        }
        (Body { statements, frame: scope.frame() }, tests)
    }

    /// Returns the typed members of a declaration with instances, by [`MemberId`].
    pub(super) fn typed_members(&mut self, id: DefId) -> Vec<super::typed::Member> {
        use super::checker::MemberInfoKind as I;
        use super::typed::MemberKind as M;
        let members = self.members(id);
        let mut out = Vec::with_capacity(members.list.len());
        for (i, info) in members.list.iter().enumerate() {
            let member = MemberId(i as u32);
            let kind = match info.kind {
                I::Param(i) => M::Param(i),
                I::Let(_) => M::Let(self.member_let(id, member, None)),
                I::Part(_, part) => M::Part(part),
                I::Port(clause, array) => self.config_port(id, clause, array),
                I::Behavior(i) => M::Behavior(i),
                I::Node { .. } => M::Node,
                I::Obstacle { .. } => M::Obstacle,
            };
            let ty = self.member_type(id, member, None);
            let doc = info.doc.clone();
            out.push(super::typed::Member { name: info.name, span: info.span, ty, kind, doc });
        }
        out
    }
}
