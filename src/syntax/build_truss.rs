//! The tree of lattices and trusses.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{Node, Rule};
use crate::source::Span;

impl Builder<'_> {
    /// Builds the syntax tree of a `lattice` from its parse node.
    pub(super) fn lattice(&mut self, node: Node) -> Lattice {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        let of = self.words(next(&mut nodes));
        Lattice { name, params, of, value: self.body(next(&mut nodes)) }
    }

    /// Builds the syntax tree of a `truss` from its parse node.
    pub(super) fn truss(&mut self, node: Node) -> Truss {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        let of = self.words(next(&mut nodes));
        let body = next(&mut nodes);
        let body = match body.as_rule() {
            Rule::truss_body => TrussBody::Clauses(self.truss_clauses(body)),
            _ => TrussBody::Value(self.body(body)),
        };
        Truss { name, params, of, body }
    }

    /// Builds the clauses of a truss, in order, from the parse node of its body.
    pub(super) fn truss_clauses(&mut self, body: Node) -> Vec<TrussClause> {
        let nodes = body.into_inner().filter(|node| node.as_rule() != Rule::EOI);
        nodes.map(|node| self.truss_clause(node)).collect()
    }

    fn truss_clause(&mut self, node: Node) -> TrussClause {
        let span = self.span(&node);
        let kind = match node.as_rule() {
            Rule::truss_if => return self.truss_if(node),
            Rule::let_item => TrussClauseKind::Let(self.let_item(node)),
            Rule::require => TrussClauseKind::Require(self.require(node)),
            Rule::node => self.truss_node(node),
            Rule::truss_strut => {
                let mut nodes = node.into_inner();
                let a = self.path(next(&mut nodes));
                TrussClauseKind::Strut { a, b: self.path(next(&mut nodes)) }
            }
            _ => {
                let mut nodes = node.into_inner();
                let binder = self.declared(next(&mut nodes));
                let iterable = self.expr(next(&mut nodes));
                TrussClauseKind::For { binder, iterable, body: self.truss_clauses(next(&mut nodes)) }
            }
        };
        TrussClause { span, kind }
    }

    fn truss_node(&mut self, node: Node) -> TrussClauseKind {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let index = next_if(&mut nodes, Rule::index).map(|index| self.index_expr(index));
        TrussClauseKind::Node { name, index, value: self.expr(next(&mut nodes)) }
    }

    fn truss_if(&mut self, node: Node) -> TrussClause {
        let span = self.span(&node);
        let Some((branches, last)) = self.branches(node) else {
            return TrussClause { span, kind: TrussClauseKind::Error };
        };
        let mut otherwise = last.map(|(_, body)| self.truss_clauses(body)).unwrap_or_default();
        for (start, condition, body) in branches.into_iter().rev() {
            let condition = self.expr(condition);
            let then = self.truss_clauses(body);
            let kind = TrussClauseKind::If { condition, then, otherwise };
            otherwise = vec![TrussClause { span: Span { start, ..span }, kind }];
        }
        otherwise.pop().expect("there is a first branch")
    }
}
