//! The tree of expressions: operands, and a flat list of operators ordered by precedence climbing.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{HEIGHT_MAX, Node, Rule};
use crate::source::{Span, code};
use pest::iterators::Pairs;

/// An expression with the height of its syntax tree, in nodes.
pub(super) struct Tall {
    /// The expression.
    pub(super) expr: Expr,
    /// The height: 1 for a leaf, 0 for an error.
    pub(super) height: usize,
}

impl Tall {
    /// Returns an expression with the height of its tree: the number of nodes on the longest path from its root to a
    /// leaf, both counted.
    pub(super) fn new(span: Span, kind: ExprKind, height: usize) -> Tall {
        Tall { expr: Expr { span, kind }, height }
    }

    fn error(span: Span) -> Tall {
        Tall::new(span, ExprKind::Error, 0)
    }
}

/// The binding powers of operators, loosest first.
mod power {
    /// The binding power of `x => e`, as in a Pratt parser (Pratt 1973): operators of greater power bind tighter.
    pub(super) const LAMBDA: u8 = 1;
    /// The binding power of `or` and `else` (greater binds tighter).
    pub(super) const OR: u8 = 2;
    /// The binding power of `and` (greater binds tighter).
    pub(super) const AND: u8 = 3;
    /// The binding power of `not` (greater binds tighter).
    pub(super) const NOT: u8 = 4;
    /// The binding power of `==`, `<` and the other comparisons (greater binds tighter).
    pub(super) const COMPARISON: u8 = 5;
    /// The binding power of `<->`, which stands between two ports (greater binds tighter).
    pub(super) const MATED: u8 = 6;
    /// The binding power of `..`, which makes a range (greater binds tighter).
    pub(super) const RANGE: u8 = 7;
    /// The binding power of `++`, which joins lists or texts (greater binds tighter).
    pub(super) const JOIN: u8 = 8;
    /// The binding power of `+` and `-` between operands (greater binds tighter).
    pub(super) const SUM: u8 = 9;
    /// The binding power of `*`, `/` and `%` (greater binds tighter).
    pub(super) const PRODUCT: u8 = 10;
    /// The binding power of `+` and `-` before an operand (greater binds tighter).
    pub(super) const SIGN: u8 = 11;
    /// The binding power of `^` (greater binds tighter).
    pub(super) const POWER: u8 = 12;
}

/// An infix operator.
#[derive(Clone, Copy, PartialEq)]
enum Infix {
    Binary(BinaryOp),
    Range,
    Otherwise,
}

