//! Contracts of behaviours: what they require of the state in which they begin, and what they ensure of their end.

use super::checker::Checker;
use super::expr::Role;
use super::scope::Scope;
use super::typed::{Contract, ContractKind, StmtKind};
use super::types::Type;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use std::sync::Arc;

/// The names that contracts know, with what they are in words.
const STATES: [(&str, &str); 3] = [
    ("start", "the state in which a behavior begins, which `require` and `ensure` know"),
    ("end", "the state in which a behavior ends, which `ensure` knows"),
    ("report", "what the judge says of a behavior's own interval, which `ensure` knows"),
];

impl<'a> Checker<'a> {
    /// Returns the statement of a `require` in a behaviour's own block: a contract if it names `start`, the state in which the
    /// behaviour begins; otherwise a condition on values. A program's own `start` keeps its meaning.
    pub(super) fn behavior_require(&mut self, scope: &mut Scope, r: &'a ast::Require) -> StmtKind {
        let mark = scope.open();
        let start = Symbol::new("start");
        let declared = scope.has_local(start)
            || scope.this.is_some_and(|this| self.declares(this, start))
            || self.entity(scope.file, start).is_some();
        let ty = self.prelude_record("State");
        let start = (!declared).then(|| scope.bind_of_contract(start, ty));
        scope.states_named = false;
        let typed = self.require(scope, r);
        scope.close(mark);
        if !scope.states_named {
            return StmtKind::Expect { condition: typed.condition, message: typed.message };
        }
        StmtKind::Contract(Arc::new(Contract {
            span: r.span,
            kind: ContractKind::Require,
            condition: typed.condition,
            message: typed.message,
            start,
            end: None,
            report: None,
        }))
    }

    /// Returns the statement of an `ensure`; `None`, after a report, for one that is not in a behaviour's own block.
    pub(super) fn ensure(&mut self, scope: &mut Scope, r: &'a ast::Require, own: bool) -> Option<StmtKind> {
        if !own {
            let message = "`ensure` stands in the block of a behavior, beside its `let` and `require`";
            self.report(
                Diagnostic::error(code::CONTRACT_PLACE, message).label(r.span, "nothing begins or ends here").hint(
                    "`behavior step() = {`, then `ensure end.com.x > 0mm` and the behavior on lines of their own, then `}`",
                ),
            );
            return None;
        }
        let mark = scope.open();
        let [start, end, report] = STATES.map(|(name, _)| {
            let ty = self.prelude_record(if name == "report" { "Report" } else { "State" });
            scope.bind_of_contract(Symbol::new(name), ty)
        });
        let condition = self.expect(scope, &r.condition, &Type::Bool, Role::Place("`ensure`"));
        let message =
            r.message.as_ref().map(|m| self.expect(scope, m, &Type::Text, Role::Place("the message")));
        scope.close(mark);
        Some(StmtKind::Contract(Arc::new(Contract {
            span: r.span,
            kind: ContractKind::Ensure,
            condition,
            message,
            start: Some(start),
            end: Some(end),
            report: Some(report),
        })))
    }

    /// Reports `start`, `end` or `report` in the body of a behaviour where no contract knows it; returns false for other names
    /// and places.
    pub(super) fn state_elsewhere(&mut self, scope: &Scope, name: Symbol, span: Span) -> bool {
        let state = STATES.iter().find(|(state, _)| name == *state);
        let Some((name, what)) = state.filter(|_| scope.in_behavior) else { return false };
        self.report(
            Diagnostic::error(code::CONTRACT_PLACE, format!("`{name}` is {what}"))
                .label(span, "not known when the behavior is made")
                .hint("`require` looks at `start`; `ensure` at `start`, `end` and `report`"),
        );
        true
    }

    /// Reports an `ensure` behind the behaviour of a block, which has no value then; returns true if there is one.
    pub(super) fn ensures_last(&mut self, body: &ast::Expr) -> bool {
        let ast::ExprKind::Block { statements, value: None } = &body.kind else { return false };
        let Some(ast::Stmt { kind: ast::StmtKind::Ensure(last), .. }) = statements.last() else {
            return false;
        };
        self.report(
            Diagnostic::error(
                code::CONTRACT_PLACE,
                "a block ends with its behavior, and this one with a contract",
            )
            .label(last.span, "this line is the last")
            .hint("put contracts before the behavior"),
        );
        true
    }

    /// Returns true if instances of a declaration have a member, joint or port of this name.
    fn declares(&mut self, this: super::typed::DefId, name: Symbol) -> bool {
        let members = self.members(this);
        members.index.contains_key(&name)
            || members.joint_index.contains_key(&name)
            || members.port_index.contains_key(&name)
    }

    /// Returns the type of a record of the prelude; an error type if the prelude could not be read.
    fn prelude_record(&self, name: &str) -> Type {
        self.prelude_def(name).map_or(Type::Error, Type::Record)
    }
}
