//! Configurations: parts, ports, behaviours, and the clauses that connect them.

use super::checker::{Checker, Entity};
use super::expr::{Role, error_expr};
use super::family::Family;
use super::scope::Scope;
use super::typed::{
    BehaviorDef, ConfigClause, ConfigDef, DefId, DefKind, Exemption, ExemptionKind, Expr, ExprKind,
    MemberKind, PartCount, PartDef, Stmt, StmtKind,
};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, code};
use crate::syntax::ast::{self, ConfigClauseKind};
use crate::units::Dimension;

impl<'a> Checker<'a> {
    /// Returns the typed body of the `config` or `scene` of a declaration. Parts, ports and clauses that are wrong are reported,
    /// and error nodes stand for their expressions.
    pub(super) fn check_config(&mut self, id: DefId, config: &'a ast::Config) -> DefKind {
        let signature = self.signature(id);
        let mut scope = Scope::new(self.def(id).file, Some(id));
        let params = self.typed_params(&mut scope, &config.params, &signature.params, false);
        let members = self.typed_members(id);
        let mut def = ConfigDef {
            scene: config.scene,
            world: None,
            params,
            closed: config.closed,
            members,
            parts: Vec::new(),
            behaviors: Vec::new(),
            clauses: Vec::new(),
            base: None,
            frame: 0,
        };
        for clause in &config.clauses {
            match &clause.kind {
                ConfigClauseKind::Part(part) => def.parts.push(self.part(&mut scope, id, part)),
                ConfigClauseKind::Base(path) => {
                    if def.base.is_some() {
                        self.report(
                            Diagnostic::error(code::DECLARED_TWICE, "a configuration has one `base`")
                                .label(clause.span, "given again here"),
                        );
                    }
                    def.base = self.base(&mut scope, path);
                }
                ConfigClauseKind::World(world) => {
                    if def.world.is_some() {
                        self.report(
                            Diagnostic::error(code::DECLARED_TWICE, "a scene has one `world`")
                                .label(clause.span, "given again here"),
                        );
                    }
                    def.world = self.surroundings(&mut scope, id, world);
                }
                ConfigClauseKind::Behavior(_) | ConfigClauseKind::Port { .. } | ConfigClauseKind::Let(_) => {}
                _ => {
                    let clause = self.config_clause(&mut scope, id, clause);
                    def.clauses.extend(clause);
                }
            }
        }
        let behaviors = self.members(id);
        for behavior in &behaviors.behaviors {
            def.behaviors.push(self.behavior(id, behavior));
        }
        // Expressions of members are checked in scopes of their own.
        def.frame = scope.frame().max(self.member_frame(id));
        DefKind::Config(def)
    }

    /// Checks a `part`.
    fn part(&mut self, scope: &mut Scope, id: DefId, part: &'a ast::Part) -> PartDef {
        self.lint_snake(part.name.text, part.name.span, "parts");
        let mark = scope.open();
        let count = part.count.as_ref().map(|count| match count {
            ast::PartCount::Number(e) => {
                PartCount::Number(self.expect(scope, e, &Type::Int, Role::Place("the number of parts")))
            }
            ast::PartCount::Each { binder, range } => {
                let (range, element) = self.iterable(scope, range);
                PartCount::Each { binder: scope.bind(binder.text, element), range }
            }
        });
        let of = self.part_type(scope, part);
        let at = self.part_place(scope, id, part);
        let args = match (of, &part.args) {
            (Some(of), args) => {
                let signature = self.signature(of);
                let name = self.def(of).name;
                let args = args.as_deref().unwrap_or(&[]);
                self.arguments_of(scope, part.ty_span, name, &signature, args)
            }
            (None, _) => Vec::new(),
        };
        scope.close(mark);
        let member = self.members(id).index[&part.name.text];
        // An unknown type has been reported. No `DefId` exists for it, so the configuration itself stands
        // in; elaboration sees the error type of the member first.
        let of = of.unwrap_or(id);
        PartDef {
            member,
            name: part.name.text,
            span: part.name.span,
            of,
            count,
            args,
            at,
            ty_span: part.ty_span,
        }
    }

