//! The places of a file that mutants change: a walk over its syntax tree.
//!
//! Constants, patterns, attributes, types, what macros are given, and tests are left out: there a value at run time can't
//! stand. So are implementations that only write text.

use crate::mutant::{Form, Mutant, Piece, spaced};
use crate::operators;
use proc_macro2::Span;
use std::collections::BTreeMap;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Expr, Lit, Stmt, UnOp};

/// Traits whose implementations write text or do nothing.
const TRAITS_OF_TEXT: &[&str] = &["Debug", "Display", "Error", "Serialize", "JsonSchema"];

/// Returns all mutants of a file in the order of their places; `name`: its name from the root of the project.
pub fn of_file(name: &str, text: &str) -> Result<Vec<Mutant>, String> {
    let tree = syn::parse_file(text).map_err(|why| format!("{name}: {why}"))?;
    let mut walk = Walk { name, text, scope: Vec::new(), found: Vec::new() };
    walk.visit_file(&tree);
    let mut found = walk.found;
    found.sort_by_key(|mutant| (mutant.range.start, usize::MAX - mutant.range.end));
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for mutant in &mut found {
        let count = seen.entry(mutant.key()).or_insert(0);
        mutant.ordinal = *count;
        *count += 1;
    }
    Ok(found)
}

struct Walk<'a> {
    name: &'a str,
    text: &'a str,
    /// The names of the types, modules and functions around.
    scope: Vec<String>,
    found: Vec<Mutant>,
}

impl Walk<'_> {
    fn within(&mut self, name: String, walk: impl FnOnce(&mut Self)) {
        self.scope.push(name);
        walk(self);
        self.scope.pop();
    }

    fn add(&mut self, operator: &'static str, span: Span, form: Form, pieces: Vec<Piece>) {
        let range = span.byte_range();
        let piece = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Source(range) => self.text[range.clone()].to_owned(),
        };
        let mutated = spaced(&pieces.iter().map(piece).collect::<String>());
        // The head of a body is behind its brace.
        let range = if form == Form::Head { range.end..range.end } else { range };
        self.found.push(Mutant {
            file: self.name.to_owned(),
            function: self.scope.join("::"),
            operator,
            line: span.start().line,
            original: spaced(&self.text[range.clone()]),
            range,
            form,
            pieces,
            mutated,
            ordinal: 0,
        });
    }

    fn replace(&mut self, operator: &'static str, span: Span, pieces: Vec<Piece>) {
        self.add(operator, span, Form::Expression, pieces);
    }

    fn function(&mut self, signature: &syn::Signature, body: &syn::Block, attributes: &[Attribute]) {
        if signature.constness.is_some() || of_tests(attributes) {
            return;
        }
        self.within(signature.ident.to_string(), |walk| {
            let after_brace = body.brace_token.span.open();
            for value in operators::early_returns(&signature.output) {
                let text = if value.is_empty() { "return;".to_owned() } else { format!("return {value};") };
                walk.add("early return", after_brace, Form::Head, vec![Piece::Text(text)]);
            }
            walk.visit_block(body);
        });
    }

    fn binary(&mut self, expression: &syn::ExprBinary) {
        if is_let(&expression.left) || is_let(&expression.right) {
            return;
        }
        let assigns = operators::assigns(&expression.op);
        for (operator, sign) in operators::other_signs(&expression.op) {
            let mut pieces = operand(&expression.left, assigns);
            pieces.push(text(&format!(" {sign} ")));
            pieces.extend(operand(&expression.right, assigns));
            self.replace(operator, expression.span(), pieces);
        }
    }

    fn condition(&mut self, condition: &Expr) {
        if has_let(condition) {
            return;
        }
        for value in ["true", "false"] {
            self.replace("condition", condition.span(), vec![text(value)]);
        }
    }
}

