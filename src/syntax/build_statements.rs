//! The tree of statements, blocks and `if`.

use super::ast::*;
use super::build::{Builder, next, next_if, whole_characters};
use super::build_expr::Tall;
use super::parse::{Node, Rule};
use crate::source::Span;

/// A statement with the height of its tree.
type TallStmt = (Stmt, usize);

impl Builder<'_> {
    /// Builds the statements of a test, a loop or a branch, in order, from the parse node of its block.
    pub(super) fn statements(&mut self, block: Node) -> Vec<Stmt> {
        self.tall_statements(block).0
    }

    fn tall_statements(&mut self, block: Node) -> (Vec<Stmt>, usize) {
        let mut statements: Vec<Stmt> = Vec::new();
        let mut height = 0;
        for node in block.into_inner().filter(|node| node.as_rule() != Rule::EOI) {
            let (statement, above) = self.statement(node, statements.last().map(|s| s.span));
            height = height.max(above);
            statements.push(statement);
        }
        (statements, height)
    }

    /// Builds a block `{ let a = ... newline expr }`, whose value is the last expression, from its parse node, with the
    /// height of its tree.
    pub(super) fn block(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        let mut nodes: Vec<Node> = node.into_inner().collect();
        let last = nodes.pop_if(|node| matches!(node.as_rule(), Rule::expr | Rule::if_chain));
        let mut statements: Vec<Stmt> = Vec::new();
        let mut height = 0;
        for node in nodes {
            let (statement, above) = self.statement(node, statements.last().map(|s| s.span));
            height = height.max(above);
            statements.push(statement);
        }
        let value = last.map(|node| {
            self.check_line_start(&node, statements.last().map(|s| s.span), LineStart::Value);
            let value = if node.as_rule() == Rule::expr { self.tall_expr(node) } else { self.if_expr(node) };
            height = height.max(value.height);
            Box::new(value.expr)
        });
        self.grown(span, ExprKind::Block { statements, value }, height)
    }

    /// Builds the expression or block after `=` from its parse node.
    pub(super) fn body(&mut self, node: Node) -> Expr {
        self.tall_body(node).expr
    }

    fn tall_body(&mut self, node: Node) -> Tall {
        if node.as_rule() == Rule::block { self.block(node) } else { self.tall_expr(node) }
    }

    /// Builds a statement, with the height of its tree, from its parse node. `before` is the span of the statement
    /// before it, `None` for the first.
    pub(super) fn statement(&mut self, node: Node, before: Option<Span>) -> TallStmt {
        let span = self.span(&node);
        let (kind, height) = match node.as_rule() {
            Rule::let_item => {
                let (item, height) = self.tall_let(node);
                (StmtKind::Let(item), height)
            }
            Rule::expect => {
                let (condition, message, height) = self.condition(node);
                (StmtKind::Expect { condition, message }, height)
            }
            Rule::require => {
                let (condition, message, height) = self.condition(node);
                (StmtKind::Require(Require { span, condition, message }), height)
            }
            Rule::ensure => {
                let (condition, message, height) = self.condition(node);
                (StmtKind::Ensure(Require { span, condition, message }), height)
            }
            Rule::if_chain => self.if_statement(node),
            Rule::for_loop => self.for_statement(node),
            _ => {
                let sound = self.check_line_start(&node, before, LineStart::Statement);
                let value = self.tall_expr(node);
                (if sound { StmtKind::Expr(value.expr) } else { StmtKind::Error }, value.height)
            }
        };
        (Stmt { span, kind }, height)
    }

    fn tall_let(&mut self, node: Node) -> (Let, usize) {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let ty = next_if(&mut nodes, Rule::type_expr).map(|ty| self.ty(ty));
        let value = self.tall_body(next(&mut nodes));
        (Let { name, ty, value: value.expr }, value.height)
    }

    /// Builds the syntax tree of a `let` from its parse node.
    pub(super) fn let_item(&mut self, node: Node) -> Let {
        self.tall_let(node).0
    }

    fn condition(&mut self, node: Node) -> (Expr, Option<Expr>, usize) {
        let mut nodes = node.into_inner();
        let condition = self.tall_expr(next(&mut nodes));
        let message = nodes.next().map(|message| self.tall_expr(message));
        let height = condition.height.max(message.as_ref().map_or(0, |message| message.height));
        (condition.expr, message.map(|message| message.expr), height)
    }

    /// Builds the syntax tree of a `require` from its parse node.
    pub(super) fn require(&mut self, node: Node) -> Require {
        let span = self.span(&node);
        let (condition, message, _) = self.condition(node);
        Require { span, condition, message }
    }

    fn for_statement(&mut self, node: Node) -> (StmtKind, usize) {
        let mut nodes = node.into_inner();
        let binder = self.declared(next(&mut nodes));
        let iterable = self.tall_expr(next(&mut nodes));
        let (body, height) = self.tall_statements(next(&mut nodes));
        let height = height.max(iterable.height);
        (StmtKind::For { binder, iterable: iterable.expr, body }, height)
    }

    fn if_statement(&mut self, node: Node) -> (StmtKind, usize) {
        let span = self.span(&node);
        let Some((branches, last)) = self.branches(node) else { return (StmtKind::Error, 0) };
        let (mut otherwise, mut height) =
            last.map_or((Vec::new(), 0), |(_, block)| self.tall_statements(block));
        let mut chain = None;
        for (start, condition, block) in branches.into_iter().rev() {
            if let Some((start, kind)) = chain.take() {
                otherwise = vec![Stmt { span: Span { start, ..span }, kind }];
            }
            let condition = self.tall_expr(condition);
            let (then, then_height) = self.tall_statements(block);
            height = height.max(condition.height).max(then_height) + 1;
            let otherwise = std::mem::take(&mut otherwise);
            chain = Some((start, StmtKind::If { condition: condition.expr, then, otherwise }));
        }
        let (_, kind) = chain.expect("there is a first branch");
        (kind, height)
    }

    /// Builds an `if` expression with its `else` branches from its parse node; more than
    /// [`NESTING_MAX`](super::parse::NESTING_MAX) branches are reported, and give an `Error` node.
    pub(super) fn if_expr(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        let Some((branches, last)) = self.branches(node) else {
            return Tall::new(span, ExprKind::Error, 0);
        };
        let mut otherwise = last.map(|(_, block)| self.block(block));
        for (start, condition, block) in branches.into_iter().rev() {
            let condition = self.tall_expr(condition);
            let then = self.block(block);
            let below = otherwise.as_ref().map_or(0, |otherwise| otherwise.height);
            let height = condition.height.max(then.height).max(below);
            let kind = ExprKind::If {
                condition: Box::new(condition.expr),
                then: Box::new(then.expr),
                otherwise: otherwise.map(|otherwise| Box::new(otherwise.expr)),
            };
            otherwise = Some(self.grown(Span { start, ..span }, kind, height));
        }
        otherwise.expect("there is a first branch")
    }

    /// Returns the conditions and bodies of `if a { } else if b { } else { }` as (offset in bytes of the file at which
    /// the branch begins, condition, body), in order, and the last body with its offset, `None` without a final
    /// `else`. The whole is `None`, after a report, if there are more than [`NESTING_MAX`](super::parse::NESTING_MAX)
    /// branches.
    #[allow(clippy::type_complexity)]
    pub(super) fn branches<'i>(
        &mut self,
        node: Node<'i>,
    ) -> Option<(Vec<(u32, Node<'i>, Node<'i>)>, Option<(u32, Node<'i>)>)> {
        let span = self.span(&node);
        let mut nodes = node.into_inner();
        let mut branches: Vec<(u32, Node<'i>, Node<'i>)> = Vec::new();
        while let Some(node) = nodes.next() {
            let start = if branches.is_empty() { span.start } else { self.span(&node).start };
            if node.as_rule() != Rule::expr {
                return Some((branches, Some((start, node))));
            }
            if branches.len() >= super::parse::NESTING_MAX {
                self.too_deep(span, "this chain of `else if`");
                return None;
            }
            branches.push((start, node, next(&mut nodes)));
        }
        Some((branches, None))
    }

    /// Reports an expression that begins with `+`, `-`, `(` or `[` right below another statement, which was
    /// meant to continue it. Returns true if it is accepted.
    fn check_line_start(&mut self, node: &Node, before: Option<Span>, place: LineStart) -> bool {
        let first = node.as_str().as_bytes()[0];
        let Some(before) = before.filter(|_| matches!(first, b'+' | b'-' | b'(' | b'[')) else { return true };
        let span = self.span(node);
        let between = &self.text[before.end as usize..span.start as usize];
        let adjacent = between.matches('\n').count() == 1 && !between.contains('/');
        let mistaken = match (first, place) {
            (b'+', _) => true,
            (b'-', LineStart::Statement) => true,
            (b'(', LineStart::Statement) => adjacent,
            (b'[', LineStart::Statement) => {
                adjacent && !node.clone().into_inner().flatten().any(|n| n.as_rule() == Rule::each)
            }
            _ => false,
        };
        if mistaken {
            let mark = whole_characters(self.text, Span { end: span.start + 1, ..span });
            self.diagnostics.push(super::explain::line_break(mark, first as char));
        }
        !mistaken
    }
}

/// The position of an expression that begins a line.
#[derive(Clone, Copy, PartialEq)]
enum LineStart {
    /// A statement, whose value is not used.
    Statement,
    /// The value of a block, which may well be `-a` or `[a, b]`.
    Value,
}
