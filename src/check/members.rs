//! The members of declarations, and the meaning of `object.name`.

use super::checker::{
    BehaviorInfo, Checker, DefItem, Entity, JointInfo, MemberInfo, MemberInfoKind, Members, PortInfo, Scope,
};
use super::expr::{error_expr, expr_of};
use super::typed::{DefId, Expr, ExprKind, MemberId};
use super::types::{Family, FnType, Type};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code, foreign};
use crate::syntax::ast::{self, ConfigClauseKind, ExprKind as K, ModuleClauseKind, TrussClauseKind};
use crate::units::Dimension;
use std::rc::Rc;
use std::sync::Arc;

impl<'a> Members<'a> {
    /// Adds a member; returns false if the name is taken.
    fn add(&mut self, name: ast::Name, kind: MemberInfoKind<'a>) -> bool {
        let id = MemberId(self.list.len() as u32);
        self.list.push(MemberInfo { name: name.text, span: name.span, doc: None, kind });
        let new = !self.index.contains_key(&name.text);
        self.index.entry(name.text).or_insert(id);
        new
    }

    /// Sets the documentation of the members from an index on, which one clause declares.
    fn document(&mut self, from: usize, doc: Option<&str>) {
        let doc: Option<Arc<str>> = doc.map(Arc::from);
        self.list[from..].iter_mut().for_each(|member| member.doc = doc.clone());
    }
}

