//! Cells and struts, lattices and trusses.

use super::checker::{Checker, Entity, MemberInfoKind};
use super::expr::{Role, error_expr};
use super::family::{FactForm, Family};
use super::scope::Scope;
use super::typed::{DefId, DefKind, Expr, FactsDef, LatticeDef, NodeRef, TrussBody, TrussClause, TrussDef};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, code};
use crate::syntax::ast::{self, PathStep, TrussClauseKind};
use crate::units::Dimension;
use std::sync::Arc;

impl<'a> Checker<'a> {
    /// Returns the typed body of a `cell` or `strut`. Facts of its family that are missing, given twice or of another
    /// dimension are reported.
    pub(super) fn check_facts(&mut self, id: DefId, facts: &'a ast::Facts) -> DefKind {
        let known = Family::from(facts.family).facts();
        let signature = self.signature(id);
        let mut scope = Scope::new(self.def(id).file, Some(id));
        let params = self.typed_params(&mut scope, &facts.params, &signature.params, false);
        let members = self.typed_members(id);
        let mut values: Vec<Option<Expr>> = vec![None; known.len()];
        for (name, value) in &facts.facts {
            let Some(index) = known.iter().position(|fact| fact.name == name.text.as_str()) else {
                let names: Vec<&str> = known.iter().map(|fact| fact.name).collect();
                let mut d = Diagnostic::error(code::UNKNOWN_MEMBER, format!("no fact `{}` here", name.text))
                    .label(name.span, format!("one of {} is wanted", names.join(", ")));
                if let Some(near) = suggest(name.text.as_str(), names) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
                continue;
            };
            if values[index].is_some() {
                self.report(
                    Diagnostic::error(code::DECLARED_TWICE, format!("`{}` is given twice", name.text))
                        .label(name.span, "given again here"),
                );
            }
            let quantity = Type::Quantity(known[index].dimension);
            let want = match known[index].form {
                FactForm::Positive => quantity,
                FactForm::PositiveRange => Type::Range(Arc::new(quantity)),
                FactForm::Truth => Type::Bool,
            };
            values[index] = Some(self.expect(&mut scope, value, &want, Role::Param(name.text)));
        }
        let missing: Vec<&str> = known
            .iter()
            .zip(&values)
            .filter(|(fact, v)| fact.required && v.is_none())
            .map(|(fact, _)| fact.name)
            .collect();
        if !missing.is_empty() {
            let (name, span) = (self.def(id).name, self.def(id).span);
            self.report(
                Diagnostic::error(
                    code::BAD_MODULE,
                    format!("`{name}` does not state {}", missing.join(", ")),
                )
                .label(span, "facts are missing"),
            );
        }
        DefKind::Facts(FactsDef {
            family: facts.family,
            params,
            members,
            facts: values,
            frame: scope.frame(),
        })
    }

    /// Returns the declaration after `of`; `None` (and a diagnostic) if it is not of the family.
    fn of(&mut self, file: usize, path: &[ast::Name], family: Family) -> Option<DefId> {
        let last = path[path.len() - 1];
        let span = path[0].span.to(last.span);
        let wanted = family.word();
        match self.path_entity(file, path) {
            Some(Entity::Def(id)) if self.family(id) == Some(family) => return Some(id),
            Some(Entity::Error) => return None,
            Some(_) => self.report(
                Diagnostic::error(code::NOT_A_TYPE, format!("`{}` is no {wanted}", last.text))
                    .label(span, format!("a {wanted} is wanted here")),
            ),
            None => {
                let mut d = Diagnostic::error(code::NOT_A_TYPE, format!("`{}` is not known here", last.text))
                    .label(span, format!("a {wanted} is wanted here"));
                if let Some(import) = self.import_hint(file, last.text).filter(|_| path.len() == 1) {
                    d = d.hint(import);
                } else if let Some(near) = suggest(last.text.as_str(), self.visible_names(file)) {
                    d = d.hint(format!("`{near}`?"));
                }
                self.report(d);
            }
        }
        None
    }

    /// Returns the typed body of a `lattice`; [`DefKind::Error`], after a report, if its cell is unknown.
    pub(super) fn check_lattice(&mut self, id: DefId, lattice: &'a ast::Lattice) -> DefKind {
        let signature = self.signature(id);
        let file = self.def(id).file;
        let mut scope = Scope::new(file, Some(id));
        let params = self.typed_params(&mut scope, &lattice.params, &signature.params, false);
        let members = self.typed_members(id);
        let of = self.of(file, &lattice.of, Family::Cell);
        let value = self.expect(&mut scope, &lattice.value, &Type::Cells, Role::Place("a lattice"));
        let Some(of) = of else { return DefKind::Error };
        DefKind::Lattice(LatticeDef { params, members, of, value, frame: scope.frame() })
    }

