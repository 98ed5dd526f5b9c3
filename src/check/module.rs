//! Connectors and modules.

use super::checker::{Checker, DefItem, Entity};
use super::expr::{Role, expr_of};
use super::scope::Scope;
use super::typed::{
    CaptureDef, ConnectorDef, DefId, DefKind, Expr, ExprKind, JointBetween, JointDef, JointDefKind, Linear,
    LinkDef, ModuleClause, ModuleDef, MotorDef, Placement, PortClause, PortGroup,
};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast::{self, ConnectorClause, ExprKind as K, ModuleClauseKind};
use crate::units::Dimension;
use std::collections::HashMap;

impl<'a> Checker<'a> {
    /// Returns the typed body of a `connector`. Unknown connectors among those it mates with are reported and left
    /// out; a clause of a wrong type is reported, and is an error node.
    pub(super) fn check_connector(&mut self, id: DefId, connector: &'a ast::Connector) -> DefKind {
        let mut scope = Scope::new(self.def(id).file, None);
        let mut def = ConnectorDef {
            mates: Vec::new(),
            turns: None,
            holds: Vec::new(),
            capture: None,
            snaps: false,
            hinge: None,
            frame: 0,
        };
        for clause in &connector.clauses {
            match clause {
                ConnectorClause::Mates(names) => {
                    for name in names {
                        if let Some(mate) = self.connector_named(&scope, std::slice::from_ref(name)) {
                            def.mates.push((mate, name.span));
                        }
                    }
                }
                ConnectorClause::Turns(e) => {
                    def.turns = Some(self.expect(&mut scope, e, &Type::Int, Role::Place("`turns`")));
                }
                ConnectorClause::Holds(e) => def.holds.extend(self.holds(&mut scope, e)),
                ConnectorClause::Capture { distance, more, .. } => {
                    let length = Type::Quantity(Dimension::LENGTH);
                    let distance = self.expect(&mut scope, distance, &length, Role::Place("`capture`"));
                    let mut capture = CaptureDef { distance, angle: None, speed: None, rate: None };
                    more.iter().for_each(|e| self.capture_bound(&mut scope, e, &mut capture));
                    def.capture = Some(capture);
                }
                ConnectorClause::Snap => def.snaps = true,
                ConnectorClause::Hinge { keyword, args } => {
                    def.hinge = Some((*keyword, self.args_like_revolute(&mut scope, *keyword, args)));
                }
                ConnectorClause::Error => {}
            }
        }
        def.frame = scope.frame();
        DefKind::Connector(def)
    }

    /// Checks a further value of `capture`, and keeps it by its dimension: an angle, a speed or an angular speed.
    fn capture_bound(&mut self, scope: &mut Scope, e: &'a ast::Expr, capture: &mut CaptureDef) {
        let got = self.expr(scope, e, None);
        if got.ty.is_error() {
            return;
        }
        let is = |dimension: Dimension| got.ty == Type::Quantity(dimension);
        let (slot, what, bound) = if is(Dimension::SPEED) {
            (&mut capture.speed, "speed", got)
        } else if is(Dimension::ANGULAR_SPEED) {
            (&mut capture.rate, "angular speed", got)
        } else {
            let turn = Type::Quantity(Dimension::ANGLE);
            let angle = self.coerce(got, &turn, Role::Place("the angle of `capture`"));
            (&mut capture.angle, "angle", angle)
        };
        let span = bound.span;
        if slot.replace(bound).is_some() {
            let message = format!("the {what} of `capture` is stated twice");
            self.report(Diagnostic::error(code::BAD_CONNECTOR, message).label(span, "stated before"));
        }
    }

    /// Checks a value of `holds`: a force or a torque; `None` (and a diagnostic) for others.
    fn holds(&mut self, scope: &mut Scope, e: &'a ast::Expr) -> Option<Expr> {
        let got = self.expr(scope, e, None);
        match &got.ty {
            Type::Quantity(d) if [Dimension::FORCE, Dimension::TORQUE].contains(d) => Some(got),
            Type::Error => None,
            _ => {
                self.coerce(got, &Type::Quantity(Dimension::FORCE), Role::Place("`holds`"));
                None
            }
        }
    }

