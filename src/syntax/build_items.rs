//! The tree of items: imports, functions, tests and native declarations.

use super::ast::*;
use super::build::{Builder, next, next_if};
use super::parse::{Node, Rule};
use crate::source::Span;

impl Builder<'_> {
    /// Builds the items of a chunk from its parse node, and appends them to `items`.
    pub(super) fn chunk(&mut self, node: Node, items: &mut Vec<Item>) {
        for node in node.into_inner().filter(|node| node.as_rule() != Rule::EOI) {
            let item = self.item(node, items.last().map(|item| item.span));
            items.push(item);
        }
    }

    /// Builds an item; `before` is the span of the item before it.
    fn item(&mut self, node: Node, before: Option<Span>) -> Item {
        let mut span = self.span(&node);
        let kind = match node.as_rule() {
            Rule::use_item => ItemKind::Use(self.use_item(node)),
            Rule::let_item => ItemKind::Let(self.let_item(node)),
            Rule::fn_item => ItemKind::Fn(self.fn_item(node)),
            Rule::record => ItemKind::Record(self.record(node)),
            Rule::config | Rule::scene => ItemKind::Config(self.config(node)),
            Rule::module => ItemKind::Module(self.module(node)),
            Rule::connector => ItemKind::Connector(self.connector(node)),
            Rule::cell => ItemKind::Facts(self.facts(FactsFamily::Cell, node)),
            Rule::strut => ItemKind::Facts(self.facts(FactsFamily::Strut, node)),
            Rule::lattice => ItemKind::Lattice(self.lattice(node)),
            Rule::truss => ItemKind::Truss(self.truss(node)),
            Rule::study => ItemKind::Study(self.study(node)),
            Rule::test => ItemKind::Test(self.test(node)),
            Rule::extern_fn => ItemKind::ExternFn(self.extern_fn(node)),
            Rule::extern_type => ItemKind::ExternType(self.extern_type(node)),
            _ => ItemKind::Statement(self.statement(node, before).0),
        };
        if let ItemKind::ExternFn(_) | ItemKind::ExternType(_) = kind {
            // A misspelt `extern` is not there; one before it belongs to another item.
            let start = span.start as usize;
            let word = self.text[..start].rfind("extern");
            let own = word.filter(|at| self.read[at + "extern".len()..start].trim().is_empty());
            span.start = own.map_or(span.start, |at| at as u32);
        }
        Item { span, doc: self.doc(span.start), kind }
    }

    fn use_item(&mut self, node: Node) -> Use {
        let mut nodes = node.into_inner();
        let source = next(&mut nodes);
        let source = match source.as_rule() {
            Rule::use_path => UseSource::Path(self.words(source)),
            _ => {
                let (path, span) = self.plain_text(&source);
                UseSource::File { path, span }
            }
        };
        let names = nodes.next().map(|names| names.into_inner().map(|name| self.use_name(name)).collect());
        Use { source, names }
    }

    fn use_name(&mut self, node: Node) -> UseName {
        let mut nodes = node.into_inner();
        let name = self.word(next(&mut nodes));
        UseName { name, rename: nodes.next().map(|rename| self.declared(rename)) }
    }

    fn fn_item(&mut self, node: Node) -> Fn {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let type_params = next_if(&mut nodes, Rule::type_params).map(|params| self.type_params(params));
        let params = self.plain_params(next(&mut nodes));
        let result = next_if(&mut nodes, Rule::type_expr).map(|ty| self.ty(ty));
        let type_params = type_params.unwrap_or_default();
        Fn { name, type_params, params, result, body: self.body(next(&mut nodes)) }
    }

    fn record(&mut self, node: Node) -> Record {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let mut record = Record { name, fields: Vec::new(), docs: Vec::new() };
        for field in nodes {
            record.docs.push(self.doc(self.span(&field).start));
            let mut nodes = field.into_inner();
            let name = self.declared(next(&mut nodes));
            let ty = self.ty(next(&mut nodes));
            let default = nodes.next().map(|value| self.expr(value));
            record.fields.push(Param { name, ty, default, variadic: false });
        }
        record
    }

    fn study(&mut self, node: Node) -> Study {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let mut axes = Vec::new();
        while let Some(axis) = next_if(&mut nodes, Rule::study_axis) {
            axes.push(self.study_axis(axis));
        }
        let sampler = self.word(next(&mut nodes));
        let settings = self.args(next(&mut nodes));
        let mut each = Vec::new();
        while let Some(axis) = next_if(&mut nodes, Rule::study_each) {
            each.push(self.study_axis(next(&mut axis.into_inner())));
        }
        Study { name, axes, sampler, settings, each, body: self.body(next(&mut nodes)) }
    }

    fn study_axis(&mut self, node: Node) -> StudyAxis {
        let mut nodes = node.into_inner();
        StudyAxis { name: self.declared(next(&mut nodes)), domain: self.expr(next(&mut nodes)) }
    }

    fn test(&mut self, node: Node) -> Test {
        let mut nodes = node.into_inner();
        let (name, name_span) = self.plain_text(&next(&mut nodes));
        Test { name, name_span, body: self.statements(next(&mut nodes)) }
    }

    fn extern_fn(&mut self, node: Node) -> ExternFn {
        let mut nodes = node.into_inner();
        let name = self.word(next(&mut nodes));
        let type_params = next_if(&mut nodes, Rule::type_params).map(|params| self.type_params(params));
        let params = self.params(next(&mut nodes));
        let result = nodes.next().map(|ty| self.ty(ty));
        ExternFn { name, type_params: type_params.unwrap_or_default(), params, result }
    }

    fn extern_type(&mut self, node: Node) -> ExternType {
        let mut nodes = node.into_inner();
        let name = self.declared(next(&mut nodes));
        let is = next_if(&mut nodes, Rule::name).map(|is| self.word(is));
        let mut fields = Vec::new();
        let mut methods = Vec::new();
        for node in nodes.flat_map(Node::into_inner) {
            let doc = self.doc(self.span(&node).start);
            if node.as_rule() == Rule::extern_fn {
                methods.push((doc, self.extern_fn(node)));
                continue;
            }
            let mut nodes = node.into_inner();
            let name = self.word(next(&mut nodes));
            fields.push(ExternField { doc, name, ty: self.ty(next(&mut nodes)) });
        }
        ExternType { name, is, fields, methods }
    }

    /// Builds the parameters if their parse node is the next child; otherwise returns an empty list and takes no child.
    pub(super) fn params_if(&mut self, nodes: &mut pest::iterators::Pairs<Rule>) -> Vec<Param> {
        next_if(nodes, Rule::params).map(|params| self.plain_params(params)).unwrap_or_default()
    }
}
