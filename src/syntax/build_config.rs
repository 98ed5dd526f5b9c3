//! The tree of configurations.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{Node, Rule};
use crate::source::{Span, code};

impl Builder<'_> {
    /// Builds the syntax tree of a `config` or `scene` from its parse node.
    pub(super) fn config(&mut self, node: Node) -> Config {
        let scene = node.as_rule() == Rule::scene;
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        let closed = next_if(&mut nodes, Rule::closed).map(|closed| self.span(&closed));
        Config { scene, name, params, closed, clauses: self.config_clauses(next(&mut nodes)) }
    }

    /// Builds the clauses of a configuration, in order, from the parse node of its body.
    pub(super) fn config_clauses(&mut self, body: Node) -> Vec<ConfigClause> {
        let nodes = body.into_inner().filter(|node| node.as_rule() != Rule::EOI);
        nodes.map(|node| self.config_clause(node)).collect()
    }

    /// Builds a clause.
    fn config_clause(&mut self, node: Node) -> ConfigClause {
        let span = self.span(&node);
        let kind = match node.as_rule() {
            Rule::config_if => return self.config_if(node),
            Rule::part => ConfigClauseKind::Part(self.part(node)),
            Rule::config_port => self.config_port(node),
            Rule::base => ConfigClauseKind::Base(self.path(next(&mut node.into_inner()))),
            Rule::behavior => ConfigClauseKind::Behavior(self.behavior(node)),
            Rule::connect => self.connect(node),
            Rule::set => {
                let mut nodes = node.into_inner();
                let joint = self.path(next(&mut nodes));
                ConfigClauseKind::Set { joint, value: self.expr(next(&mut nodes)) }
            }
            Rule::let_item => ConfigClauseKind::Let(self.let_item(node)),
            Rule::require => ConfigClauseKind::Require(self.require(node)),
            Rule::obstacle => self.obstacle(node),
            Rule::surroundings => ConfigClauseKind::World(self.surroundings(node)),
            _ => self.config_for(node),
        };
        ConfigClause { span, doc: self.doc(span.start), kind }
    }

    /// Builds the clauses of a branch or a loop, where parts, ports and behaviours are refused.
    fn inner_clauses(&mut self, body: Node) -> Vec<ConfigClause> {
        let mut clauses = self.config_clauses(body);
        self.refuse_top_clauses(&mut clauses);
        clauses
    }

    /// Reports clauses inside `for` or `if` that are allowed only at the top of a configuration, and replaces them by
    /// `Error` nodes.
    pub(super) fn refuse_top_clauses(&mut self, clauses: &mut [ConfigClause]) {
        for clause in clauses {
            let (what, hint) = match &clause.kind {
                ConfigClauseKind::Part(_) => ("a part", "several parts are written `part leg[4]: Leg`"),
                ConfigClauseKind::Port { .. } => {
                    ("a port", "several ports are written `port side[4] = [...]`")
                }
                ConfigClauseKind::Base(_) => ("`base`", "write it beside the parts"),
                ConfigClauseKind::World(_) => {
                    ("`world`", "a choice stands inside it: `friction: if wet { 0.3 } else { 0.8 }`")
                }
                ConfigClauseKind::Behavior(_) => ("a behaviour", "a behaviour may have parameters"),
                _ => continue,
            };
            let message = format!("{what} stands at the top of the configuration, not in `if` or `for`");
            self.error(code::SYNTAX, message, clause.span).hints.push(hint.into());
            clause.kind = ConfigClauseKind::Error;
        }
    }

    fn part(&mut self, node: Node) -> Part {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let count = next_if(&mut nodes, Rule::part_count).map(|count| self.part_count(count));
        let ty = next(&mut nodes);
        let ty_span = self.span(&ty);
        let ty = self.words(ty);
        let args = next_if(&mut nodes, Rule::args).map(|args| self.args(args));
        Part { name, count, ty, args, at: nodes.next().map(|at| self.placement(at)), ty_span }
    }

    fn part_count(&mut self, node: Node) -> PartCount {
        let mut nodes = node.into_inner();
        match next_if(&mut nodes, Rule::name) {
            Some(binder) => {
                let binder = self.declared(binder);
                PartCount::Each { binder, range: self.expr(next(&mut nodes)) }
            }
            None => PartCount::Number(self.expr(next(&mut nodes))),
        }
    }

    fn obstacle(&mut self, node: Node) -> ConfigClauseKind {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let index = next_if(&mut nodes, Rule::index).map(|index| self.index_expr(index));
        let value = self.expr(next(&mut nodes));
        ConfigClauseKind::Obstacle { name, index, value, at: nodes.next().map(|at| self.placement(at)) }
    }

    /// Builds the line `world(...)` as a call of the built-in of that name.
    fn surroundings(&mut self, node: Node) -> Expr {
        let span = self.span(&node);
        let word = Span { end: span.start + "world".len() as u32, ..span };
        let callee = Expr { span: word, kind: ExprKind::Name(self.symbol(word)) };
        let args = self.args(next(&mut node.into_inner()));
        Expr { span, kind: ExprKind::Call { callee: Box::new(callee), args } }
    }

    fn config_port(&mut self, node: Node) -> ConfigClauseKind {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let count = next_if(&mut nodes, Rule::index).map(|count| self.index_expr(count));
        ConfigClauseKind::Port { name, count, value: self.expr(next(&mut nodes)) }
    }

    fn behavior(&mut self, node: Node) -> Behavior {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let params = self.params_if(&mut nodes);
        let mut allows = Vec::new();
        while let Some(exemption) = next_if(&mut nodes, Rule::exemption) {
            allows.push(self.exemption(exemption));
        }
        Behavior { name, params, allows, body: self.body(next(&mut nodes)) }
    }

    fn exemption(&mut self, node: Node) -> Exemption {
        let span = self.span(&node);
        let mut nodes = node.into_inner();
        let name = self.word(next(&mut nodes));
        Exemption { name, args: nodes.map(|arg| self.expr(arg)).collect(), span }
    }

    fn connect(&mut self, node: Node) -> ConfigClauseKind {
        let mut nodes = node.into_inner();
        let a = self.path(next(&mut nodes));
        let b = self.path(next(&mut nodes));
        ConfigClauseKind::Connect { a, b, turn: nodes.next().map(|turn| self.expr(turn)) }
    }

    /// Builds a path, a name with its steps, from its parse node.
    pub(super) fn path(&mut self, node: Node) -> Path {
        let span = self.span(&node);
        let mut nodes = node.into_inner();
        let root = self.word(next(&mut nodes));
        let step = |node: Node, this: &mut Self| match node.as_rule() {
            Rule::field => PathStep::Field(this.word(next(&mut node.into_inner()))),
            _ => PathStep::Index { span: this.span(&node), index: this.index_expr(node) },
        };
        Path { span, root, steps: nodes.map(|node| step(node, self)).collect() }
    }

    fn config_for(&mut self, node: Node) -> ConfigClauseKind {
        let mut nodes = node.into_inner();
        let binder = self.declared(next(&mut nodes));
        let iterable = self.expr(next(&mut nodes));
        ConfigClauseKind::For { binder, iterable, body: self.inner_clauses(next(&mut nodes)) }
    }

    fn config_if(&mut self, node: Node) -> ConfigClause {
        let span = self.span(&node);
        let doc = self.doc(span.start);
        let Some((branches, last)) = self.branches(node) else {
            return ConfigClause { span, doc, kind: ConfigClauseKind::Error };
        };
        let mut otherwise = last.map(|(_, body)| self.inner_clauses(body)).unwrap_or_default();
        for (start, condition, body) in branches.into_iter().rev() {
            let condition = self.expr(condition);
            let then = self.inner_clauses(body);
            let kind = ConfigClauseKind::If { condition, then, otherwise };
            otherwise = vec![ConfigClause { span: Span { start, ..span }, doc: None, kind }];
        }
        let mut whole = otherwise.pop().expect("there is a first branch");
        whole.doc = doc;
        whole
    }
}