    /// Returns the arguments of a hinge, in the order of the parameters of the prelude's `revolute`; `None` for
    /// one that is left out.
    fn args_like_revolute(
        &mut self,
        scope: &mut Scope,
        span: Span,
        args: &'a [ast::Arg],
    ) -> Vec<Option<Expr>> {
        let Some(revolute) = self.prelude_def("revolute") else { return Vec::new() };
        let signature = self.signature(revolute);
        self.arguments_of(scope, span, Symbol::new("hinge"), &signature, args)
    }

    /// Returns a connector by its path; `None` (and a diagnostic) if there is none.
    fn connector_named(&mut self, scope: &Scope, path: &[ast::Name]) -> Option<DefId> {
        let last = path[path.len() - 1];
        let span = path[0].span.to(last.span);
        match self.path_entity(scope.file, path) {
            Some(Entity::Def(id)) if matches!(self.def(id).item, DefItem::Connector(_)) => Some(id),
            Some(Entity::Error) => None,
            found => {
                let why = if found.is_some() { "is no connector" } else { "is not known here" };
                let connectors: Vec<&str> = self
                    .defs
                    .iter()
                    .filter(|d| matches!(d.item, DefItem::Connector(_)))
                    .map(|d| d.name.as_str())
                    .collect();
                let mut d = Diagnostic::error(code::UNKNOWN_NAME, format!("`{}` {why}", last.text))
                    .label(span, "a connector is wanted here");
                let import = self.import_hint(scope.file, last.text);
                if let Some(import) = import.filter(|_| found.is_none() && path.len() == 1) {
                    d = d.hint(import);
                } else if let Some(near) = suggest(last.text.as_str(), connectors) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
                None
            }
        }
    }

    /// Returns the typed body of a `module`, in which links, joints, ports and motors refer to each other by index.
    /// Names that are unknown and clauses that are missing or given twice are reported.
    pub(super) fn check_module(&mut self, id: DefId, module: &'a ast::Module) -> DefKind {
        let signature = self.signature(id);
        let file = self.def(id).file;
        let mut scope = Scope::new(file, Some(id));
        let params = self.typed_params(&mut scope, &module.params, &signature.params, false);
        let members = self.typed_members(id);
        let infos = self.members(id);
        let links = link_names(module);
        self.duplicate_links(module);
        let mut def = ModuleDef {
            params,
            members,
            mass: None,
            touch: None,
            contact: None,
            links: Vec::new(),
            joints: Vec::new(),
            ports: Vec::new(),
            motors: Vec::new(),
            clauses: Vec::new(),
            joint_aliases: aliases(&infos.joint_index, |i| infos.joints[i].name),
            port_aliases: aliases(&infos.port_index, |i| infos.ports[i].name),
            frame: 0,
        };
        for port in &infos.ports {
            self.lint_snake(port.name, port.span, "ports");
            let (name, span, array, doc) = (port.name, port.span, port.array, port.doc.clone());
            def.ports.push(PortGroup { name, span, array, doc });
        }
        for joint in &infos.joints {
            self.lint_snake(joint.name, joint.span, "joints");
            let kind = self.joint_kind(&mut scope, id, &links, joint.clause, joint.follows);
            let (name, span, dimension, doc) = (joint.name, joint.span, joint.dimension, joint.doc.clone());
            def.joints.push(JointDef { name, span, dimension, doc, kind });
        }
        for clause in &module.clauses {
            self.module_clause(&mut scope, id, &links, clause, &mut def);
        }
        def.frame = scope.frame().max(self.member_frame(id));
        DefKind::Module(def)
    }

    /// Reports links of the same name.
    fn duplicate_links(&mut self, module: &'a ast::Module) {
        let mut seen: HashMap<Symbol, Span> = HashMap::new();
        for clause in &module.clauses {
            if let ModuleClauseKind::Link { name, .. } = &clause.kind {
                if let Some(first) = seen.get(&name.text) {
                    self.declared_twice(name.text, *first, name.span);
                } else {
                    seen.insert(name.text, name.span);
                }
            }
        }
    }

