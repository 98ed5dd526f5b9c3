//! The members of declarations.

use super::checker::{
    BehaviorInfo, Checker, DefItem, Entity, JointInfo, MemberInfo, MemberInfoKind, Members, PortInfo,
};
use super::expr::error_expr;
use super::family::Family;
use super::scope::Scope;
use super::typed::{DefId, Expr, MemberId};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code};
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
    /// Returns the names inside a declaration with instances, collected at the first call. Names declared twice are
    /// reported then.
    pub(super) fn members(&mut self, id: DefId) -> Rc<Members<'a>> {
        if let Some(members) = &self.def(id).members {
            return members.clone();
        }
        let mut members = Members::default();
        let params: &'a [ast::Param] = match self.def(id).item {
            DefItem::Module(x) => &x.params,
            DefItem::Facts(x) => &x.params,
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
    pub(super) fn add_member(
        &mut self,
        members: &mut Members<'a>,
        name: ast::Name,
        kind: MemberInfoKind<'a>,
    ) {
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
        // A joint and a port of one name are distinguished by use, and so is their alias.
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
                    let signature = super::checker::Signature { params, result, ..Default::default() };
                    let doc = clause.doc.as_deref().map(Arc::from);
                    members.behaviors.push(BehaviorInfo {
                        ast: behavior,
                        doc,
                        signature: Rc::new(signature),
                    });
                }
                _ => self.obstacle_members(members, clause),
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

    /// Returns the type of a member as seen from outside its declaration; [`Type::Error`] if it has a mistake or needs
    /// itself, which is reported there or where its declaration is checked. `at`: the span that needs it, `None` if no
    /// other declaration does.
    pub(super) fn member_type(&mut self, id: DefId, member: MemberId, at: Option<Span>) -> Type {
        let members = self.members(id);
        let info = &members.list[member.0 as usize];
        match info.kind {
            MemberInfoKind::Param(i) => self.signature(id).params[i].ty.clone(),
            MemberInfoKind::Let(_) => self.member_let(id, member, at).ty,
            MemberInfoKind::Part(part, _) => {
                let scope = Scope::new(self.def(id).file, Some(id));
                let ty = match self.path_entity(scope.file, &part.ty) {
                    Some(Entity::Def(of)) if self.is_part_type(of) && !self.is_scene(of) => {
                        Type::Instance(of)
                    }
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
            MemberInfoKind::Obstacle { array: true } => Type::list(Type::Shape),
            MemberInfoKind::Obstacle { array: false } => Type::Shape,
            MemberInfoKind::Behavior(_) => Type::Behavior,
        }
    }

    /// Returns true if a declaration is a module or a configuration.
    pub(super) fn is_part_type(&self, id: DefId) -> bool {
        matches!(self.family(id), Some(Family::Module | Family::Config))
    }

    /// Returns the typed value of a `let` in a body, checked once, in a scope of its own; an error node, after a
    /// report, if it has a mistake or needs itself. `at`: the span that needs it, `None` if no other declaration does.
    /// Panics if the member is no `let`.
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

    /// Records that a member's expression needs a frame of `size` slots for locals; the declaration's frame is the
    /// largest.
    pub(super) fn note_frame(&mut self, id: DefId, size: usize) {
        let known = self.member_frames.entry(id).or_default();
        *known = size.max(*known);
    }

    /// Returns the largest number of slots for locals that a member of the declaration needs.
    pub(super) fn member_frame(&self, id: DefId) -> usize {
        self.member_frames.get(&id).copied().unwrap_or(0)
    }

    /// Reports that a declaration needs itself; `at` is the span that needs it, `None` for the declaration's own
    /// `span`.
    pub(super) fn declaration_cycle(&mut self, name: Symbol, span: Span, at: Option<Span>) {
        let mut d = Diagnostic::error(code::DECLARATION_CYCLE, format!("`{name}` needs itself"))
            .label(at.unwrap_or(span), "needed here while it is being worked out");
        if at.is_some_and(|at| at != span) {
            d = d.label(span, "declared here");
        }
        self.report(d.hint("write the type of one of the declarations on the circle, or cut it"));
    }
}

/// Returns the dimension of a joint's position, from the name of its kind: length for `prismatic`, else angle.
fn joint_dimension(kind: &ast::Expr) -> Dimension {
    match &kind.kind {
        K::Call { callee, .. } => match &callee.kind {
            K::Name(name) if *name == "prismatic" => Dimension::LENGTH,
            _ => Dimension::ANGLE,
        },
        _ => Dimension::ANGLE,
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

/// Returns the first name in a linear combination; `None` if there is none.
fn first_name(sum: &ast::Expr) -> Option<Symbol> {
    match &sum.kind {
        K::Name(name) => Some(*name),
        K::Unary { operand, .. } => first_name(operand),
        K::Binary { op: ast::BinaryOp::Mul, right, .. } => first_name(right),
        K::Binary { left, .. } => first_name(left),
        _ => None,
    }
}

/// Returns the joint of a name that is declared between links and follows nothing yet; `None` if there is none.
fn declared_joint<'m, 'a>(members: &'m mut Members<'a>, name: Symbol) -> Option<&'m mut JointInfo<'a>> {
    let open = |j: &&mut JointInfo| matches!(j.clause, ModuleClauseKind::Joint { .. }) && j.follows.is_none();
    members.joints.iter_mut().filter(|j| j.name == name).find(open)
}