impl<'ast> Visit<'ast> for Walk<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig, &item.block, &item.attrs);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.function(&item.sig, &item.block, &item.attrs);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(body) = &item.default {
            self.function(&item.sig, body, &item.attrs);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !of_tests(&item.attrs) {
            self.within(item.ident.to_string(), |walk| visit::visit_item_mod(walk, item));
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let last = |path: &syn::Path| path.segments.last().map(|segment| segment.ident.to_string());
        let name = item.trait_.as_ref().and_then(|(_, path, _)| last(path));
        if name.is_some_and(|name| TRAITS_OF_TEXT.contains(&name.as_str())) {
            return;
        }
        let own = match &*item.self_ty {
            syn::Type::Path(path) => last(&path.path),
            _ => None,
        };
        self.within(own.unwrap_or_else(|| "impl".to_owned()), |walk| visit::visit_item_impl(walk, item));
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.within(item.ident.to_string(), |walk| visit::visit_item_trait(walk, item));
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        if let Stmt::Expr(expression, Some(_)) = statement {
            let omitted = match expression {
                Expr::Call(_) | Expr::MethodCall(_) | Expr::Assign(_) => true,
                Expr::Binary(binary) => operators::assigns(&binary.op),
                _ => false,
            };
            if omitted {
                self.add("statement", statement.span(), Form::Omission, vec![]);
            }
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr_binary(&mut self, expression: &'ast syn::ExprBinary) {
        self.binary(expression);
        visit::visit_expr_binary(self, expression);
    }

    fn visit_expr_unary(&mut self, expression: &'ast syn::ExprUnary) {
        let operand = Piece::Source(range(&*expression.expr));
        match expression.op {
            UnOp::Not(_) => self.replace("negation", expression.span(), vec![operand]),
            UnOp::Neg(_) => self.replace("sign", expression.span(), vec![operand]),
            _ => {}
        }
        visit::visit_expr_unary(self, expression);
    }

    fn visit_expr_lit(&mut self, literal: &'ast syn::ExprLit) {
        match &literal.lit {
            Lit::Float(number) => {
                for value in operators::other_floats(&number.to_string()) {
                    self.replace("constant", literal.span(), vec![text(&value)]);
                }
            }
            Lit::Int(number) => {
                for value in operators::other_integers(number) {
                    self.replace("constant", literal.span(), vec![text(&value)]);
                }
            }
            Lit::Bool(value) => {
                self.replace(
                    "constant",
                    literal.span(),
                    vec![text(if value.value { "false" } else { "true" })],
                );
            }
            _ => {}
        }
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let name = call.method.to_string();
        if let (Some(other), 1) = (operators::other_method(&name), call.args.len()) {
            let (whole, method) = (range(call), call.method.span().byte_range());
            let before = Piece::Source(whole.start..method.start);
            let after = Piece::Source(method.end..whole.end);
            self.replace("extreme", call.span(), vec![before, text(other), after]);
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_path(&mut self, path: &'ast syn::ExprPath) {
        let name = spaced(&self.text[range(path)]);
        if let Some(other) = operators::other_path(&name) {
            self.replace("extreme", path.span(), vec![text(other)]);
        }
    }

    fn visit_expr_range(&mut self, expression: &'ast syn::ExprRange) {
        if let Some(end) = &expression.end {
            let by = match expression.limits {
                syn::RangeLimits::HalfOpen(_) => " + 1",
                syn::RangeLimits::Closed(_) => " - 1",
            };
            let (whole, last) = (range(expression), range(&**end));
            let start = Piece::Source(whole.start..last.start);
            self.replace(
                "range",
                expression.span(),
                vec![start, text("(("), Piece::Source(last), text(&format!("){by})"))],
            );
        }
        visit::visit_expr_range(self, expression);
    }

    fn visit_expr_if(&mut self, expression: &'ast syn::ExprIf) {
        self.condition(&expression.cond);
        visit::visit_expr_if(self, expression);
    }

    fn visit_expr_while(&mut self, expression: &'ast syn::ExprWhile) {
        if !has_let(&expression.cond) {
            self.replace("condition", expression.cond.span(), vec![text("false")]);
        }
        visit::visit_expr_while(self, expression);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let Some((_, guard)) = &arm.guard {
            self.condition(guard);
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_repeat(&mut self, expression: &'ast syn::ExprRepeat) {
        self.visit_expr(&expression.expr);
    }

    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_item_struct(&mut self, _: &'ast syn::ItemStruct) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'ast syn::AngleBracketedGenericArguments) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_macro(&mut self, _: &'ast syn::Macro) {}
}

fn range(of: &impl Spanned) -> Range<usize> {
    of.span().byte_range()
}

/// Returns an operand, in parentheses unless it binds as tightly as any; `alone`: true if it needs none.
fn operand(operand: &Expr, alone: bool) -> Vec<Piece> {
    let source = Piece::Source(range(operand));
    let tight = matches!(
        operand,
        Expr::Path(_)
            | Expr::Lit(_)
            | Expr::MethodCall(_)
            | Expr::Call(_)
            | Expr::Field(_)
            | Expr::Index(_)
            | Expr::Paren(_)
            | Expr::Unary(_)
    );
    if alone || tight { vec![source] } else { vec![text("("), source, text(")")] }
}

fn text(text: &str) -> Piece {
    Piece::Text(text.to_owned())
}

fn is_let(expression: &Expr) -> bool {
    matches!(expression, Expr::Let(_)) || has_let(expression)
}

/// Returns true if a condition binds names.
fn has_let(condition: &Expr) -> bool {
    match condition {
        Expr::Let(_) => true,
        Expr::Binary(binary) if matches!(binary.op, BinOp::And(_)) => {
            has_let(&binary.left) || has_let(&binary.right)
        }
        Expr::Paren(inner) => has_let(&inner.expr),
        _ => false,
    }
}

/// Returns true if an item belongs to tests.
fn of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let path = attribute.path();
        path.is_ident("test")
            || path.is_ident("cfg")
                && matches!(&attribute.meta, syn::Meta::List(list) if list.tokens.to_string() == "test")
    })
}