    /// Checks the kind of a joint.
    fn joint_kind(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        links: &[Symbol],
        clause: &'a ModuleClauseKind,
        follows: Option<&'a ModuleClauseKind>,
    ) -> JointDefKind {
        match clause {
            ModuleClauseKind::Joint { parent, child, kind, at, .. } => {
                JointDefKind::Declared(Box::new(JointBetween {
                    parent: self.link(links, parent),
                    child: self.link(links, child),
                    kind: self.expect(scope, kind, &Type::JointKind, Role::Place("a joint")),
                    at: at.as_ref().map(|p| self.placement(scope, p)),
                    follows: follows.map(|clause| self.followed(scope, id, clause)),
                }))
            }
            clause => JointDefKind::Mimic(self.followed(scope, id, clause)),
        }
    }

    /// Returns the linear combination of a clause `joint b = -a`.
    fn followed(&mut self, scope: &mut Scope, id: DefId, clause: &'a ModuleClauseKind) -> Linear {
        let ModuleClauseKind::Mimic { value, .. } = clause else { return Linear::new() };
        self.linear(scope, id, value).unwrap_or_default()
    }

    /// Returns the index of a link; 0 (and a diagnostic) if there is no such link.
    fn link(&mut self, links: &[Symbol], name: &ast::Name) -> usize {
        if let Some(index) = links.iter().position(|l| *l == name.text) {
            return index;
        }
        if self.is_unread(name.text) {
            return 0;
        }
        let mut d =
            Diagnostic::error(code::UNKNOWN_MEMBER, format!("no link `{}` in this module", name.text))
                .label(name.span, "a link is wanted here");
        if let Some(near) = suggest(name.text.as_str(), links.iter().map(|l| l.as_str())) {
            d = d.hint(format!("`{near}`?"));
        }
        self.report(d);
        0
    }

    /// Returns the typed form of a placement; error nodes, after a report, stand for expressions that are wrong.
    pub(super) fn placement(&mut self, scope: &mut Scope, p: &'a ast::Placement) -> Placement {
        let position = self.expect(scope, &p.position, &Type::vec3(Dimension::LENGTH), Role::Place("`at`"));
        let turned = p.turned.iter().filter_map(|args| self.turned(scope, p.span, args)).collect();
        Placement { position, turned, span: p.span }
    }

    /// Checks one turn of a placement; `None` (and a diagnostic) if it has not two arguments.
    fn turned(&mut self, scope: &mut Scope, span: Span, args: &'a [ast::Arg]) -> Option<(Expr, Expr)> {
        let [axis, angle] = args else {
            self.report(
                Diagnostic::error(code::ARGUMENTS, "`turned` takes an axis and an angle")
                    .label(span, "as in `turned(Z, 90deg)`"),
            );
            return None;
        };
        let axis = self.expect(
            scope,
            &axis.value,
            &Type::vec3(Dimension::NUMBER),
            Role::Place("the axis of `turned`"),
        );
        let angle = self.expect(
            scope,
            &angle.value,
            &Type::Quantity(Dimension::ANGLE),
            Role::Place("the angle of `turned`"),
        );
        Some((axis, angle))
    }

    /// Checks a clause of a module.
    fn module_clause(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        links: &[Symbol],
        clause: &'a ast::ModuleClause,
        def: &mut ModuleDef,
    ) {
        let length = Type::Quantity(Dimension::LENGTH);
        match &clause.kind {
            ModuleClauseKind::Mass(e) => {
                let mass = Type::Quantity(Dimension::MASS);
                def.mass = Some(self.expect(scope, e, &mass, Role::Place("`mass`")));
            }
            ModuleClauseKind::Touch(e) => {
                def.touch = Some(self.expect(scope, e, &length, Role::Place("`touch`")));
            }
            ModuleClauseKind::Contact(e) => {
                def.contact = Some(self.expect(scope, e, &length, Role::Place("`contact`")));
            }
            ModuleClauseKind::Link { name, shape, collides, at } => {
                self.lint_snake(name.text, name.span, "links");
                let role = Role::Place("a link");
                def.links.push(LinkDef {
                    name: name.text,
                    span: name.span,
                    shape: self.expect(scope, shape, &Type::Shape, role),
                    collides: collides.as_ref().map(|e| self.expect(scope, e, &Type::Shape, role)),
                    at: at.as_ref().map(|p| self.placement(scope, p)),
                });
            }
            ModuleClauseKind::Motor { name, value, args } => {
                let motor = self.motor(scope, id, name, value, args);
                def.motors.extend(motor);
            }
            ModuleClauseKind::Joint { .. }
            | ModuleClauseKind::Mimic { .. }
            | ModuleClauseKind::Alias { .. }
            | ModuleClauseKind::Let(_)
            | ModuleClauseKind::Error => {}
            _ => {
                let clause = self.nested_clause(scope, id, links, clause);
                def.clauses.extend(clause);
            }
        }
    }

