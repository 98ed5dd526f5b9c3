//! The tree of connectors, modules, cells and struts.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{Node, Rule};
use crate::source::code;

impl Builder<'_> {
    /// Builds the syntax tree of a `connector` from its parse node.
    pub(super) fn connector(&mut self, node: Node) -> Connector {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        Connector { name, clauses: nodes.map(|clause| self.connector_clause(clause)).collect() }
    }

    fn connector_clause(&mut self, node: Node) -> ConnectorClause {
        let rule = node.as_rule();
        let span = self.span(&node);
        let mut nodes = node.into_inner();
        match rule {
            Rule::mates => ConnectorClause::Mates(nodes.map(|name| self.word(name)).collect()),
            Rule::turns => ConnectorClause::Turns(self.expr(next(&mut nodes))),
            Rule::holds => ConnectorClause::Holds(self.expr(next(&mut nodes))),
            Rule::capture => {
                let keyword = crate::source::Span { end: span.start + "capture".len() as u32, ..span };
                let distance = self.expr(next(&mut nodes));
                let more = nodes.map(|more| self.expr(more)).collect();
                ConnectorClause::Capture { keyword, distance, more }
            }
            Rule::snap => ConnectorClause::Snap,
            _ => {
                let keyword = crate::source::Span { end: span.start + "hinge".len() as u32, ..span };
                ConnectorClause::Hinge { keyword, args: self.args(next(&mut nodes)) }
            }
        }
    }

    /// Builds the syntax tree of a `cell` or `strut`, as `family` says, from its parse node.
    pub(super) fn facts(&mut self, family: FactsFamily, node: Node) -> Facts {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        let fact = |node: Node, this: &mut Self| {
            let mut nodes = node.into_inner();
            (this.word(next(&mut nodes)), this.expr(next(&mut nodes)))
        };
        Facts { family, name, params, facts: nodes.map(|node| fact(node, self)).collect() }
    }

    /// Builds the syntax tree of a `module` from its parse node.
    pub(super) fn module(&mut self, node: Node) -> Module {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        Module { name, params, clauses: self.module_clauses(next(&mut nodes)) }
    }

    /// Builds the clauses of a module, in order, from the parse node of its body.
    pub(super) fn module_clauses(&mut self, body: Node) -> Vec<ModuleClause> {
        let nodes = body.into_inner().filter(|node| node.as_rule() != Rule::EOI);
        nodes.map(|node| self.module_clause(node)).collect()
    }

    fn module_clause(&mut self, node: Node) -> ModuleClause {
        let span = self.span(&node);
        let rule = node.as_rule();
        if rule == Rule::module_if {
            return self.module_if(node);
        }
        let kind = match rule {
            Rule::let_item => ModuleClauseKind::Let(self.let_item(node)),
            Rule::require => ModuleClauseKind::Require(self.require(node)),
            Rule::port => ModuleClauseKind::Port(self.module_port(node)),
            Rule::link => self.link(node),
            Rule::joint => self.joint(node),
            _ => self.short_clause(node),
        };
        ModuleClause { span, doc: self.doc(span.start), kind }
    }

    /// Builds a clause of one or two expressions.
    fn short_clause(&mut self, node: Node) -> ModuleClauseKind {
        let rule = node.as_rule();
        let mut nodes = node.into_inner();
        let first = next(&mut nodes);
        match rule {
            Rule::mass => ModuleClauseKind::Mass(self.expr(first)),
            Rule::touch => ModuleClauseKind::Touch(self.expr(first)),
            Rule::contact => ModuleClauseKind::Contact(self.expr(first)),
            Rule::touching => ModuleClauseKind::Touching(self.word(first), self.word(next(&mut nodes))),
            Rule::alias => {
                ModuleClauseKind::Alias { name: self.declared(first), target: self.word(next(&mut nodes)) }
            }
            Rule::motor => {
                let name = self.declared(first);
                let value = self.expr(next(&mut nodes));
                let args = nodes.next().map(|args| self.args(args)).unwrap_or_default();
                ModuleClauseKind::Motor { name, value, args }
            }
            _ => {
                let binder = self.declared(first);
                let iterable = self.expr(next(&mut nodes));
                ModuleClauseKind::For { binder, iterable, body: self.module_clauses(next(&mut nodes)) }
            }
        }
    }

    fn link(&mut self, node: Node) -> ModuleClauseKind {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let shape = self.expr(next(&mut nodes));
        let (mut collides, mut at) = (None, None);
        for node in nodes {
            let span = self.span(&node);
            let twice = match node.as_rule() {
                Rule::collides => collides.replace(self.expr(next(&mut node.into_inner()))).is_some(),
                _ => at.replace(self.placement(node)).is_some(),
            };
            if twice {
                self.error(code::SYNTAX, "a link has one place and one shape to collide with", span);
            }
        }
        ModuleClauseKind::Link { name, shape, collides, at }
    }

    fn joint(&mut self, node: Node) -> ModuleClauseKind {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let second = next(&mut nodes);
        if second.as_rule() != Rule::name {
            return ModuleClauseKind::Mimic { name, value: self.expr(second) };
        }
        let parent = self.word(second);
        let child = self.word(next(&mut nodes));
        let kind = self.expr(next(&mut nodes));
        let at = nodes.next().map(|at| self.placement(at));
        ModuleClauseKind::Joint { name, parent, child, kind, at }
    }

    fn module_port(&mut self, node: Node) -> ModulePort {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let index = next_if(&mut nodes, Rule::index).map(|index| self.index_expr(index));
        let connector = self.words(next(&mut nodes));
        let link = self.word(next(&mut nodes));
        let at = next_if(&mut nodes, Rule::placement).map(|at| self.placement(at));
        let mut direction = |node: Node| self.expr(next(&mut node.into_inner()));
        let facing = direction(next(&mut nodes));
        let up = nodes.next().map(direction);
        ModulePort { name, index, connector, link, at, facing, up }
    }

    /// Builds a placement from its parse node.
    pub(super) fn placement(&mut self, node: Node) -> Placement {
        let span = self.span(&node);
        let mut nodes = node.into_inner();
        let position = self.expr(next(&mut nodes));
        let turned = nodes.map(|turned| self.args(next(&mut turned.into_inner()))).collect();
        Placement { span, position, turned }
    }

    /// Builds the expression between `[` and `]` from the parse node of the brackets.
    pub(super) fn index_expr(&mut self, node: Node) -> Expr {
        self.expr(next(&mut node.into_inner()))
    }

    fn module_if(&mut self, node: Node) -> ModuleClause {
        let span = self.span(&node);
        let doc = self.doc(span.start);
        let Some((branches, last)) = self.branches(node) else {
            return ModuleClause { span, doc, kind: ModuleClauseKind::Error };
        };
        let mut otherwise = last.map(|(_, body)| self.module_clauses(body)).unwrap_or_default();
        for (start, condition, body) in branches.into_iter().rev() {
            let condition = self.expr(condition);
            let then = self.module_clauses(body);
            let kind = ModuleClauseKind::If { condition, then, otherwise };
            let span = crate::source::Span { start, ..span };
            otherwise = vec![ModuleClause { span, doc: None, kind }];
        }
        let mut whole = otherwise.pop().expect("there is a first branch");
        whole.doc = doc;
        whole
    }
}