impl<'a> Checker<'a> {
    /// Returns the members of a declaration; computes them once.
    pub(super) fn members(&mut self, id: DefId) -> Rc<Members<'a>> {
        if let Some(members) = &self.def(id).members {
            return members.clone();
        }
        let mut members = Members::default();
        let params: &'a [ast::Param] = match self.def(id).item {
            DefItem::Module(x) => &x.params,
            DefItem::Cell(x) | DefItem::Strut(x) => &x.params,
            DefItem::Config(x) => &x.params,
            DefItem::Lattice(x) => &x.params,
            DefItem::Truss(x) => &x.params,
            _ => &[],
        };
        for (i, param) in params.iter().enumerate() {
            self.add_member(&mut members, param.name, MemberInfoKind::Param(i));
        }
        match self.def(id).item {
            DefItem::Module(module) => self.module_members(&mut members, module),
            DefItem::Config(config) => self.config_members(id, &mut members, config),
            DefItem::Truss(truss) => {
                if let ast::TrussBody::Clauses(clauses) = &truss.body {
                    self.truss_members(&mut members, clauses, false);
                }
            }
            _ => {}
        }
        let members = Rc::new(members);
        self.def_mut(id).members = Some(members.clone());
        members
    }

    /// Adds a member; reports a name declared twice.
    fn add_member(&mut self, members: &mut Members<'a>, name: ast::Name, kind: MemberInfoKind<'a>) {
        if !members.add(name, kind) {
            let first = members.list[members.index[&name.text].0 as usize].span;
            self.declared_twice(name.text, first, name.span);
        }
    }

    /// Collects the joints, ports and members of a module.
    fn module_members(&mut self, members: &mut Members<'a>, module: &'a ast::Module) {
        for clause in &module.clauses {
            let doc = clause.doc.as_deref().map(Arc::from);
            match &clause.kind {
                ModuleClauseKind::Let(x) => {
                    self.add_member(members, x.name, MemberInfoKind::Let(x));
                    members.document(members.list.len() - 1, clause.doc.as_deref());
                }
                ModuleClauseKind::Joint { name, kind, .. } => {
                    let dimension = joint_dimension(kind);
                    self.add_joint(members, *name, doc, &clause.kind, dimension);
                }
                ModuleClauseKind::Mimic { name, .. } => match declared_joint(members, name.text) {
                    Some(joint) => joint.follows = Some(&clause.kind),
                    None => self.add_joint(members, *name, doc, &clause.kind, Dimension::ANGLE),
                },
                ModuleClauseKind::Port(port) => self.add_port(members, port, doc),
                ModuleClauseKind::If { then, otherwise, .. } => {
                    self.nested_ports(members, then);
                    self.nested_ports(members, otherwise);
                }
                ModuleClauseKind::For { body, .. } => self.nested_ports(members, body),
                _ => {}
            }
        }
        coordinates(members);
        for clause in &module.clauses {
            if let ModuleClauseKind::Alias { name, target } = &clause.kind {
                self.add_alias(members, *name, *target);
            }
        }
    }

    /// Adds a joint of a module, or the clause by which a joint follows others.
    fn add_joint(
        &mut self,
        members: &mut Members<'a>,
        name: ast::Name,
        doc: Option<Arc<str>>,
        clause: &'a ModuleClauseKind,
        dimension: Dimension,
    ) {
        let index = members.joints.len();
        let (text, span) = (name.text, name.span);
        members.joints.push(JointInfo { name: text, span, doc, clause, follows: None, dimension });
        if let Some(first) = members.joint_index.get(&name.text) {
            let first = members.joints[*first].span;
            return self.declared_twice(name.text, first, name.span);
        }
        members.joint_index.insert(name.text, index);
    }

    /// Adds a port of a module.
    fn add_port(&mut self, members: &mut Members<'a>, port: &'a ast::ModulePort, doc: Option<Arc<str>>) {
        let array = port.index.is_some();
        if let Some(first) = members.port_index.get(&port.name.text).copied() {
            if !(array && members.ports[first].array) {
                let first = members.ports[first].span;
                self.declared_twice(port.name.text, first, port.name.span);
            }
            return;
        }
        members.port_index.insert(port.name.text, members.ports.len());
        members.ports.push(PortInfo { name: port.name.text, span: port.name.span, doc, array });
    }

    /// Adds the ports inside conditions and loops.
    fn nested_ports(&mut self, members: &mut Members<'a>, clauses: &'a [ast::ModuleClause]) {
        for clause in clauses {
            match &clause.kind {
                ModuleClauseKind::Port(port) => {
                    self.add_port(members, port, clause.doc.as_deref().map(Arc::from));
                }
                ModuleClauseKind::If { then, otherwise, .. } => {
                    self.nested_ports(members, then);
                    self.nested_ports(members, otherwise);
                }
                ModuleClauseKind::For { body, .. } => self.nested_ports(members, body),
                _ => {}
            }
        }
    }

    /// Adds an alias of a joint, a port, or both.
    fn add_alias(&mut self, members: &mut Members<'a>, name: ast::Name, target: ast::Name) {
        let joint = members.joint_index.get(&target.text).copied();
        let port = members.port_index.get(&target.text).copied();
        if joint.is_none() && port.is_none() && self.is_unread(target.text) {
            return;
        }
        if joint.is_none() && port.is_none() {
            let known = members.joint_index.keys().chain(members.port_index.keys()).map(|s| s.as_str());
            let near = suggest(target.text.as_str(), known);
            let mut d =
                Diagnostic::error(code::UNKNOWN_MEMBER, format!("no joint or port `{}` here", target.text))
                    .label(target.span, "an alias is another name for a joint or a port");
            if let Some(near) = near {
                d = d.hint(format!("`{near}`?"));
            }
            return self.report(d);
        }
        // A joint and a port of one name are told apart by use, and so is their alias.
        if let Some(joint) = joint {
            if let Some(first) = members.joint_index.get(&name.text).copied() {
                let first = members.joints[first].span;
                return self.declared_twice(name.text, first, name.span);
            }
            members.joint_index.insert(name.text, joint);
        }
        if let Some(port) = port {
            if let Some(first) = members.port_index.get(&name.text).copied() {
                let first = members.ports[first].span;
                return self.declared_twice(name.text, first, name.span);
            }
            members.port_index.insert(name.text, port);
        }
    }

    /// Collects the members of a configuration.
    fn config_members(&mut self, id: DefId, members: &mut Members<'a>, config: &'a ast::Config) {
        let mut parts = 0;
        for clause in &config.clauses {
            let before = members.list.len();
            match &clause.kind {
                ConfigClauseKind::Let(x) => self.add_member(members, x.name, MemberInfoKind::Let(x)),
                ConfigClauseKind::Part(part) => {
                    self.add_member(members, part.name, MemberInfoKind::Part(part, parts));
                    parts += 1;
                }
                ConfigClauseKind::Port { name, count, value } => {
                    let array = count.is_some() || matches!(value.kind, K::List(_) | K::Comprehension { .. });
                    self.add_member(members, *name, MemberInfoKind::Port(&clause.kind, array));
                }
                ConfigClauseKind::Behavior(behavior) => {
                    let index = members.behaviors.len();
                    self.add_member(members, behavior.name, MemberInfoKind::Behavior(index));
                    let scope = Scope::new(self.def(id).file, Some(id));
                    let params = self.params(&scope, &behavior.params);
                    let result = Some(Type::Behavior);
                    let signature = super::checker::Signature { params, result, type_params: Vec::new() };
                    let doc = clause.doc.as_deref().map(Arc::from);
                    members.behaviors.push(BehaviorInfo {
                        ast: behavior,
                        doc,
                        signature: Rc::new(signature),
                    });
                }
                _ => {}
            }
            members.document(before, clause.doc.as_deref());
        }
    }

    /// Collects the members of a truss; `nested` is true inside loops and conditions.
    fn truss_members(&mut self, members: &mut Members<'a>, clauses: &'a [ast::TrussClause], nested: bool) {
        for clause in clauses {
            match &clause.kind {
                TrussClauseKind::Let(x) if !nested => {
                    self.add_member(members, x.name, MemberInfoKind::Let(x))
                }
                TrussClauseKind::Node { name, index, .. } => {
                    let array = index.is_some();
                    let known = members.index.get(&name.text).map(|m| members.list[m.0 as usize].kind);
                    if !(array && matches!(known, Some(MemberInfoKind::Node { array: true }))) {
                        self.add_member(members, *name, MemberInfoKind::Node { array });
                    }
                }
                TrussClauseKind::If { then, otherwise, .. } => {
                    self.truss_members(members, then, true);
                    self.truss_members(members, otherwise, true);
                }
                TrussClauseKind::For { body, .. } => self.truss_members(members, body, true),
                _ => {}
            }
        }
    }

    /// Returns the member, joint or port that a bare name stands for in the body of `this`.
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

    /// Checks `object.name`.
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

    /// Resolves `.joint` or `.port` behind an expression that is already the one or the other.
    pub(super) fn chosen(&mut self, span: Span, object: Expr, field: ast::Name) -> Expr {
        match (field.text.as_str(), object.kind) {
            ("joint", kind @ ExprKind::Joint { .. }) | ("port", kind @ ExprKind::Port { .. }) => {
                expr_of(span, object.ty, kind)
            }
            (_, kind) => self.field_of(span, Expr { kind, ..object }, field, None),
        }
    }

    /// Returns the field of a checked object, by the type of the object.
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
            Some(Family::Config) => "part, port or behavior",
            _ => "member",
        };
        let names = self.member_names(id);
        let near = suggest(field.text.as_str(), names);
        let name = self.def(id).name;
        let mut d = Diagnostic::error(code::UNKNOWN_MEMBER, format!("no {what} `{}` in {name}", field.text))
            .label(field.span, format!("{name} has none of this name"));
        if let Some(near) = near {
            d = d.hint(format!("`{near}`?"));
        }
        self.report(d);
        error_expr(span)
    }

    /// Returns a field of a record, inherited ones included; reports an unknown one.
    fn record_field(&mut self, span: Span, object: Expr, id: DefId, field: ast::Name) -> Expr {
        for record in self.record_line(id) {
            let DefItem::Record(ast) = self.def(record).item else { continue };
            if let Some(found) = ast.fields.iter().find(|f| f.name.text == field.text) {
                let scope = Scope::new(self.def(record).file, None);
                let ty = self.type_expr(&scope, &found.ty);
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

    /// Returns the prelude's record `Plan`, if the prelude could be read.
    pub(super) fn plan_record(&self) -> Option<DefId> {
        self.prelude_def("plan").and(self.prelude_def("Plan"))
    }

    /// Returns the expression `plan(behavior)`.
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
            if let DefItem::Record(ast) = self.def(record).item {
                names.extend(ast.fields.iter().map(|f| f.name.text.as_str()));
                names.extend(ast.methods.iter().map(|(_, m)| m.name.text.as_str()));
            }
        }
        names
    }

    /// Returns the type of a member as seen from outside; `at` is the place that needs it.
    pub(super) fn member_type(&mut self, id: DefId, member: MemberId, at: Option<Span>) -> Type {
        let members = self.members(id);
        let info = &members.list[member.0 as usize];
        match info.kind {
            MemberInfoKind::Param(i) => self.signature(id).params[i].ty.clone(),
            MemberInfoKind::Let(_) => self.member_let(id, member, at).ty,
            MemberInfoKind::Part(part, _) => {
                let scope = Scope::new(self.def(id).file, Some(id));
                let ty = match self.path_entity(scope.file, &part.ty) {
                    Some(Entity::Def(of)) if self.is_part_type(of) => Type::Instance(of),
                    _ => Type::Error,
                };
                if part.count.is_some() && !ty.is_error() { Type::list(ty) } else { ty }
            }
            MemberInfoKind::Port(_, array) => {
                if array {
                    Type::list(Type::Port)
                } else {
                    Type::Port
                }
            }
            MemberInfoKind::Node { array } => {
                let node = Type::vec3(Dimension::LENGTH);
                if array { Type::list(node) } else { node }
            }
            MemberInfoKind::Behavior(_) => Type::Behavior,
        }
    }

    /// Returns whether a declaration is a module or a configuration.
    pub(super) fn is_part_type(&self, id: DefId) -> bool {
        matches!(self.family(id), Some(Family::Module | Family::Config))
    }

    /// Checks the value of a `let` in a body, once, in a scope of its own.
    pub(super) fn member_let(&mut self, id: DefId, member: MemberId, at: Option<Span>) -> Expr {
        let members = self.members(id);
        let info = &members.list[member.0 as usize];
        let MemberInfoKind::Let(ast) = info.kind else { unreachable!("only lets have values here") };
        match self.member_lets.get(&(id, member)) {
            Some(Some(value)) => return value.clone(),
            Some(None) => {
                self.declaration_cycle(info.name, info.span, at);
                return error_expr(info.span);
            }
            None => {}
        }
        self.member_lets.insert((id, member), None);
        let mut scope = Scope::new(self.def(id).file, Some(id));
        let value = self.let_value(&mut scope, ast);
        self.note_frame(id, scope.frame());
        self.member_lets.insert((id, member), Some(value.clone()));
        value
    }

    /// Records the size of the frame of a member's expression; the largest counts.
    pub(super) fn note_frame(&mut self, id: DefId, size: usize) {
        let known = self.member_frames.entry(id).or_default();
        *known = size.max(*known);
    }

    /// Returns the largest frame of a declaration's members, in slots.
    pub(super) fn member_frame(&self, id: DefId) -> usize {
        self.member_frames.get(&id).copied().unwrap_or(0)
    }

    /// Reports a declaration that needs itself.
    pub(super) fn declaration_cycle(&mut self, name: Symbol, span: Span, at: Option<Span>) {
        let mut d = Diagnostic::error(code::DECLARATION_CYCLE, format!("`{name}` needs itself"))
            .label(at.unwrap_or(span), "needed here while it is being worked out");
        if at.is_some_and(|at| at != span) {
            d = d.label(span, "declared here");
        }
        self.report(d.hint("write the type of one of the declarations on the circle, or cut it"));
    }
}