    /// Checks a clause that may be inside `if` and `for`; `None` for others, which are reported.
    fn nested_clause(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        links: &[Symbol],
        clause: &'a ast::ModuleClause,
    ) -> Option<ModuleClause> {
        Some(match &clause.kind {
            ModuleClauseKind::Port(port) => self.port_clause(scope, id, links, port, clause.span)?,
            ModuleClauseKind::Touching(a, b) => {
                ModuleClause::Touching(self.link(links, a), self.link(links, b), clause.span)
            }
            ModuleClauseKind::Let(x) => {
                let value = self.let_value(scope, x);
                ModuleClause::Let { local: scope.bind(x.name.text, value.ty.clone()), value }
            }
            ModuleClauseKind::Require(r) => ModuleClause::Require(self.require(scope, r)),
            ModuleClauseKind::If { condition, then, otherwise } => ModuleClause::If {
                condition: self.expect(scope, condition, &Type::Bool, Role::Place("the condition")),
                then: self.nested_clauses(scope, id, links, then),
                otherwise: self.nested_clauses(scope, id, links, otherwise),
            },
            ModuleClauseKind::For { binder, iterable, body } => {
                let (iterable, element) = self.iterable(scope, iterable);
                let mark = scope.open();
                let binder = scope.bind(binder.text, element);
                let body = self.nested_clauses(scope, id, links, body);
                scope.close(mark);
                ModuleClause::For { binder, iterable, body }
            }
            ModuleClauseKind::Error => return None,
            _ => {
                self.report(
                    Diagnostic::error(
                        code::BAD_MODULE,
                        "links, joints and motors stand at the top of the module's body",
                    )
                    .label(clause.span, "not in `if` or `for`")
                    .hint("`if` and `for` hold ports of an array, `touching`, `let` and `require`"),
                );
                return None;
            }
        })
    }

    /// Checks clauses in an inner scope.
    fn nested_clauses(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        links: &[Symbol],
        clauses: &'a [ast::ModuleClause],
    ) -> Vec<ModuleClause> {
        let mark = scope.open();
        let out = clauses.iter().filter_map(|c| self.nested_clause(scope, id, links, c)).collect();
        scope.close(mark);
        out
    }

    /// Checks a `port` clause; `None` if its connector is unknown.
    fn port_clause(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        links: &[Symbol],
        port: &'a ast::ModulePort,
        span: Span,
    ) -> Option<ModuleClause> {
        let direction = Type::vec3(Dimension::NUMBER);
        let connector = self.connector_named(scope, &port.connector);
        let link = self.link(links, &port.link);
        let index = port
            .index
            .as_ref()
            .map(|e| self.expect(scope, e, &Type::Int, Role::Place("the index of a port")));
        let at = port.at.as_ref().map(|p| self.placement(scope, p));
        let facing = self.expect(scope, &port.facing, &direction, Role::Place("`facing`"));
        let up = port.up.as_ref().map(|e| self.expect(scope, e, &direction, Role::Place("`up`")));
        let group = *self.members(id).port_index.get(&port.name.text)?;
        Some(ModuleClause::Port(Box::new(PortClause {
            group,
            index,
            connector: connector?,
            link,
            at,
            facing,
            up,
            span,
        })))
    }

