//! Clauses that only a scene has: places of its parts, obstacles, and the world of its plans.

use super::checker::{Checker, DefItem, MemberInfoKind, Members};
use super::expr::Role;
use super::scope::Scope;
use super::typed::{DefId, Expr, Obstacle, Placement};
use super::types::Type;
use crate::source::{Diagnostic, Span, code};
use crate::syntax::ast::{self, ConfigClauseKind};

impl<'a> Checker<'a> {
    /// Returns true if a declaration is a scene. Panics if there is none of this identity.
    pub(super) fn is_scene(&self, id: DefId) -> bool {
        matches!(self.def(id).item, DefItem::Config(config) if config.scene)
    }

    /// Returns the typed place of a part; `None` where none is written, and (with a report) in a configuration that is
    /// no scene. `id`: the declaration that has the part.
    pub(super) fn part_place(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        part: &'a ast::Part,
    ) -> Option<Placement> {
        let at = part.at.as_ref()?;
        let place = self.placement(scope, at);
        self.need_scene(
            id,
            at.span,
            "`at` places the robots of a `scene`",
            "connections place the parts of a robot",
        )
        .then_some(place)
    }

    /// Returns the typed `obstacle` clause; `None` (and a diagnostic) in a configuration that is no scene. `id`: the
    /// declaration that has it; `span`: that of the clause. Panics on another clause.
    pub(super) fn obstacle(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        clause: &'a ConfigClauseKind,
        span: Span,
    ) -> Option<Obstacle> {
        let ConfigClauseKind::Obstacle { name, index, value, at } = clause else {
            unreachable!("only obstacles are asked for")
        };
        self.lint_snake(name.text, name.span, "obstacles");
        let index = index
            .as_ref()
            .map(|index| self.expect(scope, index, &Type::Int, Role::Place("the index of an obstacle")));
        let value = self.expect(scope, value, &Type::Shape, Role::Place("an obstacle"));
        let at = at.as_ref().map(|at| self.placement(scope, at));
        let member = self.members(id).index.get(&name.text).copied()?;
        let scene = self.need_scene(id, span, "only a `scene` has obstacles", "not in a configuration");
        scene.then_some(Obstacle { member, name: name.text, index, value, at, span: name.span })
    }

    /// Returns the typed line `world(...)`; `None` (and a diagnostic) in a configuration that is no scene. `id`: the
    /// declaration that has it.
    pub(super) fn surroundings(
        &mut self,
        scope: &mut Scope,
        id: DefId,
        world: &'a ast::Expr,
    ) -> Option<Expr> {
        let ty = self.prelude_def("World").map_or(Type::Error, Type::Record);
        let typed = self.expect(scope, world, &ty, Role::Place("the world of a scene"));
        let inside = "a plan of a robot takes it: `plan(behavior, world: world(...))`";
        self.need_scene(id, world.span, "only a `scene` has a `world`", inside).then_some(typed)
    }

    /// Adds the obstacles of a scene to its members, those in loops and conditions, too.
    pub(super) fn obstacle_members(&mut self, members: &mut Members<'a>, clause: &'a ast::ConfigClause) {
        match &clause.kind {
            ConfigClauseKind::Obstacle { name, index, .. } => {
                let array = index.is_some();
                let known = members.index.get(&name.text).map(|m| members.list[m.0 as usize].kind);
                if !(array && matches!(known, Some(MemberInfoKind::Obstacle { array: true }))) {
                    self.add_member(members, *name, MemberInfoKind::Obstacle { array });
                }
            }
            ConfigClauseKind::If { then, otherwise, .. } => {
                then.iter().chain(otherwise).for_each(|clause| self.obstacle_members(members, clause));
            }
            ConfigClauseKind::For { body, .. } => {
                body.iter().for_each(|clause| self.obstacle_members(members, clause));
            }
            _ => {}
        }
    }

    /// Reports what only a scene has; returns true in a scene.
    fn need_scene(&mut self, id: DefId, span: Span, message: &str, label: &str) -> bool {
        if self.is_scene(id) {
            return true;
        }
        let name = self.def(id).name;
        let declared = self.def(id).span;
        self.report(
            Diagnostic::error(code::SCENE_ONLY, message)
                .label(span, label)
                .label(declared, "a configuration is one robot")
                .hint(format!("`scene {name} {{ ... }}` has several robots, and what stands among them")),
        );
        false
    }
}