impl Builder<'_> {
    /// Builds an expression from its parse node; one that is nested too deeply is reported, and is an `Error` node.
    pub(super) fn expr(&mut self, node: Node) -> Expr {
        self.tall_expr(node).expr
    }

    /// Builds an expression from its parse node, with the height of its tree; one that is nested too deeply is
    /// reported, and is an `Error` node.
    pub(super) fn tall_expr(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        if self.depth >= HEIGHT_MAX {
            self.too_deep(span, "this expression");
            return Tall::error(span);
        }
        self.operators(&mut node.into_inner(), power::LAMBDA)
    }

    /// Builds an operand with its prefixes, and the operators after it that bind at least as strongly as `min`.
    fn operators(&mut self, nodes: &mut Pairs<Rule>, min: u8) -> Tall {
        self.depth += 1;
        let mut prefixes = Vec::new();
        while let Some(prefix) = next_if(nodes, Rule::prefix) {
            prefixes.push(self.prefix(prefix, min));
        }
        let mut left = self.operand(nodes, if prefixes.is_empty() { min } else { power::SIGN });
        for (op, op_span) in prefixes.into_iter().rev() {
            let min = if op == UnaryOp::Not { power::NOT } else { power::SIGN };
            let operand = self.infixes(left, nodes, min);
            let (span, height) = (op_span.to(operand.expr.span), operand.height);
            let kind = ExprKind::Unary { op, op_span, operand: Box::new(operand.expr) };
            left = self.grown(span, kind, height);
        }
        let whole = self.infixes(left, nodes, min);
        self.depth -= 1;
        whole
    }

    /// Returns a prefix operator; reports `!` and other foreign ones.
    fn prefix(&mut self, node: Node, min: u8) -> (UnaryOp, Span) {
        let span = self.span(&node);
        match node.as_str() {
            "-" => return (UnaryOp::Neg, span),
            "+" => return (UnaryOp::Plus, span),
            "!" => {
                self.error(code::SYNTAX, "modl writes `not` for `!`", span);
            }
            _ if min > power::NOT => {
                self.error(code::SYNTAX, "`not` binds looser than the operator before it", span)
                    .hints
                    .push("put the negation in brackets: `(not ...)`".into());
            }
            _ => {}
        }
        (UnaryOp::Not, span)
    }

    /// Builds the infix operators after a left operand.
    fn infixes(&mut self, mut left: Tall, nodes: &mut Pairs<Rule>, min: u8) -> Tall {
        let mut previous = None;
        while let Some(node) = nodes.peek() {
            if !matches!(node.as_rule(), Rule::op | Rule::word_op | Rule::sum_op | Rule::linear_op) {
                break;
            }
            let (op, strength) = infix(node.as_str());
            if strength < min {
                break;
            }
            nodes.next();
            let op_span = self.span(&node);
            let chained = self.check_infix(op, node.as_str(), op_span, previous, &left.expr);
            // Only `^` is right-associative.
            let right_min = if strength == power::POWER { strength } else { strength + 1 };
            let right = self.right_operand(nodes, right_min, op_span);
            if op == Infix::Binary(BinaryOp::Mated) {
                self.check_path(&left.expr);
                self.check_path(&right.expr);
            }
            left = self.joined(op, op_span, left, right);
            if chained {
                // A follow-up error about its operands is suppressed.
                left.expr.kind = ExprKind::Error;
            }
            previous = Some((strength, op_span));
        }
        left
    }

    /// Builds the right operand of an infix operator.
    fn right_operand(&mut self, nodes: &mut Pairs<Rule>, min: u8, op_span: Span) -> Tall {
        if self.depth >= HEIGHT_MAX {
            self.too_deep(op_span, "this expression");
            nodes.by_ref().for_each(drop);
            return Tall::error(op_span);
        }
        self.operators(nodes, min)
    }

    /// Returns the node of an operator and its operands.
    fn joined(&mut self, op: Infix, op_span: Span, left: Tall, right: Tall) -> Tall {
        let span = left.expr.span.to(right.expr.span);
        let height = left.height.max(right.height);
        let (left, right) = (Box::new(left.expr), Box::new(right.expr));
        let kind = match op {
            Infix::Binary(op) => ExprKind::Binary { op, op_span, left, right },
            Infix::Range => ExprKind::Range { from: left, to: right },
            Infix::Otherwise => ExprKind::Otherwise { value: left, otherwise: right },
        };
        self.grown(span, kind, height)
    }

    /// Reports mistakes that the grammar accepts so that they can be explained. Returns true if two
    /// operators of a kind that does not chain follow each other.
    fn check_infix(
        &mut self,
        op: Infix,
        text: &str,
        span: Span,
        previous: Option<(u8, Span)>,
        left: &Expr,
    ) -> bool {
        match text {
            "&&" | "||" | "<>" | "**" => {
                let here = match text {
                    "&&" => "and",
                    "||" => "or",
                    "<>" => "!=",
                    _ => "^",
                };
                self.error(code::SYNTAX, format!("modl writes `{here}` for `{text}`"), span);
            }
            _ => {}
        }
        let strength = infix(text).1;
        let mut chained = false;
        if let Some((before, before_span)) = previous
            && before == strength
            && matches!(strength, power::COMPARISON | power::RANGE | power::MATED)
        {
            let first = &self.text[before_span.range()];
            let (message, hint) = match strength {
                power::COMPARISON => (
                    "comparisons do not chain",
                    format!("join two of them: `a {first} b and b {text} c`, or put one in brackets"),
                ),
                power::RANGE => ("a range has two ends", "put one of the ranges in brackets".to_string()),
                _ => ("`<->` joins two ports", "join two conditions with `and`".to_string()),
            };
            self.error(code::SYNTAX, message, span).hints.push(hint);
            chained = true;
        }
        if op == Infix::Otherwise && matches!(left.kind, ExprKind::If { otherwise: None, .. }) {
            self.error(code::SYNTAX, "a branch of `if` stands in `{ }`", span)
                .hints
                .push("write `if c { a } else { b }`".into());
        }
        chained
    }

    /// Reports an operand that is no path where one is needed.
    fn check_path(&mut self, expr: &Expr) {
        let mut at = expr;
        loop {
            at = match &at.kind {
                ExprKind::Name(_) | ExprKind::Error => return,
                ExprKind::Field { object, .. } | ExprKind::Index { object, .. } => object,
                _ => break,
            };
        }
        self.error(code::SYNTAX, "`<->` stands between two ports", expr.span)
            .hints
            .push("a port is written as a path, such as `body.side[0]`".into());
    }

    /// Builds a primary expression with the calls, indices and fields that follow it.
    fn operand(&mut self, nodes: &mut Pairs<Rule>, min: u8) -> Tall {
        let node = next(nodes);
        if nodes.peek().is_some_and(|next| next.as_rule() == Rule::arrow) {
            return self.lambda(node, nodes, min);
        }
        let mut tall = self.primary(node);
        while let Some(node) = nodes.peek() {
            tall = match node.as_rule() {
                Rule::args => self.call(tall, node),
                Rule::index => self.index(tall, node),
                Rule::field => self.field(tall, node),
                Rule::with => self.with(tall, node),
                _ => break,
            };
            nodes.next();
        }
        tall
    }

    fn call(&mut self, callee: Tall, node: Node) -> Tall {
        let span = callee.expr.span.to(self.span(&node));
        let (args, height) = self.tall_args(node);
        let kind = ExprKind::Call { callee: Box::new(callee.expr), args };
        self.grown(span, kind, height.max(callee.height))
    }

    fn index(&mut self, object: Tall, node: Node) -> Tall {
        let span = object.expr.span.to(self.span(&node));
        let index = self.tall_expr(next(&mut node.into_inner()));
        let height = index.height.max(object.height);
        let kind = ExprKind::Index { object: Box::new(object.expr), index: Box::new(index.expr) };
        self.grown(span, kind, height)
    }

    fn field(&mut self, object: Tall, node: Node) -> Tall {
        let span = object.expr.span.to(self.span(&node));
        let field = self.word(next(&mut node.into_inner()));
        self.grown(span, ExprKind::Field { object: Box::new(object.expr), field }, object.height)
    }

    /// Builds the changed copy of a record.
    fn with(&mut self, object: Tall, node: Node) -> Tall {
        let span = object.expr.span.to(self.span(&node));
        let (fields, height) = self.tall_args(node);
        let kind = ExprKind::With { object: Box::new(object.expr), fields };
        self.grown(span, kind, height.max(object.height))
    }

    /// Builds the arguments of a call, in order, from their parse node.
    pub(super) fn args(&mut self, node: Node) -> Vec<Arg> {
        self.tall_args(node).0
    }

    /// Builds arguments with their greatest height.
    fn tall_args(&mut self, node: Node) -> (Vec<Arg>, usize) {
        let mut nodes = node.into_inner();
        let mut args = Vec::new();
        let mut height = 0;
        while let Some(node) = nodes.next() {
            let (name, value) = match node.as_rule() {
                Rule::label => (Some(self.label(node)), next(&mut nodes)),
                _ => (None, node),
            };
            let value = self.tall_expr(value);
            height = height.max(value.height);
            args.push(Arg { name, value: value.expr });
        }
        (args, height)
    }

    /// Returns the name in front of an argument.
    fn label(&mut self, node: Node) -> Name {
        let start = node.as_span().start();
        let length =
            super::build_types::run(node.as_str().as_bytes(), 0, |b| b.is_ascii_alphanumeric() || b == b'_');
        let span = self.at(start, start + length);
        let name = Name { text: self.symbol(span), span };
        if node.as_str().ends_with('=') {
            let end = node.as_span().end();
            let equals = self.at(end - 1, end);
            self.error(code::SYNTAX, "a named argument is written with `:`, not with `=`", equals)
                .hints
                .push(format!("write `{}: ...`", name.text));
        }
        name
    }

    /// Builds a primary expression.
    fn primary(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        match node.as_rule() {
            Rule::number => {
                let kind = self.number(span);
                Tall::new(span, kind, 1)
            }
            Rule::raw_text => {
                let text = super::build_text::raw(node.as_str());
                let parts = if text.is_empty() { Vec::new() } else { vec![TextPart::Literal(text)] };
                Tall::new(span, ExprKind::Text(parts), 1)
            }
            Rule::text => self.text(node),
            Rule::list => self.list(node),
            Rule::paren => self.paren(node),
            Rule::if_chain => self.if_expr(node),
            _ => {
                let kind = self.name_or_constant(span);
                Tall::new(span, kind, 1)
            }
        }
    }

    /// Returns a name, a constant or an axis.
    fn name_or_constant(&mut self, span: Span) -> ExprKind {
        if self.faulty_value == Some(span.start as usize) {
            return ExprKind::Error;
        }
        match &self.text[span.range()] {
            "true" => ExprKind::Bool(true),
            "false" => ExprKind::Bool(false),
            "X" => ExprKind::Axis(Axis::X),
            "Y" => ExprKind::Axis(Axis::Y),
            "Z" => ExprKind::Axis(Axis::Z),
            "_" => ExprKind::Hole,
            _ => ExprKind::Name(self.symbol(span)),
        }
    }

    /// Builds an expression in parentheses; reports a tuple.
    fn paren(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        let mut values = node.into_inner().map(|value| self.tall_expr(value)).collect::<Vec<_>>();
        if values.len() == 1 {
            let value = values.pop().expect("there is one");
            return Tall { expr: Expr { span, ..value.expr }, height: value.height };
        }
        let hint = if values.is_empty() {
            "`() => e` is a function without parameters"
        } else {
            "a list is written `[a, b]`"
        };
        self.error(code::SYNTAX, "round brackets hold one expression", span).hints.push(hint.into());
        Tall::error(span)
    }

    /// Builds a lambda.
    fn lambda(&mut self, node: Node, nodes: &mut Pairs<Rule>, min: u8) -> Tall {
        let start = self.span(&node);
        if min > power::LAMBDA {
            self.error(code::SYNTAX, "a function behind an operator stands in brackets", start)
                .hints
                .push("write `(x => ...)`".into());
        }
        let params = self.lambda_params(node);
        let arrow = self.span(&next(nodes));
        let body = match next_if(nodes, Rule::block) {
            Some(block) => self.block(block),
            None => self.right_operand(nodes, power::LAMBDA, arrow),
        };
        let span = start.to(body.expr.span);
        self.grown(span, ExprKind::Lambda { params, body: Box::new(body.expr) }, body.height)
    }

    /// Returns the parameters of a lambda.
    fn lambda_params(&mut self, node: Node) -> Vec<Name> {
        if node.as_rule() != Rule::paren {
            return self.lambda_param(node).into_iter().collect();
        }
        let exprs = node.into_inner();
        exprs
            .filter_map(|expr| {
                let span = self.span(&expr);
                let mut nodes = expr.into_inner();
                let name = next(&mut nodes);
                match nodes.next() {
                    None => self.lambda_param(name),
                    Some(_) => self.not_a_param(span),
                }
            })
            .collect()
    }

    fn lambda_param(&mut self, node: Node) -> Option<Name> {
        match node.as_rule() {
            Rule::name => Some(self.declared(node)),
            _ => {
                let span = self.span(&node);
                self.not_a_param(span)
            }
        }
    }

    /// Reports something else than a name in front of `=>`; always `None`.
    fn not_a_param(&mut self, span: Span) -> Option<Name> {
        self.error(code::SYNTAX, "what stands before `=>` must be a name", span)
            .hints
            .push("write `x => ...` or `(a, b) => ...`".into());
        None
    }

    /// Builds a list or a comprehension.
    fn list(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        let mut values = Vec::new();
        let mut clauses = Vec::new();
        let mut height = 0;
        for node in node.into_inner() {
            match node.as_rule() {
                Rule::each => {
                    let (binder, iterable) = self.each(node);
                    height = height.max(iterable.height);
                    clauses.push(ComprehensionClause::For { binder, iterable: iterable.expr });
                }
                Rule::filter => {
                    let condition = self.tall_expr(next(&mut node.into_inner()));
                    height = height.max(condition.height);
                    clauses.push(ComprehensionClause::If(condition.expr));
                }
                _ => {
                    let value = self.tall_expr(node);
                    height = height.max(value.height);
                    values.push(value.expr);
                }
            }
        }
        let kind = if clauses.is_empty() {
            ExprKind::List(values)
        } else {
            let body = Box::new(values.pop().expect("a comprehension has a body"));
            ExprKind::Comprehension { body, clauses }
        };
        self.grown(span, kind, height)
    }

    /// Builds `for name in iterable`.
    fn each(&mut self, node: Node) -> (Name, Tall) {
        let mut nodes = node.into_inner();
        let binder = self.declared(next(&mut nodes));
        (binder, self.tall_expr(next(&mut nodes)))
    }

    /// Returns the expression `kind` with its height: one more than `height`, that of its highest subtree. From
    /// [`HEIGHT_MAX`] on it is reported, once for each piece of text, and is an `Error` node.
    pub(super) fn grown(&mut self, span: Span, kind: ExprKind, height: usize) -> Tall {
        if height >= HEIGHT_MAX {
            self.too_deep(span, "this expression");
            return Tall::error(span);
        }
        Tall::new(span, kind, height + 1)
    }

    /// Reports that `what`, such as "this type", is nested too deeply, once for each piece of text.
    pub(super) fn too_deep(&mut self, span: Span, what: &str) {
        if self.deep_reported.replace(self.base) != Some(self.base) {
            self.error(code::TOO_DEEP, format!("{what} is nested too deeply"), span)
                .hints
                .push(format!("give parts of it names with `let`; the limit is {HEIGHT_MAX} levels"));
        }
    }
}

/// Returns the operator of a text with its binding power.
fn infix(text: &str) -> (Infix, u8) {
    use BinaryOp::*;
    let (op, strength) = match text {
        "else" => return (Infix::Otherwise, power::OR),
        ".." => return (Infix::Range, power::RANGE),
        "or" | "||" => (Or, power::OR),
        "and" | "&&" => (And, power::AND),
        "==" => (Eq, power::COMPARISON),
        "!=" | "<>" => (Ne, power::COMPARISON),
        "<" => (Lt, power::COMPARISON),
        "<=" => (Le, power::COMPARISON),
        ">" => (Gt, power::COMPARISON),
        ">=" => (Ge, power::COMPARISON),
        "<->" => (Mated, power::MATED),
        "++" => (Join, power::JOIN),
        "+" => (Add, power::SUM),
        "-" => (Sub, power::SUM),
        "*" => (Mul, power::PRODUCT),
        "/" => (Div, power::PRODUCT),
        "%" => (Rem, power::PRODUCT),
        _ => (Pow, power::POWER),
    };
    (Infix::Binary(op), strength)
}