    /// Returns the typed body of a `truss`; [`DefKind::Error`], after a report, if its strut is unknown.
    pub(super) fn check_truss(&mut self, id: DefId, truss: &'a ast::Truss) -> DefKind {
        let signature = self.signature(id);
        let file = self.def(id).file;
        let mut scope = Scope::new(file, Some(id));
        let params = self.typed_params(&mut scope, &truss.params, &signature.params, false);
        let members = self.typed_members(id);
        let of = self.of(file, &truss.of, Family::Strut);
        let body = match &truss.body {
            ast::TrussBody::Value(e) => {
                let frame = self.prelude_def("Frame").map_or(Type::Error, Type::Record);
                TrussBody::Value(Box::new(self.expect(&mut scope, e, &frame, Role::Place("a truss"))))
            }
            ast::TrussBody::Clauses(clauses) => {
                TrussBody::Clauses(self.truss_clauses(&mut scope, id, clauses, true))
            }
        };
        let Some(of) = of else { return DefKind::Error };
        let frame = scope.frame().max(self.member_frame(id));
        DefKind::Truss(TrussDef { params, members, of, body, frame })
    }

    /// Checks the clauses of a truss; `top` is true outside of loops and conditions.
    fn truss_clauses(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        clauses: &'a [ast::TrussClause],
        top: bool,
    ) -> Vec<TrussClause> {
        let mark = scope.open();
        let out = clauses.iter().filter_map(|c| self.truss_clause(scope, id, c, top)).collect();
        scope.close(mark);
        out
    }

    /// Checks one clause of a truss; `None` for a `let` at the top, which is a member, and for an error.
    fn truss_clause(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        clause: &'a ast::TrussClause,
        top: bool,
    ) -> Option<TrussClause> {
        Some(match &clause.kind {
            TrussClauseKind::Node { name, index, value } => {
                let member = *self.members(id).index.get(&name.text)?;
                TrussClause::Node {
                    member,
                    index: index
                        .as_ref()
                        .map(|e| self.expect(scope, e, &Type::Int, Role::Place("the index of a node"))),
                    value: self.expect(scope, value, &Type::vec3(Dimension::LENGTH), Role::Place("a node")),
                    span: name.span,
                }
            }
            TrussClauseKind::Strut { a, b } => TrussClause::Strut {
                a: self.node_ref(scope, id, a)?,
                b: self.node_ref(scope, id, b)?,
                span: clause.span,
            },
            // A `let` at the top is a member.
            TrussClauseKind::Let(_) if top => return None,
            TrussClauseKind::Let(x) => {
                let value = self.let_value(scope, x);
                TrussClause::Let { local: scope.bind(x.name.text, value.ty.clone()), value }
            }
            TrussClauseKind::Require(r) => TrussClause::Require(self.require(scope, r)),
            TrussClauseKind::If { condition, then, otherwise } => TrussClause::If {
                condition: self.expect(scope, condition, &Type::Bool, Role::Place("the condition")),
                then: self.truss_clauses(scope, id, then, false),
                otherwise: self.truss_clauses(scope, id, otherwise, false),
            },
            TrussClauseKind::For { binder, iterable, body } => {
                let (iterable, element) = self.iterable(scope, iterable);
                let mark = scope.open();
                let binder = scope.bind(binder.text, element);
                let body = self.truss_clauses(scope, id, body, false);
                scope.close(mark);
                TrussClause::For { binder, iterable, body }
            }
            TrussClauseKind::Error => return None,
        })
    }

    /// Checks a reference to a node; `None` (and a diagnostic) for an unknown one.
    fn node_ref(&mut self, scope: &mut Scope, id: DefId, path: &'a ast::Path) -> Option<NodeRef> {
        let members = self.members(id);
        let member = members.index.get(&path.root.text).copied();
        let kind = member.map(|m| members.list[m.0 as usize].kind);
        let (Some(member), Some(MemberInfoKind::Node { array })) = (member, kind) else {
            if self.is_unread(path.root.text) {
                return None;
            }
            let nodes = members.list.iter().filter(|m| matches!(m.kind, MemberInfoKind::Node { .. }));
            let names: Vec<&str> = nodes.map(|m| m.name.as_str()).collect();
            let mut d = Diagnostic::error(
                code::UNKNOWN_MEMBER,
                format!("no node `{}` in this truss", path.root.text),
            )
            .label(path.root.span, "a node is wanted here");
            if let Some(near) = suggest(path.root.text.as_str(), names) {
                d = d.hint(format!("`{near}`?"));
            }
            self.report(d);
            return None;
        };
        let index = match (path.steps.as_slice(), array) {
            ([], false) => None,
            ([PathStep::Index { index, .. }], true) => {
                Some(self.expect(scope, index, &Type::Int, Role::Place("the index of a node")))
            }
            _ => {
                let hint =
                    if array { "name one node of the array: `ring[0]`" } else { "a node has no parts" };
                self.report(
                    Diagnostic::error(code::TYPE_MISMATCH, "a strut joins two nodes")
                        .label(path.span, "a node is wanted here")
                        .hint(hint),
                );
                Some(error_expr(path.span))
            }
        };
        Some(NodeRef { member, index, span: path.span })
    }
}