    /// Returns the declaration that a part is an instance of; `None` (and a diagnostic) if it is not a module or
    /// configuration.
    fn part_type(&mut self, scope: &Scope, part: &'a ast::Part) -> Option<DefId> {
        let path = &part.ty;
        let last = path[path.len() - 1];
        let span = path[0].span.to(last.span);
        match self.path_entity(scope.file, path) {
            Some(Entity::Def(id)) if self.is_scene(id) => {
                self.report(
                    Diagnostic::error(code::SCENE_PART, format!("the scene `{}` is no part", last.text))
                        .label(span, "a module or configuration is wanted here")
                        .hint("what the robots of both have in common is a `config`, or a `fn` with the robots as parameters"),
                );
            }
            Some(Entity::Def(id)) if self.is_part_type(id) => return Some(id),
            Some(Entity::Error) => return None,
            Some(Entity::Def(id)) => {
                let what = match self.family(id).map(|family| (family, family.container())) {
                    Some((family, Some(container))) => {
                        format!("a {}: it goes into a `{}`", family.word(), container.word())
                    }
                    Some((_, None)) => "of another family of robots".to_owned(),
                    None => "no module or configuration".to_owned(),
                };
                self.report(
                    Diagnostic::error(code::NOT_A_TYPE, format!("`{}` is {what}", last.text))
                        .label(span, "a module or configuration is wanted here"),
                );
            }
            Some(Entity::File(_)) | None => {
                let names = self.visible_names(scope.file).into_iter();
                let types: Vec<&str> =
                    names.filter(|n| n.starts_with(|c: char| c.is_ascii_uppercase())).collect();
                let mut d = Diagnostic::error(code::NOT_A_TYPE, format!("`{}` is not known here", last.text))
                    .label(span, "a module or configuration is wanted here");
                if let Some(import) = self.import_hint(scope.file, last.text).filter(|_| path.len() == 1) {
                    d = d.hint(import);
                } else if let Some(near) = suggest(last.text.as_str(), types) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
            }
        }
        None
    }

    /// Checks the path of a `base` clause; `None` (and a diagnostic) if it names no module or
    /// configuration.
    fn base(&mut self, scope: &mut Scope, path: &'a ast::Path) -> Option<Expr> {
        let base = self.path(scope, path, None);
        match &base.ty {
            Type::Instance(id) if self.is_part_type(*id) => Some(base),
            Type::Error => None,
            other => {
                let words = self.words(other);
                self.report(
                    Diagnostic::error(code::TYPE_MISMATCH, format!("`base` names a module; this is {words}"))
                        .label(base.span, "a part is wanted here"),
                );
                None
            }
        }
    }

    /// Checks a `behavior`.
    fn behavior(&mut self, id: DefId, info: &super::checker::BehaviorInfo<'a>) -> BehaviorDef {
        let mut scope = Scope::new(self.def(id).file, Some(id));
        let ast = info.ast;
        self.lint_snake(ast.name.text, ast.name.span, "behaviors");
        let params = self.typed_params(&mut scope, &ast.params, &info.signature.params, true);
        let allows = ast.allows.iter().filter_map(|e| self.exemption(&mut scope, e)).collect();
        scope.in_behavior = true;
        scope.contracts = matches!(ast.body.kind, ast::ExprKind::Block { .. });
        let body = match self.ensures_last(&ast.body) {
            true => error_expr(ast.body.span),
            false => self.expr(&mut scope, &ast.body, Some(&Type::Behavior)),
        };
        let contracts = contracts_of(&body);
        let body = self.coerce(body, &Type::Behavior, Role::Place("a behavior"));
        BehaviorDef {
            name: ast.name.text,
            span: ast.name.span,
            doc: info.doc.clone(),
            params,
            allows,
            contracts,
            body,
            frame: scope.frame(),
        }
    }

