//! The tree of types, parameters and units.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{NESTING_MAX, Node, Rule};
use crate::source::{Span, code};

impl Builder<'_> {
    /// Builds the parameters of a declaration, variadic ones included, from their parse node.
    pub(super) fn params(&mut self, node: Node) -> Vec<Param> {
        node.into_inner().map(|param| self.param(param)).collect()
    }

    fn param(&mut self, node: Node) -> Param {
        let mut nodes = node.into_inner();
        let name = self.word(next(&mut nodes));
        let ty = self.ty(next(&mut nodes));
        let variadic = next_if(&mut nodes, Rule::variadic).is_some();
        let default = nodes.next().map(|value| self.expr(value));
        Param { name, ty, default, variadic }
    }

    /// Builds the parameters of a function that is not native from their parse node; reports variadic ones and reserved
    /// names.
    pub(super) fn plain_params(&mut self, node: Node) -> Vec<Param> {
        let variadic = node.clone().into_inner().flat_map(Node::into_inner);
        let variadic: Vec<Span> =
            variadic.filter(|n| n.as_rule() == Rule::variadic).map(|n| self.span(&n)).collect();
        for span in variadic {
            self.error(code::SYNTAX, "only an `extern fn` takes any number of values", span)
                .hints
                .push("take a list: `bs: List<Behavior>`".into());
        }
        let params = self.params(node);
        for param in &params {
            self.refuse_reserved(param.name);
        }
        params
    }

    /// Reports a reserved word as the name of a parameter.
    fn refuse_reserved(&mut self, name: Name) {
        if super::words::is_reserved(name.text.as_str()) {
            self.error(
                code::SYNTAX,
                format!("`{}` is a reserved word and cannot be the name of a parameter", name.text),
                name.span,
            );
        }
    }

    /// Builds a type from its parse node; reports one that is nested too deeply.
    pub(super) fn ty(&mut self, node: Node) -> TypeExpr {
        let span = self.span(&node);
        if self.type_depth >= NESTING_MAX {
            self.too_deep(span, "this type");
            return TypeExpr { span, kind: TypeKind::Error };
        }
        self.type_depth += 1;
        let ty = self.choice(node, span);
        self.type_depth -= 1;
        ty
    }

    /// Builds a choice.
    fn choice(&mut self, node: Node, span: Span) -> TypeExpr {
        let mut choices: Vec<TypeExpr> = Vec::new();
        for node in node.into_inner() {
            if node.as_rule() == Rule::optional_mark {
                let marked = choices.pop().expect("a mark follows a type");
                choices.push(self.optional(marked, &node));
                continue;
            }
            let span = self.span(&node);
            let kind = match node.as_rule() {
                Rule::named_type => self.named_type(node),
                Rule::quantity_type => {
                    TypeKind::Quantity(self.unit(self.span(&next(&mut node.into_inner()))))
                }
                Rule::fn_type => self.fn_type(node),
                _ => self.ty(node).kind,
            };
            choices.push(TypeExpr { span, kind });
        }
        if choices.len() == 1 {
            return choices.pop().expect("there is one");
        }
        TypeExpr { span, kind: TypeKind::Choice(choices) }
    }

    /// Builds an optional type. `T??` is `T?`, so a run of marks does not nest.
    fn optional(&mut self, marked: TypeExpr, mark: &Node) -> TypeExpr {
        let span = marked.span.to(self.span(mark));
        match marked.kind {
            TypeKind::Optional(_) => TypeExpr { span, kind: marked.kind },
            _ => TypeExpr { span, kind: TypeKind::Optional(Box::new(marked)) },
        }
    }

    fn named_type(&mut self, node: Node) -> TypeKind {
        let mut path = Vec::new();
        let mut args = Vec::new();
        for node in node.into_inner() {
            match node.as_rule() {
                Rule::type_expr => args.push(self.ty(node)),
                _ => path.push(self.word(node)),
            }
        }
        TypeKind::Named { path, args }
    }

    fn fn_type(&mut self, node: Node) -> TypeKind {
        let mut params: Vec<TypeExpr> = node.into_inner().map(|ty| self.ty(ty)).collect();
        let result = Box::new(params.pop().expect("the result comes last"));
        TypeKind::Fn { params, result }
    }

    /// Builds the type parameters of a function, in order, from their parse node.
    pub(super) fn type_params(&mut self, node: Node) -> Vec<TypeParam> {
        let param = |node: Node, this: &mut Self| {
            let mut nodes = node.into_inner();
            let name = this.declared(next(&mut nodes));
            TypeParam { name, bound: nodes.next().map(|bound| this.word(bound)) }
        };
        node.into_inner().map(|node| param(node, self)).collect()
    }

    /// Builds a unit, a product of powers, from the text at its span: `N*m`, `m/s^2`, `1/s`.
    pub(super) fn unit(&mut self, span: Span) -> UnitExpr {
        let text = self.read[span.range()].as_bytes();
        let start = span.start as usize;
        let mut factors = Vec::new();
        let (mut at, mut sign) = if text[0] == b'1' { (2, -1) } else { (0, 1) };
        while at < text.len() {
            let name_end = run(text, at, |b| b.is_ascii_alphanumeric() || b == b'_');
            let span = Span::new(span.file, start + at, start + name_end);
            let name = Name { text: self.symbol(span), span };
            at = name_end;
            let mut exponent = 1;
            if text.get(at) == Some(&b'^') {
                let end = run(text, at + 1, |b| b.is_ascii_digit() || b == b'-');
                let exponent_span = Span::new(span.file, start + at + 1, start + end);
                exponent = self.exponent(exponent_span);
                at = end;
            }
            factors.push((name, sign * exponent));
            sign = if text.get(at) == Some(&b'/') { -1 } else { 1 };
            at += 1;
        }
        UnitExpr { span, factors }
    }

    /// Returns an exponent; reports one that is out of range.
    fn exponent(&mut self, span: Span) -> i32 {
        match self.read[span.range()].parse() {
            Ok(exponent @ -99..=99) => exponent,
            _ => {
                self.error(code::BAD_NUMBER, "an exponent of a unit lies between -99 and 99", span);
                1
            }
        }
    }
}

/// Returns the offset, in bytes, of the first byte at or after `start` that does not satisfy `fits`; the length of the
/// text if all do.
pub(super) fn run(text: &[u8], start: usize, fits: impl std::ops::Fn(u8) -> bool) -> usize {
    text[start..].iter().position(|b| !fits(*b)).map_or(text.len(), |length| start + length)
}