/// Returns the dimension of a joint's position, from the name of its kind.
fn joint_dimension(kind: &ast::Expr) -> Dimension {
    match &kind.kind {
        K::Call { callee, .. } => match &callee.kind {
            K::Name(name) if *name == "prismatic" => Dimension::LENGTH,
            _ => Dimension::ANGLE,
        },
        _ => Dimension::ANGLE,
    }
}

/// Returns whether an expected type, or one of its alternatives or elements, is of a kind.
fn wants(want: &Type, kind: fn(&Type) -> bool) -> bool {
    match want {
        Type::Optional(t) | Type::List(t) => wants(t, kind),
        Type::Choice(c) => c.types.iter().any(|t| wants(t, kind)),
        other => kind(other),
    }
}

/// Sets the dimension of coordinates that move no link from the joints they combine.
fn coordinates(members: &mut Members) {
    // One coordinate may follow another, in either order.
    for _ in 0..members.joints.len() {
        let mut changed = false;
        for index in 0..members.joints.len() {
            let ModuleClauseKind::Mimic { value, .. } = members.joints[index].clause else { continue };
            let followed = first_name(value).and_then(|name| members.joint_index.get(&name));
            let Some(dimension) = followed.map(|joint| members.joints[*joint].dimension) else { continue };
            changed |= members.joints[index].dimension != dimension;
            members.joints[index].dimension = dimension;
        }
        if !changed {
            break;
        }
    }
}

/// Returns the first name in a linear combination.
fn first_name(sum: &ast::Expr) -> Option<Symbol> {
    match &sum.kind {
        K::Name(name) => Some(*name),
        K::Unary { operand, .. } => first_name(operand),
        K::Binary { op: ast::BinaryOp::Mul, right, .. } => first_name(right),
        K::Binary { left, .. } => first_name(left),
        _ => None,
    }
}

/// Returns the joint of a name that is declared between links and follows nothing yet.
fn declared_joint<'m, 'a>(members: &'m mut Members<'a>, name: Symbol) -> Option<&'m mut JointInfo<'a>> {
    let open = |j: &&mut JointInfo| matches!(j.clause, ModuleClauseKind::Joint { .. }) && j.follows.is_none();
    members.joints.iter_mut().filter(|j| j.name == name).find(open)
}