    /// Checks an exemption of an `allows` clause; `None` (and a diagnostic) for an unknown one.
    fn exemption(&mut self, scope: &mut Scope, e: &'a ast::Exemption) -> Option<Exemption> {
        let known = [
            "unstable",
            "slip",
            "collision",
            "overload",
            "acceleration",
            "balance",
            "traction",
            "saturation",
        ];
        let part = Type::AnyOf(Family::Config);
        let kind = match (e.name.text.as_str(), e.args.as_slice()) {
            ("unstable", []) => ExemptionKind::Unstable,
            ("slip", []) => ExemptionKind::Slip,
            ("acceleration", []) => ExemptionKind::Acceleration,
            ("balance", []) => ExemptionKind::Balance,
            ("traction", []) => ExemptionKind::Traction,
            ("saturation", []) => ExemptionKind::Saturation,
            ("collision", []) => ExemptionKind::Collision(None),
            ("collision", [a, b]) => {
                let role = Role::Place("`collision`");
                let pair = (self.expect(scope, a, &part, role), self.expect(scope, b, &part, role));
                ExemptionKind::Collision(Some(pair))
            }
            ("overload", []) => ExemptionKind::Overload(None),
            ("overload", [joint]) => {
                let joint =
                    self.expect(scope, joint, &Type::joint(Dimension::ANGLE), Role::Place("`overload`"));
                ExemptionKind::Overload(Some(joint))
            }
            (name, _) => {
                let mut d = if known.contains(&name) {
                    Diagnostic::error(code::ARGUMENTS, format!("`{name}` does not take these")).label(
                        e.span,
                        "`collision(a, b)` names two parts, `overload(j)` a joint, the others nothing",
                    )
                } else {
                    Diagnostic::error(code::UNKNOWN_CHOICE, format!("`{name}` can't be allowed"))
                        .label(e.name.span, format!("one of {} is wanted", known.join(", ")))
                };
                if let Some(near) = suggest(name, known) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
                return None;
            }
        };
        Some(Exemption { kind, span: e.span })
    }

    /// Checks a clause that depends on values; `None` for clauses that are members.
    fn config_clause(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        clause: &'a ast::ConfigClause,
    ) -> Option<ConfigClause> {
        Some(match &clause.kind {
            ConfigClauseKind::Connect { a, b, turn } => {
                let angle = Type::Quantity(Dimension::ANGLE);
                ConfigClause::Connect {
                    a: self.port_path(scope, a),
                    b: self.port_path(scope, b),
                    turn: turn.as_ref().map(|e| self.expect(scope, e, &angle, Role::Place("`turn`"))),
                    span: clause.span,
                }
            }
            ConfigClauseKind::Set { joint, value } => {
                let joint = self.path(scope, joint, Some(&Type::joint(Dimension::ANGLE)));
                let want = match &joint.ty {
                    Type::Joint(t) => (**t).clone(),
                    Type::Error => Type::Error,
                    other => {
                        let words = self.words(other);
                        self.report(
                            Diagnostic::error(
                                code::TYPE_MISMATCH,
                                format!("`set` takes a joint; this is {words}"),
                            )
                            .label(joint.span, "a joint is wanted here"),
                        );
                        Type::Error
                    }
                };
                let value = self.expect(scope, value, &want, Role::Place("the joint's position"));
                ConfigClause::Set { joint, value, span: clause.span }
            }
            ConfigClauseKind::Let(x) => {
                let value = self.let_value(scope, x);
                ConfigClause::Let { local: scope.bind(x.name.text, value.ty.clone()), value }
            }
            ConfigClauseKind::Require(r) => ConfigClause::Require(self.require(scope, r)),
            ConfigClauseKind::Obstacle { .. } => {
                ConfigClause::Obstacle(self.obstacle(scope, id, &clause.kind, clause.span)?)
            }
            ConfigClauseKind::If { condition, then, otherwise } => ConfigClause::If {
                condition: self.expect(scope, condition, &Type::Bool, Role::Place("the condition")),
                then: self.config_clauses(scope, id, then),
                otherwise: self.config_clauses(scope, id, otherwise),
            },
            ConfigClauseKind::For { binder, iterable, body } => {
                let (iterable, element) = self.iterable(scope, iterable);
                let mark = scope.open();
                let binder = scope.bind(binder.text, element);
                let body = self.config_clauses(scope, id, body);
                scope.close(mark);
                ConfigClause::For { binder, iterable, body }
            }
            ConfigClauseKind::Error => return None,
            ConfigClauseKind::Part(_)
            | ConfigClauseKind::Port { .. }
            | ConfigClauseKind::Base(_)
            | ConfigClauseKind::World(_)
            | ConfigClauseKind::Behavior(_) => {
                self.report(
                    Diagnostic::error(
                        code::SYNTAX,
                        "parts, ports, `base` and behaviors stand at the top of the body",
                    )
                    .label(clause.span, "not in `if` or `for`")
                    .hint("`part leg[i in 0..4]: Leg(left: i < 2)` gives each part its arguments"),
                );
                return None;
            }
        })
    }