    /// Checks a `motor` clause; `None` if it drives no linear combination of joints.
    fn motor(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        name: &'a ast::Name,
        value: &'a ast::Expr,
        args: &'a [ast::Arg],
    ) -> Option<MotorDef> {
        let joints = self.linear(scope, id, value)?;
        let mut motor = MotorDef {
            name: name.text,
            span: name.span,
            joints,
            max_speed: None,
            max_accel: None,
            max_torque: None,
        };
        for arg in args {
            let known = arg.name.map(|n| n.text.as_str()).unwrap_or("");
            let (slot, dimension) = match known {
                "max_speed" => (&mut motor.max_speed, Dimension::ANGULAR_SPEED),
                "max_accel" => (&mut motor.max_accel, Dimension::ANGULAR_ACCELERATION),
                "max_torque" => (&mut motor.max_torque, Dimension::TORQUE),
                _ => {
                    self.report(
                        Diagnostic::error(
                            code::ARGUMENTS,
                            "a motor takes max_speed, max_accel and max_torque",
                        )
                        .label(arg.name.map_or(arg.value.span, |n| n.span), "none of these"),
                    );
                    continue;
                }
            };
            let name = arg.name.expect("matched by name").text;
            *slot = Some(self.expect(scope, &arg.value, &Type::Quantity(dimension), Role::Param(name)));
        }
        Some(motor)
    }

    /// Returns a linear combination of joints, `tilt + 2 * pan`; `None` (and a diagnostic) for other
    /// expressions.
    fn linear(&mut self, scope: &mut Scope, id: DefId, e: &'a ast::Expr) -> Option<Linear> {
        let one = |value: f64| expr_of(e.span, Type::NUMBER, ExprKind::Number(value));
        match &e.kind {
            K::Name(name) => {
                if let Some(joint) = self.members(id).joint_index.get(name).copied() {
                    return Some(vec![(joint, one(1.0))]);
                }
                if self.is_unread(*name) {
                    return None;
                }
                let names: Vec<&str> = self.members(id).joint_index.keys().map(|s| s.as_str()).collect();
                let mut d =
                    Diagnostic::error(code::UNKNOWN_MEMBER, format!("no joint `{name}` in this module"))
                        .label(e.span, "a joint is wanted here");
                if let Some(near) = suggest(name.as_str(), names) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
                None
            }
            K::Unary { op, operand, .. } if *op != ast::UnaryOp::Not => {
                let sign = if *op == ast::UnaryOp::Neg { -1.0 } else { 1.0 };
                let inner = self.linear(scope, id, operand)?;
                Some(inner.into_iter().map(|(j, f)| (j, times(one(sign), f))).collect())
            }
            K::Binary { op: ast::BinaryOp::Add, left, right, .. } => {
                let mut sum = self.linear(scope, id, left)?;
                sum.extend(self.linear(scope, id, right)?);
                Some(sum)
            }
            K::Binary { op: ast::BinaryOp::Sub, left, right, .. } => {
                let mut sum = self.linear(scope, id, left)?;
                let other = self.linear(scope, id, right)?;
                sum.extend(other.into_iter().map(|(j, f)| (j, times(one(-1.0), f))));
                Some(sum)
            }
            K::Binary { op: ast::BinaryOp::Mul, left, right, .. } => {
                let factor = self.expect(scope, left, &Type::NUMBER, Role::Place("the factor of a joint"));
                let inner = self.linear(scope, id, right)?;
                Some(inner.into_iter().map(|(j, f)| (j, times(factor.clone(), f))).collect())
            }
            K::Error => None,
            _ => {
                self.report(
                    Diagnostic::error(code::BAD_MODULE, "a sum of joints is wanted here")
                        .label(e.span, "joints, each perhaps times a number")
                        .hint("as in `tilt + pan` or `-2 * tilt`"),
                );
                None
            }
        }
    }
}

/// Returns the product of two factors.
fn times(factor: Expr, inner: Expr) -> Expr {
    let span = inner.span;
    let kind =
        ExprKind::Binary { op: super::typed::BinaryOp::Mul, left: Box::new(factor), right: Box::new(inner) };
    expr_of(span, Type::NUMBER, kind)
}

/// Returns the names of the links of a module.
fn link_names(module: &ast::Module) -> Vec<Symbol> {
    let names = module.clauses.iter().filter_map(|c| match &c.kind {
        ModuleClauseKind::Link { name, .. } => Some(name.text),
        _ => None,
    });
    names.collect()
}

/// Returns the aliases in an index, by name: the entries whose key is not their own name.
fn aliases(index: &HashMap<Symbol, usize>, own: impl Fn(usize) -> Symbol) -> Vec<(Symbol, usize)> {
    let mut out: Vec<(Symbol, usize)> =
        index.iter().map(|(n, i)| (*n, *i)).filter(|(n, i)| own(*i) != *n).collect();
    out.sort();
    out
}