    /// Checks clauses in an inner scope.
    fn config_clauses(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        clauses: &'a [ast::ConfigClause],
    ) -> Vec<ConfigClause> {
        let mark = scope.open();
        let out = clauses.iter().filter_map(|c| self.config_clause(scope, id, c)).collect();
        scope.close(mark);
        out
    }

    /// Checks the path of a port in a `connect` clause.
    fn port_path(&mut self, scope: &mut Scope, path: &'a ast::Path) -> Expr {
        let port = self.path(scope, path, Some(&Type::Port));
        self.coerce(port, &Type::Port, Role::Place("`connect`"))
    }

    /// Returns the typed expression of a path such as `body.side[i]`, in which every prefix has its own span; an error
    /// node, after a report, if a name or member of it is unknown. `want`: the type expected of the whole, `None` if
    /// any will do; it decides between a joint and a port of one name.
    pub(super) fn path(&mut self, scope: &mut Scope, path: &'a ast::Path, want: Option<&Type>) -> Expr {
        let last = path.steps.len();
        let root_want = if last == 0 { want } else { None };
        let mut object = self.name_expr(scope, path.root.span, path.root.text, root_want);
        for (i, step) in path.steps.iter().enumerate() {
            object = match step {
                ast::PathStep::Field(name) => {
                    // In `m.left.port` and `m.side[i]` the expected type of the whole is that of the name.
                    let rest = &path.steps[i + 1..];
                    let ends = rest.iter().all(|s| matches!(s, ast::PathStep::Index { .. }));
                    let span = path.root.span.to(name.span);
                    let want = if ends { want } else { None };
                    self.path_field(span, object, *name, want, rest.first())
                }
                ast::PathStep::Index { index, span } => {
                    let index = self.expect(scope, index, &Type::Int, Role::Place("an index"));
                    self.index_of(path.root.span.to(*span), object, index)
                }
            };
        }
        object
    }

    /// Checks one step `.name` of a path.
    fn path_field(
        &mut self,
        span: crate::source::Span,
        object: Expr,
        name: ast::Name,
        want: Option<&Type>,
        next: Option<&ast::PathStep>,
    ) -> Expr {
        // The step `.joint` or `.port` after a name that is both a joint and a port chooses one.
        let is_module = self.instance_family(&object.ty) == Some(Family::Module);
        let chosen = match next {
            Some(ast::PathStep::Field(n)) if is_module && n.text == "joint" => {
                Some(Type::joint(Dimension::ANGLE))
            }
            Some(ast::PathStep::Field(n)) if is_module && n.text == "port" => Some(Type::Port),
            _ => None,
        };
        if ["joint", "port"].contains(&name.text.as_str()) {
            return self.chosen(span, object, name);
        }
        self.field_of(span, object, name, chosen.as_ref().or(want))
    }

    /// Returns the `port` clause of a configuration as a member with typed expressions; error nodes, after a report,
    /// stand for those that are wrong. `array`: true if the clause declares an array of ports. Panics on another
    /// clause.
    pub(super) fn config_port(&mut self, id: DefId, clause: &'a ConfigClauseKind, array: bool) -> MemberKind {
        let ConfigClauseKind::Port { name, count, value } = clause else {
            unreachable!("only port clauses are ports")
        };
        let mut scope = Scope::new(self.def(id).file, Some(id));
        let count = count
            .as_ref()
            .map(|e| self.expect(&mut scope, e, &Type::Int, Role::Place("the number of ports")));
        let want = if array { Type::list(Type::Port) } else { Type::Port };
        let value = self.expect(&mut scope, value, &want, Role::Param(name.text));
        self.note_frame(id, scope.frame());
        MemberKind::Port { count, value }
    }
}

/// Returns the clauses of requirements and contracts of a behaviour's own block, as [`BehaviorDef::contracts`].
fn contracts_of(body: &Expr) -> Vec<(Span, bool)> {
    let ExprKind::Block { statements, .. } = &body.kind else { return vec![] };
    let clause = |statement: &Stmt| match &statement.kind {
        StmtKind::Contract(contract) => Some((contract.span, true)),
        StmtKind::Expect { .. } => Some((statement.span, false)),
        _ => None,
    };
    statements.iter().filter_map(clause).collect()
}
